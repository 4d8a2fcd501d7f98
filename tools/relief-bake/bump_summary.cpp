// SPDX-License-Identifier: Apache-2.0
// Describes a conversion of heights to normals as text and JSON.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bump_conversion.h"

namespace relief::tools {
using namespace relief::accuracy;

namespace {

/// "gaussian of radius 2", or the plain name.
std::string kernel_text(const BumpOptions& bump) {
    const std::string name = enum_name(*bump.kernel);
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
    const std::string text = name_of(*conversion.bump.wrap) + " at the border";
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
                           enum_name(format.normals.green),
                           format.write.half ? ", half floats" : "");
    }
    std::string text = to_string(format.normals);
    if (format.xy_only) text += ", without z";
    if (format.alpha == MapAlpha::height) text += ", height in alpha";
    if (format.alpha == MapAlpha::keep) text += ", alpha kept";
    if (format.write.half) text += ", half floats";
    return text;
}

/// The table of --compare, sorted by error.
std::vector<std::string> comparison_table(const BumpExperiment& experiment) {
    std::vector<const BumpMeasurement*> rows;
    for (const BumpMeasurement& measurement : experiment.measurements)
        rows.push_back(&measurement);
    std::stable_sort(rows.begin(), rows.end(),
                     [](const auto* a, const auto* b) { return a->error.rms < b->error.rms; });
    std::vector<std::string> lines = {fmt::format(
        "{:<12} {:<9} {:<4} {:<6} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9}", "kernel", "precision",
        "bits", "steps", "RMS deg", "99% deg", "max deg", "with map", "time", "MPixel/s")};
    for (const BumpMeasurement* row : rows) {
        lines.push_back(fmt::format(
            "{:<12} {:<9} {:<4} {:<6} {:>9.3g} {:>9.3g} {:>9.3g} {:>9.3g} {:>9} {:>9.0f} {}",
            kernel_name(row->method), enum_name(row->method.arithmetic), row->method.bits,
            row->method.destaircased ? "smooth" : "as is", row->error.rms, row->error.p99,
            row->error.max, expected_error(experiment.reference, *row, default_error_kind).total(),
            duration(1000.0 * row->seconds.median), row->megapixels_per_second,
            row->is_pareto_optimal ? "*" : ""));
    }
    lines.emplace_back("RMS, 99% and max: added by the conversion; with map: the total that");
    lines.emplace_back("--max-error limits, the expected error of 99% of the texels");
    lines.emplace_back("* no other method is both faster and more accurate");
    for (std::string& line : lines)
        line.erase(line.find_last_not_of(' ') + 1);
    return lines;
}

/// The expected error of the map and the kernel, in float64 and without rounding.
std::string expectation_text(const KernelChoice& choice) {
    if (std::isnan(choice.rms_degrees)) return "unknown";
    const char* const range_reason =
        choice.blurred_noise ? "; the range depends on whether fine detail is blurred noise"
        : choice.noise > 0.0 ? "; the range depends on how much detail the noise hides"
                             : "; the range depends on whether fine detail is real, and how fine";
    const std::string p99 = choice.is_range() ? fmt::format("{:.2g} to {:.2g}", choice.p99_degrees,
                                                            choice.upper_p99_degrees)
                                              : fmt::format("{:.2g}", choice.p99_degrees);
    return fmt::format(
        "{} degrees RMS, 99 % within {}, {:.2g} at most, from the map and this "
        "kernel{}",
        expected_error_text(choice), p99, choice.upper_max_degrees,
        choice.is_range() ? range_reason : "");
}

/// \param kind  the statistic of the expected error
Json measurement_json(const BumpMeasurement& measurement, const BumpReference& reference,
                      ErrorKind kind) {
    const BumpMethod& method = measurement.method;
    const ExpectedError expected = expected_error(reference, measurement, kind);
    return {{"kernel", enum_name(method.kernel)},
            {"kernel_radius",
             method.kernel == Kernel::gaussian ? Json(method.gaussian_radius) : Json()},
            {"precision", enum_name(method.arithmetic)},
            {"bits", method.bits},
            {"destaircased", method.destaircased},
            {"degrees",
             {{"rms", measurement.error.rms},
              {"mean", measurement.error.mean},
              {"p99", measurement.error.p99},
              {"max", measurement.error.max}}},
            {"expected_degrees",
             {{"statistic", enum_name(kind)},
              {"map", expected.map},
              {"added", expected.added},
              {"total", expected.total()},
              {"total_upper", expected_error_upper(reference, measurement, kind).total()}}},
            {"milliseconds",
             {{"median", 1000.0 * measurement.seconds.median},
              {"p10", 1000.0 * measurement.seconds.p10},
              {"p90", 1000.0 * measurement.seconds.p90}}},
            {"megapixels_per_second", measurement.megapixels_per_second},
            {"efficient", measurement.is_pareto_optimal}};
}

Json blurred_noise_json(const KernelChoice& choice) {
    if (!choice.blurred_noise) return nullptr;
    const BlurredNoiseReading& reading = *choice.blurred_noise;
    return {{"deviation", reading.deviation},
            {"if_detail",
             {{"expected_degrees", choice.rms_degrees},
              {"expected_degrees_upper", reading.detail_upper_rms_degrees}}},
            {"if_noise",
             {{"expected_degrees", reading.rms_degrees},
              {"expected_degrees_upper", reading.upper_rms_degrees}}}};
}

Json grain_json(const KernelChoice& choice) {
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

void add_kernel_choice(Summary& summary, const KernelChoice& choice) {
    summary.add("because", choice.reason, {{"kernel_reason", choice.reason}});
    summary.add("expected", expectation_text(choice),
                {{"expected_degrees", choice.rms_degrees},
                 {"expected_degrees_upper", choice.upper_rms_degrees},
                 {"expected_p99_degrees", choice.p99_degrees},
                 {"expected_p99_degrees_upper", choice.upper_p99_degrees},
                 {"grain", grain_json(choice)},
                 {"blurred_noise", blurred_noise_json(choice)}});
}

/// "1.23", or "1.23 to 4.5" if it is a range.
std::string range_text(double lower, double upper) {
    return upper > 1.005 * lower ? fmt::format("{:.3g} to {:.3g}", lower, upper)
                                 : fmt::format("{:.3g}", lower);
}

void add_selected(Summary& summary, const BumpMeasurement& selected, const BumpReference& reference,
                  ErrorKind kind) {
    const ExpectedError error = expected_error(reference, selected, kind);
    const ExpectedError upper = expected_error_upper(reference, selected, kind);
    summary.add("selected",
                {fmt::format("{}: {} degrees ({}) expected", method_text(selected.method),
                             range_text(error.total(), upper.total()), statistic_name(kind)),
                 fmt::format("{} from the map itself, {:.3g} added by this conversion "
                             "({:.3g} at most), {:.0f} MPixel/s",
                             range_text(error.map, upper.map), error.added, selected.error.max,
                             selected.megapixels_per_second)},
                {{"selected", measurement_json(selected, reference, kind)}});
}

void add_experiment(Summary& summary, const BumpExperiment& experiment, ErrorKind kind,
                    bool has_table) {
    const BumpReference& reference = experiment.reference;
    summary.add(
        "errors",
        fmt::format("measured on {} of the map, against {}",
                    experiment.is_whole ? "all" : fmt::format("{} texels", experiment.texels),
                    reference.description),
        {{"reference",
          {{"what", reference.description},
           {"own_degrees", reference.error.rms},
           {"texels", experiment.texels},
           {"whole", experiment.is_whole}}}});
    summary.add("", has_table ? comparison_table(experiment) : Summary::Lines{},
                {{"comparison", json_list(experiment.measurements, [&](const auto& measurement) {
                      return measurement_json(measurement, reference, kind);
                  })}});
}

void add_accuracy(Summary& summary, const BumpAccuracy& accuracy, ErrorKind kind) {
    // With a limit, the kernel is not chosen for its accuracy alone.
    if (accuracy.choice && !accuracy.selected) add_kernel_choice(summary, *accuracy.choice);
    const bool has_steps = accuracy.step > 0.0;
    summary.add("steps",
                has_steps ? fmt::format("smoothed: steps of 1/{:.0f}; heights moved by at most "
                                        "half a step",
                                        1.0 / accuracy.step)
                          : "",
                {{"destaircased_step", has_steps ? Json(accuracy.step) : Json()}});
    if (!accuracy.experiment) return;
    const BumpExperiment& experiment = *accuracy.experiment;
    if (accuracy.selected) add_selected(summary, *accuracy.selected, experiment.reference, kind);
    add_experiment(summary, experiment, kind, !accuracy.selected);
}

}  // namespace

Summary summary_of(const Job& job, const BumpRequest& request, const BumpConversion& conversion,
                   const Stages& stages) {
    const BumpOptions& bump = conversion.bump;
    const NormalMapFormat& format = conversion.format.normals;
    const bool has_radius = bump.kernel == Kernel::gaussian;
    const bool has_moments = conversion.format.content == BumpContent::slope_moments;
    Json seams;
    if (conversion.tiling) seams = {conversion.tiling->seam_x, conversion.tiling->seam_y};
    Summary summary;
    summary.add("read", input_text(job, conversion),
                {{"width", conversion.input.width},
                 {"height", conversion.input.height},
                 {"by_rows", conversion.is_streamed},
                 {"transparent", conversion.transparent}});
    summary.add("slopes",
                fmt::format("{}, {}, {}", kernel_text(bump), depth_text(request, bump),
                            border_text(conversion)),
                {{"kernel", enum_name(*bump.kernel)},
                 {"kernel_radius", has_radius ? Json(bump.gaussian_radius) : Json()},
                 {"strength", bump.strength},
                 {"texel_size", {bump.texel.x, bump.texel.y}},
                 {"wrap", name_of(*bump.wrap)},
                 {"seams", std::move(seams)}});
    add_accuracy(summary, conversion.accuracy, request.accuracy.bound.statistic());
    const char* const stored =
        is_texture(job.output) ? ", stored as a texture with all mip levels" : "";
    summary.add("format", format_text(conversion.format) + stored,
                {{"content", has_moments ? "slope moments" : "normals"},
                 {"xy_only", conversion.format.xy_only},
                 {"alpha", enum_name(conversion.format.alpha)},
                 {"bits", format.bits},
                 {"green", enum_name(format.green)},
                 {"zero_code", enum_name(format.flat)},
                 {"dither", enum_name(format.dither)}});
    summary.add("cones", request.cone_map ? file_and_size(*request.cone_map) : "",
                {{"cone_map", request.cone_map ? Json(request.cone_map->string()) : Json()}});
    summary.add_findings(conversion.findings);
    const double rate = megapixels_per_second(conversion, stages);
    summary.add_times(stages, fmt::format(" ({:.0f} MPixel/s without file access)", rate));
    summary.add("wrote", file_and_size(job.output), {{"megapixels_per_second", rate}});
    return summary;
}

std::string line_of(const Job& job, const BumpConversion& conversion, const Stages& stages) {
    return fmt::format("{}: {} x {}, {}, {}, {}", job.output.string(), conversion.input.width,
                       conversion.input.height, kernel_text(conversion.bump),
                       conversion.findings.count_text(), duration(stages.milliseconds()));
}

}  // namespace relief::tools
