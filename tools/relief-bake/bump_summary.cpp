// SPDX-License-Identifier: Apache-2.0
// The summary of `relief-bake bump` as text, as a line and as JSON.
// Tests: tests/tools/relief_bake_bump_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "bump.h"
#include "common/choices.h"
#include "common/text.h"

namespace relief::tools {
namespace {

/// "gaussian of radius 2", or the plain name.
std::string kernel_text(const BumpOptions& bump) {
    const std::string name = name_of(*bump.kernel, kernel_choices());
    return bump.kernel == Kernel::gaussian
               ? fmt::format("{} of radius {}", name, bump.gaussian_radius)
               : name;
}

std::string depth_text(const BumpRequest& request, const BumpOptions& bump) {
    if (!request.height) return fmt::format("strength {:g} texels", bump.strength);
    return fmt::format("height {:g} over texels of {:g} x {:g}", bump.strength, bump.texel.x,
                       bump.texel.y);
}

/// The speed of the conversion itself, without reading and writing.
double megapixels_per_second(const BumpConversion& conversion, const Stages& stages) {
    const double milliseconds = stages.milliseconds("convert");
    const double pixels = static_cast<double>(conversion.input.width) * conversion.input.height;
    return milliseconds > 0 ? pixels / milliseconds / 1000 : 0;
}

/// "clamp at the border", with the evidence if the mode was chosen from the map.
std::string border_text(const BumpConversion& conversion) {
    const std::string text = wrap_text(*conversion.bump.wrap) + " at the border";
    if (!conversion.tiling) return text;
    return fmt::format("{} (differences across the seams are {:.2g} and {:.2g} times those inside)",
                       text, conversion.tiling->seam_x, conversion.tiling->seam_y);
}

std::string input_text(const Job& job, const BumpConversion& conversion) {
    const ImageInfo& input = conversion.input;
    std::string text =
        fmt::format("{}: {} x {}, {}, {} bit", job.input.string(), input.width, input.height,
                    counted(static_cast<std::size_t>(input.channels), "channel"), input.bits);
    if (conversion.is_streamed) text += ", row by row";
    if (conversion.transparent > 0)
        text += fmt::format(", {} left flat", counted(conversion.transparent, "transparent texel"));
    return text;
}

std::string format_text(const BumpFileFormat& format) {
    if (format.content == BumpContent::slope_moments) {
        return fmt::format("slope moments, 32 bit float, dh/dy {}{}",
                           name_of(format.normals.green, green_choices()),
                           format.write.half ? ", half floats" : "");
    }
    std::string text = to_string(format.normals);
    if (format.xy_only) text += ", without z";
    if (format.alpha == MapAlpha::height) text += ", height in alpha";
    if (format.alpha == MapAlpha::keep) text += ", alpha kept";
    if (format.write.half) text += ", half floats";
    return text;
}

std::string precision_name(const BumpMethod& method) {
    return method.arithmetic == Arithmetic::float64 ? "float64" : "float32";
}

/// The table of --compare, sorted by error.
std::vector<std::string> comparison_table(const BumpExperiment& experiment) {
    std::vector<const BumpMeasurement*> rows;
    for (const BumpMeasurement& measurement : experiment.measurements)
        rows.push_back(&measurement);
    std::stable_sort(rows.begin(), rows.end(),
                     [](const auto* a, const auto* b) { return a->error.rms < b->error.rms; });
    std::vector<std::string> lines = {
        fmt::format("{:<12} {:<9} {:<4} {:<6} {:>9} {:>9} {:>9} {:>9} {:>9}", "kernel", "precision",
                    "bits", "steps", "RMS deg", "max deg", "with map", "time", "MPixel/s")};
    for (const BumpMeasurement* row : rows) {
        lines.push_back(
            fmt::format("{:<12} {:<9} {:<4} {:<6} {:>9.3g} {:>9.3g} {:>9.3g} {:>9} {:>9.0f} {}",
                        kernel_name(row->method), precision_name(row->method), row->method.bits,
                        row->method.destaircased ? "smooth" : "as is", row->error.rms,
                        row->error.max, expected_error(experiment.reference, *row).total(),
                        duration(1000.0 * row->seconds.median), row->megapixels_per_second,
                        row->is_pareto_optimal ? "*" : ""));
    }
    lines.emplace_back("RMS and max: added by the conversion; with map: total expected RMS error");
    lines.emplace_back("* no other method is both faster and more accurate");
    for (std::string& line : lines)
        line.erase(line.find_last_not_of(' ') + 1);
    return lines;
}

/// The expected error of the map and the kernel, in float64 and without rounding.
std::string expectation_text(const KernelChoice& choice) {
    if (std::isnan(choice.rms_degrees)) return "unknown";
    const char* const range_reason =
        choice.noise > 0.0 ? "; the range depends on how much detail the noise hides"
                           : "; the range depends on whether fine detail is real, and how fine";
    return fmt::format("{} degrees RMS, {:.2g} at most, from the map and this kernel{}",
                       expected_error_text(choice), choice.upper_max_degrees,
                       choice.is_range() ? range_reason : "");
}

void print_accuracy(const BumpAccuracy& accuracy) {
    // With a limit, the kernel is not chosen for its accuracy alone.
    if (accuracy.choice && !accuracy.selected) {
        print_entry("because", accuracy.choice->reason);
        print_entry("expected", expectation_text(*accuracy.choice));
    }
    if (accuracy.step > 0.0) {
        print_entry("steps", fmt::format("smoothed: steps of 1/{:.0f}; heights moved by at most "
                                         "half a step",
                                         1.0 / accuracy.step));
    }
    if (accuracy.selected) {
        const BumpMeasurement& selected = *accuracy.selected;
        const ExpectedError error = expected_error(accuracy.experiment->reference, selected);
        print_entry("selected", fmt::format("{}: {:.3g} degrees RMS expected",
                                            to_string(selected.method), error.total()));
        print_entry("", fmt::format("{:.3g} from the map itself, {:.3g} added by this conversion "
                                    "({:.3g} at most), {:.0f} MPixel/s",
                                    error.map, error.added, selected.error.max,
                                    selected.megapixels_per_second));
    }
    if (!accuracy.experiment) return;
    const BumpExperiment& experiment = *accuracy.experiment;
    print_entry(
        "errors",
        fmt::format("measured on {} of the map, against {}",
                    experiment.is_whole ? "all" : fmt::format("{} texels", experiment.texels),
                    experiment.reference.words));
    if (!accuracy.selected) print_entry("", comparison_table(experiment));
}

nlohmann::ordered_json measurement_json(const BumpMeasurement& measurement,
                                        const BumpReference& reference) {
    const BumpMethod& method = measurement.method;
    const ExpectedError expected = expected_error(reference, measurement);
    return {{"kernel", name_of(method.kernel, kernel_choices())},
            {"kernel_radius", method.kernel == Kernel::gaussian
                                  ? nlohmann::ordered_json(method.gaussian_radius)
                                  : nullptr},
            {"precision", precision_name(method)},
            {"bits", method.bits},
            {"destaircased", method.destaircased},
            {"degrees",
             {{"rms", measurement.error.rms},
              {"mean", measurement.error.mean},
              {"p99", measurement.error.p99},
              {"max", measurement.error.max}}},
            {"expected_degrees",
             {{"map", expected.map},
              {"added", expected.added},
              {"total", expected.total()},
              {"total_upper", expected_error_upper(reference, measurement).total()}}},
            {"milliseconds",
             {{"median", 1000.0 * measurement.seconds.median},
              {"p10", 1000.0 * measurement.seconds.p10},
              {"p90", 1000.0 * measurement.seconds.p90}}},
            {"megapixels_per_second", measurement.megapixels_per_second},
            {"efficient", measurement.is_pareto_optimal}};
}

nlohmann::ordered_json grain_json(const KernelChoice& choice) {
    if (!choice.otherwise) return nullptr;
    const KernelPrediction& best = choice.otherwise->best;
    return {{"taken_for", choice.noise > 0.0 ? "noise" : "detail"},
            {"deviation", choice.grain},
            {"ambiguous", choice.is_ambiguous()},
            {"otherwise",
             {{"expected_degrees", choice.otherwise->rms_degrees},
              {"best_kernel", kernel_name({best.kernel, best.gaussian_radius})},
              {"best_expected_degrees", best.rms_degrees}}}};
}

void add_accuracy(const BumpAccuracy& accuracy, nlohmann::ordered_json& json) {
    if (accuracy.choice && !accuracy.selected) {
        json["kernel_reason"] = accuracy.choice->reason;
        json["expected_degrees"] = accuracy.choice->rms_degrees;
        json["expected_degrees_upper"] = accuracy.choice->upper_rms_degrees;
        json["grain"] = grain_json(*accuracy.choice);
    }
    json["destaircased_step"] = accuracy.step > 0.0 ? nlohmann::ordered_json(accuracy.step)
                                                    : nlohmann::ordered_json(nullptr);
    if (!accuracy.experiment) return;
    const BumpExperiment& experiment = *accuracy.experiment;
    json["reference"] = {{"what", experiment.reference.words},
                         {"own_degrees", experiment.reference.reference_degrees},
                         {"texels", experiment.texels},
                         {"whole", experiment.is_whole}};
    if (accuracy.selected)
        json["kept"] = measurement_json(*accuracy.selected, experiment.reference);
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    for (const BumpMeasurement& measurement : experiment.measurements)
        all.push_back(measurement_json(measurement, experiment.reference));
    json["comparison"] = all;
}

}  // namespace

std::string kernel_name(const BumpMethod& method) {
    const std::string name = name_of(method.kernel, kernel_choices());
    return method.kernel == Kernel::gaussian ? fmt::format("{} {}", name, method.gaussian_radius)
                                             : name;
}

std::string to_string(const BumpMethod& method) {
    return fmt::format("{} in {}, {} bit{}", kernel_name(method), precision_name(method),
                       method.bits, method.destaircased ? ", steps smoothed" : "");
}

void print_summary(const Job& job, const BumpRequest& request, const BumpConversion& conversion,
                   const Stages& stages) {
    print_entry("read", input_text(job, conversion));
    print_entry("slopes",
                fmt::format("{}, {}, {}", kernel_text(conversion.bump),
                            depth_text(request, conversion.bump), border_text(conversion)));
    print_accuracy(conversion.accuracy);
    print_entry("format", format_text(conversion.format));
    print_entry("findings", conversion.findings.empty() ? std::vector<std::string>{"none"}
                                                        : conversion.findings.lines());
    print_entry("time", fmt::format("{} ({:.0f} MPixel/s without file access)",
                                    durations(stages.finished()),
                                    megapixels_per_second(conversion, stages)));
    print_entry("wrote", file_and_size(job.output));
}

std::string line_of(const Job& job, const BumpConversion& conversion, const Stages& stages) {
    double sum = 0;
    for (const Stage& stage : stages.finished())
        sum += stage.milliseconds;
    return fmt::format("{}: {} x {}, {}, {}, {}", job.output.string(), conversion.input.width,
                       conversion.input.height, kernel_text(conversion.bump),
                       conversion.findings.empty()
                           ? "no findings"
                           : counted(conversion.findings.all().size(), "finding"),
                       duration(sum));
}

nlohmann::ordered_json results_json(const BumpConversion& conversion, const Stages& stages) {
    const BumpOptions& bump = conversion.bump;
    const NormalMapFormat& format = conversion.format.normals;
    const bool has_radius = bump.kernel == Kernel::gaussian;
    const bool has_moments = conversion.format.content == BumpContent::slope_moments;
    nlohmann::ordered_json seams = nullptr;
    if (conversion.tiling) seams = {conversion.tiling->seam_x, conversion.tiling->seam_y};
    nlohmann::ordered_json json = {
        {"width", conversion.input.width},
        {"height", conversion.input.height},
        {"by_rows", conversion.is_streamed},
        {"transparent", conversion.transparent},
        {"kernel", name_of(*bump.kernel, kernel_choices())},
        {"kernel_radius", has_radius ? nlohmann::ordered_json(bump.gaussian_radius) : nullptr},
        {"strength", bump.strength},
        {"texel_size", {bump.texel.x, bump.texel.y}},
        {"wrap", wrap_text(*bump.wrap)},
        {"seams", seams},
        {"content", has_moments ? "slope moments" : "normals"},
        {"xy_only", conversion.format.xy_only},
        {"alpha", name_of(conversion.format.alpha, map_alpha_choices())},
        {"bits", format.bits},
        {"green", name_of(format.green, green_choices())},
        {"zero_code", name_of(format.flat, zero_code_choices())},
        {"dither", name_of(format.dither, dither_choices())},
        {"findings", conversion.findings.json()},
        {"milliseconds", durations_json(stages.finished())},
        {"megapixels_per_second", megapixels_per_second(conversion, stages)}};
    add_accuracy(conversion.accuracy, json);
    return json;
}

}  // namespace relief::tools
