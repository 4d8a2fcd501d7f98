// SPDX-License-Identifier: Apache-2.0
// Tests: tests/make/remeshing_test.cpp.
#include "make_remesh.h"

#include <fmt/format.h>

#include "common/summary.h"

namespace relief::tools {

std::string remesh_text(const make::RemeshDecision& decision) {
    return decision.is_remeshed
               ? fmt::format("a closed surface of {} replaces the mesh: {}",
                             counted(decision.triangles, "triangle"), decision.reason)
               : fmt::format("the mesh is kept: {}", decision.reason);
}

std::vector<std::string> remesh_lines(const make::RemeshDecision& decision) {
    std::vector<std::string> lines = {remesh_text(decision)};
    for (const make::RemeshCriterion& criterion : decision.criteria) {
        lines.push_back(fmt::format(
            "{}: {} (limit {:g} %){}", criterion.name,
            criterion.value ? fmt::format("{:.3g} %", 100.0 * *criterion.value) : "not measured",
            100.0 * criterion.limit, criterion.is_exceeded() ? ", exceeded" : ""));
    }
    if (decision.distance) {
        const make::RemeshDistance& distance = *decision.distance;
        lines.push_back(fmt::format(
            "closed surface: cells of {:.3g}; {:.3g} cells from the mesh at most ({:.3g} RMS); the "
            "mesh, where it is seen, {:.3g} from it ({:.3g} RMS); {:.3g} % of the mesh is not seen",
            decision.cell, distance.max_of_surface / decision.cell,
            distance.rms_of_surface / decision.cell, distance.max_of_source / decision.cell,
            distance.rms_of_source / decision.cell, 100.0 * distance.hidden));
    }
    return lines;
}

Json remesh_json(const make::RemeshDecision& decision) {
    Json json = {{"remeshed", decision.is_remeshed},
                 {"reason", decision.reason},
                 {"criteria", json_list(decision.criteria,
                                        [](const make::RemeshCriterion& criterion) -> Json {
                                            return {{"name", criterion.name},
                                                    {"limit", criterion.limit},
                                                    {"value", or_null(criterion.value)}};
                                        })},
                 {"triangles", decision.triangles},
                 {"cell", decision.cell},
                 {"distance", nullptr}};
    if (decision.distance) {
        const make::RemeshDistance& distance = *decision.distance;
        json["distance"] = {{"rms_of_source", distance.rms_of_source},
                            {"max_of_source", distance.max_of_source},
                            {"rms_of_surface", distance.rms_of_surface},
                            {"max_of_surface", distance.max_of_surface},
                            {"hidden", distance.hidden}};
    }
    return json;
}

}  // namespace relief::tools
