// SPDX-License-Identifier: Apache-2.0
// `relief-mesh compare A B` matches the corners of two models, measures the angles between their
// normals and between their tangents, and checks them against a limit.
// Tests: tests/tools/relief_mesh_compare_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "commands.h"
#include "common/model_file.h"
#include "common/options.h"
#include "common/summary.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/model.h"

namespace relief::tools {
namespace {

struct CompareRequest {
    std::filesystem::path a;
    std::filesystem::path b;
    std::optional<double> tolerance;     ///< Of positions, in the unit of the models.
    std::optional<double> uv_tolerance;  ///< Of texture coordinates.
    bool ignore_uv = false;
    bool in_world_space = false;  ///< Also if both files are glTF.
};

constexpr std::size_t max_parts = 24;

/// Two glTF files are compared in the object space of each primitive, or with `in_world_space` once
/// per instance in world space. A glTF file and a file of another format are always compared in
/// world space, because other formats store world space.
///
/// \throws FileError if a file cannot be read or has no triangles
ModelComparison compare_files(const CompareRequest& request) {
    Report ignored;  // `relief-mesh check` reports the findings of a file.
    Model a = read_model(request.a, ignored);
    Model b = read_model(request.b, ignored);
    const bool in_world_space = request.in_world_space || a.index() != b.index();
    const auto joined = [&](const std::filesystem::path& file, Model model) {
        return about(file, [&] { return joined_model(std::move(model), in_world_space); });
    };
    JoinedModel joined_a = joined(request.a, std::move(a));
    JoinedModel joined_b = joined(request.b, std::move(b));
    return compare_models(std::move(joined_a), std::move(joined_b),
                          {request.tolerance, request.uv_tolerance, !request.ignore_uv});
}

std::string degrees_text(const ErrorStats& angles) {
    return fmt::format("{}: rms {:.4g}, mean {:.4g}, 99 % within {:.4g}, maximum {:.4g} degrees",
                       counted(angles.count, "corner"), angles.rms, angles.mean, angles.p99,
                       angles.max);
}

std::string histogram_text(const ErrorStats& angles) {
    std::vector<std::string> bins;
    for (std::size_t i = 0; i < angles.histogram.size(); ++i) {
        if (angles.histogram[i] != 0)
            bins.push_back(fmt::format("{} up to {}", angles.histogram[i], ErrorStats::bounds[i]));
    }
    return fmt::format("{} degrees", fmt::join(bins, ", "));
}

/// Returns why an attribute is not compared: "only in A".
std::string absence(bool in_a, bool in_b) {
    return in_a ? "only in A" : in_b ? "only in B" : "in neither";
}

std::vector<std::string> attribute_lines(const ErrorStats& angles, bool in_a, bool in_b,
                                         std::size_t in_one) {
    if (!in_a || !in_b) return {absence(in_a, in_b)};
    std::vector<std::string> lines;
    if (angles.count != 0) lines = {degrees_text(angles), histogram_text(angles)};
    if (angles.undefined != 0) {
        lines.push_back(fmt::format("{} with a zero or non-finite direction",
                                    counted(angles.undefined, "corner")));
    }
    if (in_one != 0)
        lines.push_back(fmt::format("{} with them in only one file", counted(in_one, "corner")));
    if (lines.empty()) lines.emplace_back("no corner has them in both files");
    return lines;
}

const ComparedPart& part_of(const JoinedModel& model, std::size_t triangle) {
    return *std::find_if(model.parts.rbegin(), model.parts.rend(), [&](const ComparedPart& part) {
        return part.first_triangle <= triangle && part.triangle_count != 0;
    });
}

glm::vec3 place_of(const JoinedModel& model, std::uint32_t corner) {
    return model.mesh.positions[model.mesh.triangles[corner / 3][static_cast<int>(corner % 3)]];
}

std::string as_text(const ModelComparison& compared, const WorstCorner& worst,
                    const std::string& what) {
    const ComparedPart& part = part_of(compared.a, worst.corner_a / 3);
    const glm::vec3 at = place_of(compared.a, worst.corner_a);
    return fmt::format(
        "{}{}: {} at ({:.6g}, {:.6g}, {:.6g}), corner {} of triangle {}",
        part.name.empty() ? "" : part.name + ": ", what,
        std::isnan(worst.degrees) ? "undefined" : fmt::format("{:.4g} degrees", worst.degrees),
        at.x, at.y, at.z, worst.corner_a % 3, worst.corner_a / 3 - part.first_triangle);
}

/// Returns the places with the largest differences of both attributes.
std::vector<std::string> worst_lines(const ModelComparison& compared) {
    constexpr std::size_t shown = 3;
    std::vector<std::string> lines;
    const auto add = [&](const std::vector<WorstCorner>& corners, const std::string& what) {
        std::vector<glm::vec3> places;  // Corners at one position share a line.
        for (const WorstCorner& worst : corners) {
            const glm::vec3 place = place_of(compared.a, worst.corner_a);
            if (std::find(places.begin(), places.end(), place) != places.end()) continue;
            places.push_back(place);
            if (places.size() > shown) return;
            lines.push_back(as_text(compared, worst, what));
        }
    };
    add(compared.all.worst_normals, "normal");
    add(compared.all.worst_tangents, "tangent");
    return lines;
}

std::string matched_text(const ModelComparison& compared) {
    const CornerMatch& match = compared.match;
    std::string text =
        fmt::format("{} by position{}", counted(match.exact + match.near, "triangle"),
                    match.by_texcoord ? " and texture coordinate" : "");
    if (match.near != 0) {
        text += fmt::format(
            ", {} of them within {:.3g}{}", match.near, compared.options.position_tolerance,
            match.by_texcoord ? fmt::format(" and {:.3g}", compared.options.texcoord_tolerance)
                              : "");
    }
    if (compared.a.in_world_space) text += ", in world space";
    return text;
}

/// Returns a line per file about its triangles without partner.
std::vector<std::string> unmatched_lines(const ModelComparison& compared) {
    const auto line = [](const char* where, const std::vector<ComparedPart>& parts,
                         const std::vector<std::uint32_t>& only) {
        std::string text = fmt::format("{} only in {}", counted(only.size(), "triangle"), where);
        const auto first = std::find_if(parts.begin(), parts.end(), [](const ComparedPart& part) {
            return part.unmatched != 0;
        });
        if (first != parts.end()) {
            text += fmt::format(" (first: {}triangle {})",
                                first->name.empty() ? "" : first->name + ", ",
                                only.front() - first->first_triangle);
        }
        return text;
    };
    std::vector<std::string> lines;
    const CornerMatch& match = compared.match;
    if (!match.only_a.empty()) lines.push_back(line("A", compared.a.parts, match.only_a));
    if (!match.only_b.empty()) lines.push_back(line("B", compared.b.parts, match.only_b));
    return lines;
}

/// Returns a line per primitive of A if there are several.
std::vector<std::string> part_lines(const ModelComparison& compared) {
    if (compared.a.parts.size() < 2) return {};
    std::vector<std::string> lines;
    for (const ComparedPart& part : compared.a.parts) {
        if (lines.size() == max_parts) {
            lines.push_back(fmt::format("... and {} more (--json lists all)",
                                        compared.a.parts.size() - lines.size()));
            break;
        }
        const FrameComparison& own = part.comparison;
        std::string text = fmt::format("{}: {}", part.name, counted(own.corners, "corner"));
        if (own.normals.count != 0) text += fmt::format(", normals up to {:.4g}", own.normals.max);
        if (own.tangents.count != 0)
            text += fmt::format(", tangents up to {:.4g}", own.tangents.max);
        if (own.normals.count + own.tangents.count != 0) text += " degrees";
        if (own.sign_differences != 0)
            text += fmt::format(", {}", counted(own.sign_differences, "different sign"));
        if (part.unmatched != 0)
            text += fmt::format(", {} unmatched", counted(part.unmatched, "triangle"));
        lines.push_back(std::move(text));
    }
    return lines;
}

std::string as_text(const std::filesystem::path& file, const JoinedModel& model) {
    return fmt::format("{}: {}, {}, {}", file.string(), format_name(readable_format(file)),
                       counted(model.parts.size(), "primitive"),
                       counted(model.mesh.triangles.size(), "triangle"));
}

bool any_has(const JoinedModel& model, bool ComparedPart::*attribute) {
    return std::any_of(model.parts.begin(), model.parts.end(),
                       [&](const ComparedPart& part) { return part.*attribute; });
}

Json json_of(const ErrorStats& angles) {
    return {{"corners", angles.count},
            {"undefined", angles.undefined},
            {"rms", angles.rms},
            {"mean", angles.mean},
            {"p99", angles.p99},
            {"max", angles.max},
            {"histogram", histogram_json(angles)}};
}

Json worst_json(const ModelComparison& compared, const std::vector<WorstCorner>& corners) {
    return json_list(corners, [&](const WorstCorner& worst) -> Json {
        const ComparedPart& part = part_of(compared.a, worst.corner_a / 3);
        const ComparedPart& other = part_of(compared.b, worst.corner_b / 3);
        const glm::vec3 at = place_of(compared.a, worst.corner_a);
        return {{"degrees", std::isnan(worst.degrees) ? Json() : Json(worst.degrees)},
                {"position", {at.x, at.y, at.z}},
                {"primitive", part.name},
                {"triangle", worst.corner_a / 3 - part.first_triangle},
                {"corner", worst.corner_a % 3},
                {"triangle_of_b", worst.corner_b / 3 - other.first_triangle},
                {"corner_of_b", worst.corner_b % 3}};
    });
}

Json json_of(const ModelComparison& compared, const FrameComparison& own) {
    return {{"corners", own.corners},
            {"normals", json_of(own.normals)},
            {"tangents", json_of(own.tangents)},
            {"sign_differences", own.sign_differences},
            {"worst_normals", worst_json(compared, own.worst_normals)},
            {"worst_tangents", worst_json(compared, own.worst_tangents)}};
}

Json part_json(const ModelComparison& compared, const ComparedPart& part) {
    Json json = {
        {"name", part.name}, {"triangles", part.triangle_count}, {"only_in_a", part.unmatched}};
    json.update(json_of(compared, part.comparison));
    return json;
}

Summary summary_of(const CompareRequest& request, const ModelComparison& compared) {
    const CornerMatch& match = compared.match;
    const FrameComparison& all = compared.all;
    Summary summary;
    summary.add_tool("relief-mesh compare");
    summary.add("A", as_text(request.a, compared.a), {{"a", request.a.string()}});
    summary.add("B", as_text(request.b, compared.b), {{"b", request.b.string()}});
    summary.add("matched", matched_text(compared),
                {{"world_space", compared.a.in_world_space},
                 {"by_texture_coordinate", match.by_texcoord},
                 {"tolerance", compared.options.position_tolerance},
                 {"uv_tolerance", compared.options.texcoord_tolerance},
                 {"triangles",
                  {{"equal", match.exact},
                   {"near", match.near},
                   {"ambiguous", match.ambiguous},
                   {"only_in_a", match.only_a.size()},
                   {"only_in_b", match.only_b.size()}}}});
    summary.add("unmatched", unmatched_lines(compared));
    if (match.ambiguous != 0) {
        summary.add("ambiguous", fmt::format("{} matched to one of several at the same position",
                                             counted(match.ambiguous, "triangle")));
    }
    summary.add_json(json_of(compared, all));
    summary.add(
        "normals",
        attribute_lines(all.normals, any_has(compared.a, &ComparedPart::has_normals),
                        any_has(compared.b, &ComparedPart::has_normals), compared.normals_in_one));
    summary.add("tangents",
                attribute_lines(all.tangents, any_has(compared.a, &ComparedPart::has_tangents),
                                any_has(compared.b, &ComparedPart::has_tangents),
                                compared.tangents_in_one));
    if (all.sign_differences != 0) {
        summary.add("signs", fmt::format("{} with different handedness",
                                         counted(all.sign_differences, "tangent")));
    }
    summary.add("worst", worst_lines(compared));
    summary.add("parts", part_lines(compared),
                {{"primitives", json_list(compared.a.parts, [&](const ComparedPart& part) {
                      return part_json(compared, part);
                  })}});
    return summary;
}

struct CompareOptions {
    CompareRequest request;
    std::optional<double> max_angle;
    bool json = false;
    bool strict = false;
    GeneralOptions general;
};

/// Returns the differences above the limit.
std::string above_limit(const FrameComparison& all, double max_angle) {
    std::vector<std::string> words;
    const auto add = [&](const ErrorStats& angles, const char* what) {
        if (angles.max > max_angle)
            words.push_back(fmt::format("{} by {:.4g} degrees", what, angles.max));
        if (angles.undefined != 0)
            words.push_back(fmt::format("{} {} without direction", angles.undefined, what));
    };
    add(all.normals, "normals");
    add(all.tangents, "tangents");
    if (all.sign_differences != 0) words.push_back(counted(all.sign_differences, "tangent sign"));
    return fmt::format("{}", fmt::join(words, ", "));
}

ExitCode judge(const CLI::App& app, const CompareOptions& options,
               const ModelComparison& compared) {
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
    if (options.max_angle && !compared.has_directions()) {
        return fail(
            fmt::format("has neither normals nor tangents in common with {}, so --max-angle cannot "
                        "be checked (relief-mesh process computes them)",
                        options.request.a.string()));
    }
    if (options.max_angle && !compared.is_within(*options.max_angle)) {
        return fail(fmt::format("differs from {} by more than {} degrees: {}",
                                options.request.a.string(), *options.max_angle,
                                above_limit(compared.all, *options.max_angle)));
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
    const ModelComparison compared =
        stages.run("compare", [&] { return compare_files(options.request); });
    Summary summary = summary_of(options.request, compared);
    const std::optional<double>& limit = options.max_angle;
    summary.add_json({{"max_angle", or_null(limit)},
                      {"within", limit ? Json(compared.is_within(*limit)) : Json()},
                      {"complete", compared.is_complete()}});
    if (options.json)
        print_json(summary.json());
    else if (!options.general.quiet)
        summary.print();
    return judge(app, options, compared);
}

void add_matching_options(CLI::App& app, CompareRequest& request) {
    const char* group = "Matching";
    const Range distance{0.0, std::numeric_limits<double>::max(), "units"};
    add_number(app, "--tolerance", "DISTANCE", request.tolerance, distance,
               "The maximum distance of matching positions, in the unit of the models; equal "
               "positions match first, then the nearest. Default: 1e-5 of the model's size, the "
               "precision of six digits.")
        .group(group);
    add_number(app, "--uv-tolerance", "DISTANCE", request.uv_tolerance, distance,
               "The same for texture coordinates. Default: 1e-6, multiplied by the largest "
               "coordinate if that is above 1.")
        .group(group);
    add_switch(app, "--world", request.in_world_space,
               "Compare in world space, once per instance, for files with different nodes "
               "(quantized, flattened, re-exported). Default: in the object space of each "
               "primitive if both files are glTF.")
        .group(group);
    add_switch(app, "--ignore-uv", request.ignore_uv,
               "Match by position only. This is the default if a file has no texture coordinates.")
        .group(group);
}

}  // namespace

Command add_compare_command(CLI::App& tool) {
    CLI::App& app =
        add_subcommand(tool, "compare",
                       "Measures the differences between the normals and tangents of two models.");
    const auto options = std::make_shared<CompareOptions>();
    add_file(app, "A", options->request.a, "Model to read: .glb .gltf .obj .ply .stl .off");
    add_file(app, "B", options->request.b, "Model to compare with A; formats may differ.");
    add_number(app, "--max-angle", "DEG", options->max_angle, {0.0, 180.0, "degrees"},
               "Exit with 1 if a normal or tangent differs by more, if the sign of a tangent "
               "differs, or if there are none to compare.")
        .group("Verdict");
    add_switch(app, "--strict", options->strict,
               "Exit with 3 if a triangle has no match or several, if normals or tangents are in "
               "only one file, or if a direction is zero or not finite.")
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
