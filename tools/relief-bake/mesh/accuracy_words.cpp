// SPDX-License-Identifier: Apache-2.0
// Options, words, table and JSON of accuracy. Tests: tests/tools/relief_bake_accuracy_test.cpp.
#include "mesh/accuracy_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/choices.h"
#include "common/options.h"
#include "common/text.h"
#include "mesh/mesh_verify.h"

namespace relief::tools {
namespace {

std::string sample_words(const MeasuredBake& bake) {
    return bake.samples.is_auto ? fmt::format("auto {:g}", bake.sample_angle.value_or(0.0))
                                : fmt::format("{}", bake.samples.count);
}

/// The table of --compare, best first.
std::vector<std::string> table(const MeshAccuracy& accuracy) {
    std::vector<const MeasuredBake*> rows;
    for (const MeasuredBake& one : accuracy.measured)
        rows.push_back(&one);
    std::stable_sort(rows.begin(), rows.end(),
                     [](const auto* a, const auto* b) { return a->error.rms < b->error.rms; });
    std::vector<std::string> lines = {
        fmt::format("{:<9} {:<4} {:<10} {:>9} {:>9} {:>9} {:>9} {:>9}", "samples", "bits", "dither",
                    "RMS deg", "99% deg", "max deg", "time", "MRays/s")};
    for (const MeasuredBake* row : rows) {
        const double rate =
            row->seconds > 0.0 ? static_cast<double>(row->rays) / row->seconds / 1e6 : 0.0;
        lines.push_back(fmt::format(
            "{:<9} {:<4} {:<10} {:>9.3g} {:>9.3g} {:>9.3g} {:>9} {:>9.2f} {}", sample_words(*row),
            row->format.bits, name_of(row->format.dither, dither_choices()), row->error.rms,
            row->error.p99, row->error.max, duration(1000.0 * row->seconds), rate,
            row->is_efficient ? "*" : ""));
    }
    lines.emplace_back(
        "* no other method is both faster and more accurate; auto casts 4 samples, and 16 where "
        "they are "
        "so many degrees apart");
    for (std::string& line : lines)
        line.erase(line.find_last_not_of(' ') + 1);
    return lines;
}

/// What --max-error tried: a line for each count of samples.
std::vector<std::string> step_lines(const MeshBakeRequest& request, const MeshAccuracy& accuracy) {
    std::vector<std::string> lines;
    const MeasuredBake* before = nullptr;
    for (const MeasuredBake& one : accuracy.measured) {
        const bool is_new = before == nullptr || before->samples.count != one.samples.count;
        const auto bytes = std::uintmax_t{3} * static_cast<unsigned>(one.format.bits / 8) *
                           static_cast<unsigned>(request.size.x) *
                           static_cast<unsigned>(request.size.y);
        const std::string error =
            fmt::format("{:.3g} in {} bit ({} at most)", bounded(one.error, request.accuracy.bound),
                        one.format.bits, byte_size(bytes));
        if (is_new) {
            lines.push_back(
                fmt::format("{}, {} rays in {}: {}",
                            one.samples.is_auto
                                ? std::string("auto samples")
                                : counted(static_cast<std::size_t>(one.samples.count), "sample"),
                            one.rays, duration(1000.0 * one.seconds), error));
        } else {
            lines.back() += ", " + error;
        }
        before = &one;
    }
    return lines;
}

nlohmann::ordered_json measured_json(const MeasuredBake& one) {
    return {{"samples", one.samples.is_auto ? nlohmann::ordered_json("auto")
                                            : nlohmann::ordered_json(one.samples.count)},
            {"sample_angle", one.sample_angle ? nlohmann::ordered_json(*one.sample_angle)
                                              : nlohmann::ordered_json(nullptr)},
            {"bits", one.format.bits},
            {"dither", name_of(one.format.dither, dither_choices())},
            {"rms", one.error.rms},
            {"mean", one.error.mean},
            {"p99", one.error.p99},
            {"max", one.error.max},
            {"rounding", one.rounding.rms},
            {"sampling", one.sampling.rms},
            {"rays", one.rays},
            {"milliseconds", 1000.0 * one.seconds},
            {"efficient", one.is_efficient}};
}

}  // namespace

std::string method_words(const MeasuredBake& bake) {
    const std::string samples =
        bake.samples.is_auto
            ? fmt::format("auto samples at {:g} degrees", bake.sample_angle.value_or(0.0))
            : counted(static_cast<std::size_t>(bake.samples.count), "sample");
    return fmt::format("{}, {} bit{}", samples, bake.format.bits,
                       bake.format.dither == Dither::none ? "" : ", dithered");
}

void add_accuracy_options(CLI::App& app, AccuracyChoice& choice) {
    add_bound_options(app, choice.bound,
                      "Raise samples and bits, but for those that are told, until the error, "
                      "measured on this map against the mean over each texel, is within DEG "
                      "degrees; refuse if it never is.");
    add_switch(app, "--compare", choice.compare,
               "Also bake in every way, in memory, and print error beside time.")
        .group("Accuracy");
}

void print_accuracy(const MeshBakeRequest& request, const MeshAccuracy& accuracy) {
    if (accuracy.kept) {
        print_entry("steps", step_lines(request, accuracy));
        print_entry("kept", fmt::format("{}: {}", method_words(*accuracy.kept),
                                        error_words(accuracy.kept->error)));
    }
    print_entry("errors",
                fmt::format("measured on {} of the map, against {} samples a texel",
                            accuracy.is_whole ? "all" : fmt::format("{} texels", accuracy.texels),
                            accuracy.reference_samples));
    if (!accuracy.kept) print_entry("", table(accuracy));
}

void add_accuracy(const MeshAccuracy& accuracy, nlohmann::ordered_json& report) {
    report["reference"] = {{"samples", accuracy.reference_samples},
                           {"rays", accuracy.reference_rays},
                           {"texels", accuracy.texels},
                           {"whole", accuracy.is_whole}};
    if (accuracy.kept) report["kept"] = measured_json(*accuracy.kept);
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    for (const MeasuredBake& one : accuracy.measured)
        all.push_back(measured_json(one));
    report[accuracy.kept ? "steps" : "comparison"] = all;
}

}  // namespace relief::tools
