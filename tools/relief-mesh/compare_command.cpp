// SPDX-License-Identifier: Apache-2.0
// `relief-mesh compare A B`: how far apart normals and tangents are, as text or JSON, and whether
// that is too far. Tests: tests/tools/relief_mesh_compare_test.cpp.
#include <fmt/format.h>

#include <limits>
#include <memory>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "common/options.h"
#include "common/text.h"
#include "model_compare.h"
#include "relief/mesh/threads.h"

namespace relief::tools {
namespace {

struct CompareOptions {
    CompareRequest request;
    std::optional<double> max_angle;
    bool json = false;
    bool strict = false;
    GeneralOptions general;
};

/// What is beyond the limit, in words.
std::string beyond(const FrameComparison& all, double max_angle) {
    std::vector<std::string> words;
    const auto add = [&](const AngleDistribution& angles, const char* what) {
        if (angles.max > max_angle)
            words.push_back(fmt::format("{} by {:.4g} degrees", what, angles.max));
        if (angles.undefined != 0)
            words.push_back(fmt::format("{} {} of no direction", angles.undefined, what));
    };
    add(all.normals, "normals");
    add(all.tangents, "tangents");
    if (all.sign_differences != 0)
        words.push_back(fmt::format("{} of tangents", counted(all.sign_differences, "sign")));
    return fmt::format("{}", fmt::join(words, ", "));
}

ExitCode judge(const CLI::App& app, const CompareOptions& options, const ComparedModels& compared) {
    const auto fail = [&](const std::string& problem) {
        complain(app, fmt::format("{}: {}", options.request.b.string(), problem));
        return ExitCode::failed;
    };
    if (compared.all.corners == 0) {
        return fail(fmt::format(
            "has no triangle in common with {} (try --world, --tolerance, --uv-tolerance, "
            "--ignore-uv)",
            options.request.a.string()));
    }
    if (options.max_angle && !compared.has_any()) {
        return fail(fmt::format(
            "has neither normals nor tangents in common with {}, so that --max-angle says nothing "
            "(relief-mesh process gives both files theirs)",
            options.request.a.string()));
    }
    if (options.max_angle && !compared.is_within(*options.max_angle)) {
        return fail(fmt::format("differs from {} by more than {} degrees: {}",
                                options.request.a.string(), *options.max_angle,
                                beyond(compared.all, *options.max_angle)));
    }
    if (options.strict && !compared.is_complete()) {
        warn(app, "not all corners could be compared (exit code 3, because of --strict)");
        return ExitCode::fell_back;
    }
    return ExitCode::done;
}

ExitCode run(const CLI::App& app, const CompareOptions& options) {
    if (options.json && options.general.quiet)
        throw UsageError("--json and --quiet contradict each other");
    if (options.request.ignore_uv && options.request.uv_tolerance)
        throw UsageError("--ignore-uv and --uv-tolerance contradict each other");
    readable_format(options.request.a);
    readable_format(options.request.b);
    set_thread_limit(options.general.threads);
    Stages stages(options.general.quiet);
    const ComparedModels compared =
        stages.run("compare", [&] { return compare_models(options.request); });
    if (options.json) {
        nlohmann::ordered_json json = {{"tool", "relief-mesh compare"}, {"version", version()}};
        json.update(json_of(compared));
        json["max_angle"] = options.max_angle ? nlohmann::ordered_json(*options.max_angle)
                                              : nlohmann::ordered_json();
        json["within"] = options.max_angle
                             ? nlohmann::ordered_json(compared.is_within(*options.max_angle))
                             : nlohmann::ordered_json();
        json["complete"] = compared.is_complete();
        print_json(json);
    } else if (!options.general.quiet) {
        print_text(compared);
    }
    return judge(app, options, compared);
}

void add_matching_options(CLI::App& app, CompareRequest& request) {
    const char* group = "Matching";
    const Range distance{0.0, std::numeric_limits<double>::max(), "units"};
    add_number(app, "--tolerance", "DISTANCE", request.tolerance, distance,
               "Positions no further apart than this, in the models' unit, are the same; equal "
               "ones go first, then the nearest. Default: 1e-5 of the model's size, which is what "
               "text files of six digits lose.")
        .group(group);
    add_number(app, "--uv-tolerance", "DISTANCE", request.uv_tolerance, distance,
               "The same for texture coordinates. Default: 1e-6, times the largest if that is "
               "above 1.")
        .group(group);
    add_switch(app, "--world", request.in_world_space,
               "Compare where the nodes of a scene place their meshes, once for each place, for "
               "files whose nodes differ (quantised, flattened, re-exported). Default: in the "
               "object space of each primitive if both files are glTF.")
        .group(group);
    add_switch(app, "--ignore-uv", request.ignore_uv,
               "Match by position alone. So it is anyway where a file has no texture coordinates.")
        .group(group);
}

}  // namespace

Command add_compare_command(CLI::App& tool) {
    CLI::App& app = add_subcommand(
        tool, "compare", "Says how far apart the normals and tangents of two models are.");
    const auto options = std::make_shared<CompareOptions>();
    add_file(app, "A", options->request.a, "Model to read: .glb .gltf .obj .ply .stl .off");
    add_file(app, "B", options->request.b, "Model to compare with it; formats may differ.");
    add_number(
        app, "--max-angle", "DEG", options->max_angle, {0.0, 180.0, "degrees"},
        "Exit with 1 if a normal or tangent differs by more, or a tangent's sign does, or if "
        "there is none to compare.")
        .group("Verdict");
    add_switch(
        app, "--strict", options->strict,
        "Exit with 3 if a triangle has no partner or no certain one, normals or tangents are "
        "in one file alone, or a direction is zero or not finite.")
        .group("Verdict");
    add_matching_options(app, options->request);
    add_switch(app, "--json", options->json,
               "Print one JSON object: tool, version, a, b, world_space, by_texture_coordinate, "
               "tolerance, uv_tolerance, triangles {equal, near, ambiguous, only_in_a, only_in_b}, "
               "corners, normals and tangents {corners, undefined, rms, mean, p99, max, histogram "
               "[up_to, corners]} in degrees, sign_differences, worst_normals and worst_tangents "
               "[degrees, position, primitive, triangle, corner, triangle_of_b, corner_of_b], "
               "primitives [name, triangles, only_in_a, and the same again], max_angle, within, "
               "complete.");
    add_general_options(app, options->general);
    set_examples(app,
                 {"relief-mesh process data/vase.obj out/vase.glb --tangents mikktspace",
                  "relief-mesh process data/vase.obj out/vase-area.glb --tangents area-weighted",
                  "relief-mesh compare out/vase.glb out/vase-area.glb",
                  "relief-mesh compare out/vase.glb out/vase-area.glb --max-angle 5 --strict",
                  "relief-mesh compare out/vase.glb data/vase.obj --ignore-uv --json"});
    return {&app, [&app, options] { return run(app, *options); }};
}

}  // namespace relief::tools
