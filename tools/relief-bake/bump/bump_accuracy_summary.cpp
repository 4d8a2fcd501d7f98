// SPDX-License-Identifier: Apache-2.0
// Words, table and JSON of accuracy. Tests: tests/tools/bump_accuracy_test.cpp.
#include "bump/bump_accuracy_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "common/choices.h"
#include "common/text.h"

namespace relief::tools {
namespace {

std::string precision_words(const BumpMethod& method) {
    return method.arithmetic == Arithmetic::float64 ? "float64" : "float32";
}

/// The table of --compare, best first.
std::vector<std::string> table(const BumpExperiment& experiment) {
    std::vector<const BumpMeasurement*> rows;
    for (const BumpMeasurement& one : experiment.measurements)
        rows.push_back(&one);
    std::stable_sort(rows.begin(), rows.end(),
                     [](const auto* a, const auto* b) { return a->error.rms < b->error.rms; });
    std::vector<std::string> lines = {
        fmt::format("{:<12} {:<9} {:<4} {:<6} {:>9} {:>9} {:>9} {:>9} {:>9}", "kernel", "precision",
                    "bits", "steps", "RMS deg", "max deg", "with map", "time", "MPixel/s")};
    for (const BumpMeasurement* row : rows) {
        lines.push_back(
            fmt::format("{:<12} {:<9} {:<4} {:<6} {:>9.3g} {:>9.3g} {:>9.3g} {:>9} {:>9.0f} {}",
                        kernel_words(row->method), precision_words(row->method), row->method.bits,
                        row->method.destaircased ? "smooth" : "as is", row->error.rms,
                        row->error.max, expected_error(experiment.reference, *row).total(),
                        duration(1000.0 * row->seconds.median), row->megapixels_per_second,
                        row->is_efficient ? "*" : ""));
    }
    lines.emplace_back("RMS and max: what the conversion adds; with map: RMS expected in all");
    lines.emplace_back("* no other method is both faster and more accurate");
    for (std::string& line : lines)
        line.erase(line.find_last_not_of(' ') + 1);
    return lines;
}

std::string where_words(const BumpExperiment& experiment) {
    return fmt::format("measured on {} of the map, against {}",
                       experiment.is_whole ? "all" : fmt::format("{} texels", experiment.texels),
                       experiment.reference.words);
}

/// Returns the expected error of a conversion against the surface that the map was made of.
nlohmann::ordered_json expected_json(const ExpectedError& error) {
    return {{"map", error.map}, {"added", error.added}, {"total", error.total()}};
}

nlohmann::ordered_json measurement_json(const BumpMeasurement& one,
                                        const BumpReference& reference) {
    const BumpMethod& method = one.method;
    return {{"kernel", name_of(method.kernel, kernel_choices())},
            {"kernel_radius", method.kernel == Kernel::gaussian
                                  ? nlohmann::ordered_json(method.gaussian_radius)
                                  : nullptr},
            {"precision", precision_words(method)},
            {"bits", method.bits},
            {"destaircased", method.destaircased},
            {"degrees",
             {{"rms", one.error.rms},
              {"mean", one.error.mean},
              {"p99", one.error.p99},
              {"max", one.error.max}}},
            {"expected_degrees", expected_json(expected_error(reference, one))},
            {"milliseconds",
             {{"median", 1000.0 * one.seconds.median},
              {"p10", 1000.0 * one.seconds.p10},
              {"p90", 1000.0 * one.seconds.p90}}},
            {"megapixels_per_second", one.megapixels_per_second},
            {"efficient", one.is_efficient}};
}

/// Returns the expected error of the map and the kernel, in float64 and without rounding.
std::string expectation_words(const KernelChoice& choice) {
    if (std::isnan(choice.rms_degrees)) return "unknown";
    const char* const why = choice.noise > 0.0
                                ? ", by how much detail the noise hides"
                                : ", by whether fine detail is true, and how fine it is";
    return fmt::format("{} degrees RMS, {:.2g} at most, by the map and this kernel{}",
                       expected_words(choice), choice.upper_max_degrees,
                       choice.is_range() ? why : "");
}

nlohmann::ordered_json grain_json(const KernelChoice& choice) {
    if (!choice.otherwise) return nullptr;
    const KernelPrediction& best = choice.otherwise->best;
    return {{"taken_for", choice.noise > 0.0 ? "noise" : "detail"},
            {"deviation", choice.grain},
            {"ambiguous", choice.is_ambiguous()},
            {"otherwise",
             {{"expected_degrees", choice.otherwise->rms_degrees},
              {"best_kernel", kernel_words({best.kernel, best.gaussian_radius})},
              {"best_expected_degrees", best.rms_degrees}}}};
}

}  // namespace

std::string kernel_words(const BumpMethod& method) {
    const std::string name = name_of(method.kernel, kernel_choices());
    return method.kernel == Kernel::gaussian ? fmt::format("{} {}", name, method.gaussian_radius)
                                             : name;
}

std::string method_words(const BumpMethod& method) {
    return fmt::format("{} in {}, {} bit{}", kernel_words(method), precision_words(method),
                       method.bits, method.destaircased ? ", steps smoothed away" : "");
}

void print_accuracy(const AccuracyFound& found) {
    // What keeps within a bound was not taken for being the truest.
    if (found.choice && !found.kept) {
        print_entry("because", found.choice->reason);
        print_entry("expected", expectation_words(*found.choice));
    }
    if (found.step > 0.0) {
        print_entry("steps",
                    fmt::format("smoothed away: of 1/{:.0f}, heights moved by half of that at most",
                                1.0 / found.step));
    }
    if (found.kept) {
        const ExpectedError error = expected_error(found.experiment->reference, *found.kept);
        print_entry("kept", fmt::format("{}: {:.3g} degrees RMS expected",
                                        method_words(found.kept->method), error.total()));
        print_entry(
            "", fmt::format("{:.3g} from the map itself, {:.3g} added by this conversion ({:.3g} "
                            "at most), {:.0f} MPixel/s",
                            error.map, error.added, found.kept->error.max,
                            found.kept->megapixels_per_second));
    }
    if (!found.experiment) return;
    print_entry("errors", where_words(*found.experiment));
    if (!found.kept) print_entry("", table(*found.experiment));
}

void add_accuracy(const AccuracyFound& found, nlohmann::ordered_json& report) {
    if (found.choice && !found.kept) {
        report["kernel_reason"] = found.choice->reason;
        report["expected_degrees"] = found.choice->rms_degrees;
        report["expected_degrees_upper"] = found.choice->upper_rms_degrees;
        report["grain"] = grain_json(*found.choice);
    }
    report["destaircased_step"] =
        found.step > 0.0 ? nlohmann::ordered_json(found.step) : nlohmann::ordered_json(nullptr);
    if (!found.experiment) return;
    const BumpExperiment& experiment = *found.experiment;
    report["reference"] = {{"what", experiment.reference.words},
                           {"own_degrees", experiment.reference.own_degrees},
                           {"texels", experiment.texels},
                           {"whole", experiment.is_whole}};
    if (found.kept) report["kept"] = measurement_json(*found.kept, experiment.reference);
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    for (const BumpMeasurement& one : experiment.measurements)
        all.push_back(measurement_json(one, experiment.reference));
    report["comparison"] = all;
}

}  // namespace relief::tools
