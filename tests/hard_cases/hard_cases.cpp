// SPDX-License-Identifier: Apache-2.0
#include "hard_cases/hard_cases.h"

#include <fmt/format.h>

#include "relief/mesh/diagnose.h"

namespace relief::test {

const std::vector<HardCase>& hard_cases() {
    static const std::vector<HardCase> table = [] {
        std::vector<HardCase> rows;
        for (const auto& part :
             {triangle_cases(), surface_cases(), number_cases(), stored_cases(), tangent_cases(),
              tangent_surface_cases(), encoding_cases(), image_cases(), image_file_cases(),
              normal_map_cases(), map_check_cases(), bake_cases(), bake_shape_cases()})
            rows.insert(rows.end(), part.begin(), part.end());
        return rows;
    }();
    return table;
}

namespace {

constexpr const char* introduction = R"(# Hard cases

Each hard input has one defined outcome. relief repairs, drops and clamps nothing silently: the report counts every
fallback. Directions are always unit vectors. The same input gives the same bits for any order of triangles and any
number of threads. A test runs every line of both tables (`tests/hard_cases/`); `relief-documents` writes this page
from the same table. *Orthonormal* tangents are unit vectors, perpendicular to their normals within 1e-6, and their w
is 1 or -1 and equal at all corners of a triangle. For tangents, rows without texture coordinates get those of a
projection from above.

`relief-mesh check` uses the terms of the first table.
```sh
relief-mesh check data/vase.obj
relief-mesh check data/vase.obj data/scenes/knot.glb --strict --json
```
)";

std::string terms() {
    std::string text =
        "## Terms\n"
        "A *problem* makes a step use a fallback, or makes its result depend on more than the "
        "surface: `--strict` exits\nwith 3. A *note* also occurs in models without problems. "
        "Vertices at equal positions count as one for triangles,\nedges and fans. An edge is "
        "identified by its first triangle. A triangle without texture gradient is only a note\nin "
        "a model that needs no tangents: it has no normal or bump map and no stored tangents. With "
        "`--for-baking` it\nis a problem, and so is overlapping texture.\n\n"
        "| term | | consequence |\n|---|---|---|\n";
    for (const MeshConditionInfo& condition : mesh_conditions()) {
        text += fmt::format("| {} | {} | {} |\n", condition.word,
                            condition.severity == Severity::problem ? "problem" : "note",
                            condition.meaning);
    }
    return text;
}

std::string outcomes(const HardCase& row) {
    std::string text;
    std::string step;
    for (const Expectation& expectation : row.expectations) {
        if (expectation.step != step)
            text += fmt::format("{}*{}:* ", text.empty() ? "" : "<br>", expectation.step);
        else
            text += "; ";
        step = expectation.step;
        text += expectation.outcome;
    }
    return text;
}

std::string cases() {
    std::string text = "## Cases\n| case | input | outcome | known from |\n|---|---|---|---|\n";
    for (const HardCase& row : hard_cases())
        text +=
            fmt::format("| {} | {} | {} | {} |\n", row.name, row.what, outcomes(row), row.source);
    return text;
}

}  // namespace

std::string hard_cases_page() {
    return fmt::format("{}\n{}\n{}", introduction, terms(), cases());
}

}  // namespace relief::test
