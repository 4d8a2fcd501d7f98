// SPDX-License-Identifier: Apache-2.0
// Options, words and JSON of a check against the surface.
// Tests: tests/tools/relief_bake_verify_test.cpp.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "common/file_jobs.h"
#include "common/options.h"
#include "common/text.h"
#include "mesh/convention_words.h"
#include "mesh/mesh_sets.h"
#include "mesh/mesh_verify.h"

namespace relief::tools {
namespace {

Choices<BoundKind> bound_kinds() {
    return {{"rms", BoundKind::rms}, {"p99", BoundKind::p99}, {"max", BoundKind::max}};
}

constexpr std::array stage_names = {"projection", "sampling", "quantisation", "basis", "other"};

std::vector<std::string> stage_lines(const BakeCheck& check) {
    constexpr std::array meanings = {"texels that have no one normal", "few samples for many",
                                     "rounding to codes", "axes that are no right angle",
                                     "codes that this bake does not make"};
    std::vector<std::string> lines;
    for (std::size_t i = 0; i < bake_stage_count; ++i) {
        lines.push_back(fmt::format("{:<12} {:>6.1f} %  {:>8.3g} degrees RMS  {}", stage_names[i],
                                    100.0 * check.stages[i].share, check.stages[i].rms,
                                    meanings[i]));
    }
    return lines;
}

std::string texel_words(const BakeCheck& check) {
    std::string words = counted(check.error.count, "texel");
    if (check.torn > 0) words += fmt::format(", {} of them torn by the projection", check.torn);
    if (check.missed > 0) words += fmt::format("; {} missed, without a truth", check.missed);
    if (check.frameless > 0) words += fmt::format("; {} without a frame", check.frameless);
    return words;
}

std::string worst_words(const BakeCheck& check) {
    std::string words;
    for (std::size_t i = 0; i < std::min<std::size_t>(check.worst.size(), 4); ++i) {
        const WorstTexel& texel = check.worst[i];
        words += fmt::format("{}({}, {}): {:.3g}{}", i == 0 ? "" : "; ", texel.x, texel.y,
                             texel.degrees, texel.is_torn ? " torn" : "");
    }
    return words;
}

std::vector<std::string> verdict_lines(const VerifiedMap& map) {
    if (map.trouble.empty()) {
        return {map.request.bound.degrees ? fmt::format("within {}", bound_words(map.request.bound))
                                          : "as this bake makes it"};
    }
    std::vector<std::string> lines = map.trouble;
    for (const std::string& remedy : map.remedies)
        lines.push_back("-> " + remedy);
    return lines;
}

nlohmann::ordered_json summary_json(const AngleSummary& summary) {
    return {{"rms", summary.rms},
            {"mean", summary.mean},
            {"p99", summary.p99},
            {"max", summary.max},
            {"texels", summary.count}};
}

nlohmann::ordered_json convention_json(const ConventionFit& fit) {
    return {{"searched", fit.was_searched},        {"explained", fit.is_explained},
            {"differs_in", convention_parts(fit)}, {"told_degrees", fit.told_degrees},
            {"found_degrees", fit.found_degrees},  {"tried", fit.tried}};
}

}  // namespace

void add_bound_options(CLI::App& app, ErrorBound& bound, const std::string& description) {
    const std::string group = "Accuracy";
    add_number(app, "--max-error", "DEG", bound.degrees, {0.0, 180.0, "degrees"}, description)
        .group(group);
    add_choice(app, "--max-error-kind", bound.kind, bound_kinds(),
               "Whether --max-error is for the root mean square, for 99 of 100 texels, or for the "
               "greatest error. Default: rms.")
        .group(group);
}

void check(const ErrorBound& bound) {
    if (bound.kind && !bound.degrees)
        throw UsageError("--max-error-kind: is for --max-error", "give --max-error DEG");
}

std::string bound_words(const ErrorBound& bound) {
    const BoundKind kind = bound.kind.value_or(BoundKind::rms);
    return fmt::format("{:g} degrees ({})", bound.degrees.value_or(0.0),
                       kind == BoundKind::rms   ? "RMS"
                       : kind == BoundKind::p99 ? "99 of 100 texels"
                                                : "greatest");
}

double bounded(const AngleSummary& summary, const ErrorBound& bound) {
    const BoundKind kind = bound.kind.value_or(BoundKind::rms);
    return kind == BoundKind::rms   ? summary.rms
           : kind == BoundKind::p99 ? summary.p99
                                    : summary.max;
}

std::string error_words(const AngleSummary& summary) {
    return fmt::format("RMS {:.3g} degrees, mean {:.3g}, 99 of 100 within {:.3g}, {:.3g} at most",
                       summary.rms, summary.mean, summary.p99, summary.max);
}

void add_error_map_option(CLI::App& app, std::optional<std::filesystem::path>& file) {
    add_path(app, "--error-map", file,
             "Write the error of every texel: .png from black, none, to pale yellow, the scale "
             "printed; .exr or .tif in degrees.")
        .group("Accuracy");
}

void add_verify_options(CLI::App& app, VerifyChoice& choice) {
    add_switch(app, "--verify", choice.wanted,
               "Read the finished map back, hold every texel against the high models as a renderer "
               "shows it, and say how far off it is and why.")
        .group("Accuracy");
    add_error_map_option(app, choice.error_map);
}

void check_error_map(const std::optional<std::filesystem::path>& file,
                     const std::vector<std::filesystem::path>& files) {
    if (!file) return;
    const std::string extension = extension_of(*file);
    if (extension != ".png" && extension != ".exr" && extension != ".tif" && extension != ".tiff") {
        throw UsageError(fmt::format("--error-map {}: no format to write it in", file->string()),
                         "use .png, .exr or .tif");
    }
    for (const std::filesystem::path& other : files) {
        if (identity_of(*file) == identity_of(other))
            throw UsageError(
                fmt::format("--error-map {}: is also the input or the output", file->string()));
    }
    require_folder_of(*file);
}

void check_verify(const MeshBakeRequest& request, const std::vector<std::filesystem::path>& files) {
    if (!request.verify.error_map) return;
    if (!request.verify.wanted)
        throw UsageError("--error-map: has no effect without --verify", "give --verify");
    if (names_word(request.output, material_word) || names_word(request.output, tile_word))
        throw UsageError("--error-map: is of one map, not those of <material> or <UDIM>",
                         "relief-bake check makes it of each");
    check_error_map(request.verify.error_map, files);
}

void print_verified(const VerifiedMap& map) {
    const BakeCheck& check = map.check;
    print_entry(
        "error",
        {error_words(check.error) +
             fmt::format(", from the mean over each texel ({} samples)", check.reference_samples),
         error_words(check.centre) + ", from the normal at its centre", texel_words(check)});
    print_entry("stages", stage_lines(check));
    if (check.error.max > 0.0) print_entry("worst", worst_words(check));
    print_entry("verdict", verdict_lines(map));
    if (map.request.error_map) {
        print_entry("errors", fmt::format("{} ({:g} degrees is brightest)",
                                          file_and_size(*map.request.error_map), map.brightest));
    }
    print_entry("checked", fmt::format("{} rays, {}", check.rays, duration(map.milliseconds)));
}

nlohmann::ordered_json verified_json(const VerifiedMap& map) {
    const BakeCheck& check = map.check;
    nlohmann::ordered_json stages = nlohmann::ordered_json::object();
    for (std::size_t i = 0; i < bake_stage_count; ++i)
        stages[stage_names[i]] = {{"share", check.stages[i].share}, {"rms", check.stages[i].rms}};
    nlohmann::ordered_json worst = nlohmann::ordered_json::array();
    for (const WorstTexel& texel : check.worst) {
        worst.push_back(
            {{"x", texel.x}, {"y", texel.y}, {"degrees", texel.degrees}, {"torn", texel.is_torn}});
    }
    nlohmann::ordered_json json = {{"error", summary_json(check.error)},
                                   {"centre", summary_json(check.centre)},
                                   {"remade", summary_json(check.remade)},
                                   {"reference_samples", check.reference_samples},
                                   {"torn", check.torn},
                                   {"missed", check.missed},
                                   {"frameless", check.frameless},
                                   {"stages", stages},
                                   {"worst", worst},
                                   {"convention", convention_json(check.convention)},
                                   {"trouble", map.trouble},
                                   {"remedies", map.remedies},
                                   {"rays", check.rays},
                                   {"milliseconds", map.milliseconds}};
    if (map.request.error_map) {
        json["error_map"] = {{"file", map.request.error_map->string()},
                             {"brightest", map.brightest}};
    }
    return json;
}

}  // namespace relief::tools
