// SPDX-License-Identifier: Apache-2.0
// `relief-mesh decimate IN OUT`: fewer triangles for nearly the same surface and texture.
// Tests: tests/tools/reshaping_test.cpp.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "commands.h"
#include "common/frame_choices.h"
#include "relief/mesh/decimate.h"
#include "reshaping.h"

namespace relief::tools {
namespace {

struct DecimateWords {
    ReshapeRequest request;
    std::optional<int> triangles;
    std::optional<double> ratio;
    std::optional<double> max_error;
};

void check_limits(const DecimateWords& words) {
    if (words.triangles && words.ratio)
        throw UsageError("--triangles and --ratio: both say how many", "give one of them");
    if (!words.triangles && !words.ratio && !words.max_error)
        throw UsageError("nothing says when to stop",
                         "give --triangles N, --ratio R or --max-error E");
}

/// The share that one of several meshes has in the number that is wanted for all.
std::optional<std::size_t> wanted_triangles(const DecimateWords& words, std::size_t count,
                                            std::size_t all) {
    if (!words.triangles && !words.ratio) return std::nullopt;
    const double ratio = words.ratio ? *words.ratio
                                     : static_cast<double>(*words.triangles) /
                                           static_cast<double>(std::max<std::size_t>(all, 1));
    const double wanted = std::round(ratio * static_cast<double>(count));
    return static_cast<std::size_t>(std::max(wanted, 1.0));
}

nlohmann::ordered_json options_json(const DecimateWords& words) {
    nlohmann::ordered_json json = nlohmann::ordered_json::object();
    if (words.triangles) json["triangles"] = *words.triangles;
    if (words.ratio) json["ratio"] = *words.ratio;
    if (words.max_error) json["max_error"] = *words.max_error;
    json["normals"] = name_of(words.request.normals, normal_choices());
    return json;
}

ExitCode run(const CLI::App& app, const DecimateWords& words) {
    check_limits(words);
    const auto change = [&](const Mesh& mesh, std::size_t all_triangles, Report& report) {
        DecimateOptions options;
        options.triangles = wanted_triangles(words, mesh.triangles.size(), all_triangles);
        options.max_error = words.max_error;
        options.frames.normals = words.request.normals;
        return decimated(mesh, options, report);
    };
    return reshape(app, words.request, change, options_json(words));
}

void add_options(CLI::App& app, DecimateWords& words) {
    add_reshape_options(
        app, words.request,
        "Normals: the file's own at the vertices that stay (keep), with hard edges kept as seams "
        "are; or computed anew, and hard edges not looked at. Default: keep.");
    const std::string limits = "When to stop, whichever comes first";
    add_value(
        app, "--triangles", "N", "At N triangles in all; several meshes each keep the same share.",
        [&words](const std::string& subject, const std::string& text) {
            words.triangles = parse_integer(subject, text, 1, std::numeric_limits<int>::max());
        })
        .group(limits);
    add_number(app, "--ratio", "R", words.ratio, {0.0, 1.0, ""},
               "At this part of the triangles, 0 to 1.")
        .group(limits);
    add_number(app, "--max-error", "E", words.max_error, {0.0, Range().max, ""},
               "Where a vertex of IN would be further than E from the result, in the model's unit "
               "(relief-mesh info prints its size).")
        .group(limits);
    set_examples(
        app, {"relief-mesh decimate data/vase.obj out/vase-1000.glb --triangles 1000",
              "relief-mesh decimate data/vase.obj out/vase-tenth.obj --ratio 0.1 --normals angle",
              "relief-mesh decimate data/vase.obj out/vase-near.glb --max-error 0.01"});
}

}  // namespace

Command add_decimate_command(CLI::App& tool) {
    CLI::App& app = add_subcommand(
        tool, "decimate",
        "Makes a model of fewer triangles; texture seams, materials and borders stay.");
    const auto words = std::make_shared<DecimateWords>();
    add_options(app, *words);
    return {&app, [&app, words] { return run(app, *words); }};
}

}  // namespace relief::tools
