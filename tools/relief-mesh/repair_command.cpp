// SPDX-License-Identifier: Apache-2.0
// `relief-mesh repair IN OUT` repairs the connectivity of a model.
// Tests: tests/tools/repair_test.cpp.
#include "relief/mesh/repair.h"

#include <fmt/format.h>

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "commands.h"
#include "common/command.h"
#include "common/options.h"
#include "common/summary.h"
#include "reshape.h"

namespace relief::tools {
namespace {

/// A length, as a number or as a share of the diagonal of a mesh.
struct RelativeLength {
    double value = 0.0;
    bool is_share = false;

    [[nodiscard]] double of(const Mesh& mesh) const {
        if (!is_share || value == 0.0) return value;
        const Bounds bounds = bounds_of(mesh);
        if (bounds.empty()) return 0.0;
        return value * glm::length(glm::dvec3(bounds.max) - glm::dvec3(bounds.min));
    }
};

/// Parses "0.01" or "0.1%".
RelativeLength parse_length(const std::string& subject, const std::string& text) {
    if (!text.ends_with('%')) return {parse_number(subject, text, {0.0, Range().max, ""}), false};
    const std::string_view percent = std::string_view(text).substr(0, text.size() - 1);
    return {parse_number(subject, percent, {0.0, 100.0, "%"}) / 100.0, true};
}

struct RepairCommand {
    ReshapeRequest request;
    RepairOptions options;
    std::string tolerance_text = "0";
    RelativeLength tolerance;
    std::optional<double> drop_below;
};

Json repair_json(const RepairCommand& command) {
    const RepairOptions& options = command.options;
    Json json = {{"weld", command.tolerance_text},
                 {"merge_vertices", options.merge_vertices},
                 {"remove_non_finite", options.remove_non_finite},
                 {"remove_degenerate", options.remove_collapsed},
                 {"remove_duplicates", options.remove_duplicates},
                 {"two_sided", enum_name(options.two_sided)},
                 {"orient", options.orient},
                 {"separate", options.separate}};
    if (command.drop_below) json["drop_below"] = *command.drop_below;
    return json;
}

ExitCode repair_model(const CLI::App& app, const RepairCommand& command) {
    if (!command.options.merge_vertices && is_given(app, "--weld"))
        throw UsageError("--weld and --no-weld contradict each other", "give one of them");
    if (command.options.two_sided == TwoSided::together && !command.options.orient)
        throw UsageError("--two-sided together needs triangles that are oriented",
                         "leave out --no-orient");
    const ModelChange change = [&](std::span<const TriangleInput> meshes, std::span<Report> reports,
                                   Report&) {
        std::vector<FramedMesh> results;
        for (std::size_t i = 0; i < meshes.size(); ++i) {
            const Mesh& mesh = meshes[i].mesh;
            RepairOptions options = command.options;
            options.weld_tolerance = command.tolerance.of(mesh);
            if (!command.tolerance.is_share) options.weld_tolerance /= meshes[i].scale;
            options.drop_parts = RelativeLength{command.drop_below.value_or(0.0), true}.of(mesh);
            results.push_back(repaired(mesh, options, reports[i], meshes[i].deformation));
        }
        return results;
    };
    return reshape(app, command.request, change, Measuring::none, repair_json(command),
                   std::nullopt, true);
}

void add_repair_options(CLI::App& app, RepairCommand& command) {
    add_reshape_options(app, command.request, "");
    RepairOptions& options = command.options;
    const std::string weld = "Vertices";
    add_value(app, "--weld", "LENGTH",
              "Weld positions that are at most this far apart, and chains of them: in the unit of "
              "the scene, or as a share of the diagonal of each mesh (0.01%). Default: only equal "
              "positions are one.",
              [&command](const std::string& subject, const std::string& text) {
                  command.tolerance = parse_length(subject, text);
                  command.tolerance_text = text;
              })
        .group(weld);
    add_switch(
        app, "--no-weld",
        "Do not merge vertices that are equal in position and all other attributes. Default: "
        "they become one.",
        [&options] { options.merge_vertices = false; })
        .group(weld);
    const std::string triangles = "Triangles";
    add_switch(app, "--keep-non-finite",
               "Keep triangles with a corner that is not finite. Default: they are removed.",
               [&options] { options.remove_non_finite = false; })
        .group(triangles);
    add_switch(app, "--keep-degenerate",
               "Keep triangles with two corners at one position. Default: they are removed. Those "
               "on a line with three different corners always stay, because they close cracks.",
               [&options] { options.remove_collapsed = false; })
        .group(triangles);
    add_switch(
        app, "--keep-duplicates",
        "Keep triangles with the corners and the winding of another one. Default: one stays.",
        [&options] { options.remove_duplicates = false; })
        .group(triangles);
    add_choice(app, "--two-sided", options.two_sided, enum_choices<TwoSided>(),
               "Two triangles with the same corners and opposite winding: both stay, as two sheets "
               "(keep), or at the same positions, so that they are decimated as one (together); "
               "one stays (single); or both are removed, like walls inside of a solid (remove). "
               "Default: keep.")
        .group(triangles);
    add_number(app, "--drop-below", "SHARE", command.drop_below, {0.0, 1.0, ""},
               "Remove parts, joined across edges, whose bounding box has a diagonal below this "
               "share of that of the mesh, 0 to 1. Default: no part is removed.")
        .group(triangles);
    const std::string connectivity = "Connectivity";
    add_switch(app, "--no-orient",
               "Keep the winding of all triangles. Default: neighbors get the same winding, closed "
               "parts face outwards, except for cavities, and open parts keep the winding of most "
               "of their area.",
               [&options] { options.orient = false; })
        .group(connectivity);
    add_switch(app, "--no-separate",
               "Keep edges with three or more triangles, and fans that meet at a point. Default: "
               "the flattest pairs at an edge stay joined, and what is separated moves by a "
               "millionth of the size.",
               [&options] { options.separate = false; })
        .group(connectivity);
    set_examples(app, {"relief-mesh repair data/vase.obj out/vase-repaired.glb",
                       "relief-mesh repair data/vase.obj out/vase-welded.obj --weld 0.01% "
                       "--drop-below 0.01 --report out/vase-repair.json",
                       "relief-mesh repair data/vase.obj out/vase-thin.ply --two-sided single "
                       "--no-separate",
                       "relief-mesh repair data/*.obj -o out/repaired/ --format glb"});
}

}  // namespace

Command add_repair_command(CLI::App& tool) {
    return add_command<RepairCommand>(
        tool, "repair",
        "Welds, removes degenerate and duplicate triangles, orients, and separates what is not "
        "manifold.",
        add_repair_options, repair_model);
}

}  // namespace relief::tools
