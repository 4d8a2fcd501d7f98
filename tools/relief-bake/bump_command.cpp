// SPDX-License-Identifier: Apache-2.0
// The command `relief-bake bump`: converts height map files. It chooses from a map what the options
// leave open. Contradictory and useless options are refused before any file is read.
// Tests: tests/tools/relief_bake_bump_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <string>

#include "commands.h"
#include "common/error_bound.h"
#include "common/map_kind.h"
#include "common/material_maps.h"
#include "common/options.h"
#include "common/summary.h"
#include "file_replacement.h"
#include "relief/accuracy/asset.h"
#include "relief/mesh/bump_file.h"
#include "relief/mesh/height_map.h"
#include "relief/mesh/report.h"

namespace relief::tools {
using namespace relief::accuracy;

namespace {

/// The options of accuracy. Absent: chosen from the map itself.
struct BumpAccuracyRequest {
    std::optional<Kernel> kernel;
    std::optional<Arithmetic> precision;
    bool destaircase = false;
    Grain grain = Grain::automatic;
    ErrorBound bound;                       ///< Of the map and the conversion together.
    std::optional<double> max_added_error;  ///< Of the conversion alone, in the same statistic.
    bool compare = false;

    [[nodiscard]] bool has_limit() const { return bound.degrees || max_added_error; }
    [[nodiscard]] bool needs_experiment() const { return compare || has_limit(); }
};

/// The options of a conversion, the same for every map of a call.
struct BumpRequest {
    std::optional<HeightChannel> channel;  ///< Absent: the mean, with a finding for color images.
    bool ignore_alpha = false;
    bool invert = false;
    BumpAccuracyRequest accuracy;
    std::optional<double> strength;
    std::optional<double> height;
    std::optional<glm::dvec2> texel;
    std::optional<int> gaussian_radius;
    WrapsOrAuto wrap;
    bool slope_moments = false;
    bool xy_only = false;
    MapAlpha alpha = MapAlpha::none;
    MapOutputOptions output;
    AssumedKinds assumed;
};

/// The choices that were made from the map, and the measured errors.
struct BumpAccuracy {
    std::optional<KernelChoice> choice;        ///< With --kernel auto.
    std::optional<BumpExperiment> experiment;  ///< With --compare and --max-error.
    std::optional<BumpMeasurement> selected;   ///< The method within --max-error.
    double step = 0.0;                         ///< Of the steps that were smoothed; 0: none.
};

/// The result of a conversion.
struct BumpConversion {
    ImageInfo input;
    bool is_streamed = false;     ///< A large map is read row by row.
    std::size_t transparent = 0;  ///< Texels that are not part of the surface.
    BumpOptions bump;             ///< With the choices that were made from the map.
    std::optional<Tiling> tiling;
    BumpAccuracy accuracy;
    BumpFileFormat format;
    Findings findings;
};

void check(const BumpAccuracyRequest& request, bool slope_moments, bool half) {
    check(request.bound, request.max_added_error.has_value());
    if (!request.needs_experiment()) return;
    const std::string option = request.bound.degrees     ? "--max-error"
                               : request.max_added_error ? "--max-added-error"
                                                         : "--compare";
    if (request.compare && request.has_limit())
        throw UsageError("--compare, " + option + ": contradict each other");
    if (slope_moments)
        throw UsageError(option + ", --slope-moments: errors are measured only for normals");
    if (half) throw UsageError(option + ", --half: errors of half floats are not measured");
}

/// Returns the library's options, except for those that are chosen from the map.
/// \throws UsageError if options contradict each other
BumpOptions bump_options_of(const BumpRequest& request) {
    if (request.strength && request.height)
        throw UsageError("--strength, --height: both set the depth of the map");
    if (request.height && !request.texel)
        throw UsageError("--height: needs the size of a texel in the same unit",
                         "give --texel-size, or --strength instead");
    if (request.texel && !request.height)
        throw UsageError("--texel-size: has no effect without --height", "give --height");
    if (request.gaussian_radius && request.accuracy.kernel != Kernel::gaussian)
        throw UsageError("--kernel-radius: has no effect without --kernel gaussian");
    check(request.accuracy, request.slope_moments, request.output.half);
    BumpOptions bump;
    bump.strength = request.height ? *request.height : request.strength.value_or(bump.strength);
    if (request.invert) bump.strength = -bump.strength;
    bump.texel = request.texel.value_or(bump.texel);
    bump.gaussian_radius = request.gaussian_radius.value_or(bump.gaussian_radius);
    return bump;
}

/// Returns the content and the format of the output file.
/// \throws UsageError if the file cannot store them, or options contradict each other
BumpFileFormat file_format_of(const BumpRequest& request, const std::filesystem::path& output) {
    BumpFileFormat format;
    format.write = write_options_of(request.output, output);
    format.xy_only = request.xy_only;
    format.alpha = request.alpha;
    if (!request.slope_moments) {
        format.normals = format_of(request.output, output);
        return format;
    }
    const auto refuse = [](bool is_given, const char* option) {
        if (is_given)
            throw UsageError(fmt::format("{}, --slope-moments: contradict each other", option));
    };
    refuse(request.xy_only, "--xy");
    refuse(request.alpha != MapAlpha::none, "--alpha");
    refuse(request.output.flat.has_value(), "--zero-code");
    refuse(request.output.dither.has_value(), "--dither");
    refuse(request.output.bits.value_or(32) != 32, "--bits");
    MapOutputOptions floats = request.output;
    floats.bits = 32;
    format.content = BumpContent::slope_moments;
    format.normals = format_of(floats, output);
    return format;
}

// The conversion.

/// "gaussian 4", or the plain name of the kernel.
std::string kernel_name(const BumpMethod& method) {
    const std::string name = enum_name(method.kernel);
    return method.kernel == Kernel::gaussian ? fmt::format("{} {}", name, method.gaussian_radius)
                                             : name;
}

/// "gaussian 4 in float32, 16 bit"
std::string method_text(const BumpMethod& method) {
    return fmt::format("{} in {}, {} bit{}", kernel_name(method), enum_name(method.arithmetic),
                       method.bits, method.destaircased ? ", steps smoothed" : "");
}

/// The bit depths that --max-error can choose from.
std::vector<int> available_depths(const BumpRequest& request, const Job& job) {
    if (request.output.bits) return {*request.output.bits};
    std::vector<int> depths = depths_of(job.output);
    // Options for codes have no effect on floats.
    if (request.output.flat || request.output.dither) std::erase(depths, 32);
    return depths;
}

/// The share of texels above which colors or partial alpha are noticed.
constexpr double min_share = 0.01;

/// Checks that the file is a height map. A channel of alpha may be the heights of any map, and a
/// channel of colors or packed maps confirms that it is one.
/// \throws FileError
void check_height_map(const Job& job, const BumpRequest& request, const HeightMapFile& map) {
    if (request.channel == HeightChannel::alpha) return;
    MapInput input = {job.input, {MapKind::height}, map.info().metadata};
    if (request.channel)
        input.accepted.insert(input.accepted.end(), {MapKind::color, MapKind::packed});
    const bool is_gray =
        map.info().channels < 3 || (!map.is_streamed() && map.map().colored_fraction <= min_share);
    if (!check_stated_kind(input, request.assumed) && !is_gray)
        check_judged_kind(input, read_sample(job.input));
}

/// Reports what the heights leave out: color differences and partial alpha.
void report_channels(const BumpRequest& request, const HeightMapFile& map,
                     const HeightMapFile::Survey& survey, Report& report) {
    if (request.channel) return;
    const bool is_streamed = map.is_streamed();
    const double colored = is_streamed ? survey.colored_fraction : map.map().colored_fraction;
    const double alpha =
        is_streamed ? survey.partial_alpha_fraction : map.map().partial_alpha_fraction;
    if (colored > min_share) {
        report.add("color image read as heights", "map", 0,
                   fmt::format("the height is the mean of red, green and blue, which differ in "
                               "{:.0f}% of the texels (a color picture is not a height map; select "
                               "a channel with --channel, or confirm with --channel mean)",
                               100.0 * colored));
    }
    if (alpha > min_share && request.alpha != MapAlpha::keep) {
        report.add("alpha with values between 0 and 1", "map", 0,
                   "is not read (--channel alpha reads it as the height)");
    }
}

/// The parts of the map that the choices and measurements need.
BumpSampleParts parts_to_read(const BumpAccuracyRequest& request, const ImageInfo& map) {
    BumpSampleParts parts;
    if (!request.kernel || request.needs_experiment())
        parts.analyzed = parts_to_analyze(map.width, map.height);
    if (request.needs_experiment()) parts.measured = parts_to_measure(map.width, map.height);
    return parts;
}

/// All methods that the options leave open.
std::vector<BumpMethod> methods_for(const BumpAccuracyRequest& request, int radius,
                                    const std::vector<int>& depths, bool compares_steps) {
    std::vector<Arithmetic> arithmetics = {Arithmetic::float32, Arithmetic::float64};
    if (request.precision) arithmetics = {*request.precision};
    const std::array destaircased = {false, true};
    const std::size_t first = request.destaircase && !compares_steps ? 1 : 0;
    const std::size_t last = request.destaircase || compares_steps ? 2 : 1;
    std::vector<BumpMethod> methods = bump_methods(
        radius, depths, arithmetics, std::span(destaircased).subspan(first, last - first));
    if (request.kernel && !request.compare)
        std::erase_if(methods, [&](const auto& m) { return m.kernel != *request.kernel; });
    return methods;
}

/// The message if no method is within the limits, with the smallest possible error and a remedy.
std::string limit_message(const BumpAccuracyRequest& request, const BumpExperiment& experiment) {
    const ErrorKind kind = request.bound.statistic();
    const BumpMeasurement* best = most_accurate(experiment, kind);
    const ExpectedError error = expected_error(experiment.reference, *best, kind);
    const std::string method = method_text(best->method);
    const char* const kind_name = statistic_name(kind);
    const bool steps_remain = !request.destaircase && experiment.reference.method->destaircased;
    const char* const hint = steps_remain ? " (--destaircase reduces it)" : "";
    if (request.max_added_error && error.added > *request.max_added_error) {
        return fmt::format(
            "no method adds at most {:g} degrees ({}): the minimum is {:.3g}, with "
            "{}{}",
            *request.max_added_error, kind_name, error.added, method, hint);
    }
    if (std::isnan(error.map)) {
        return fmt::format(
            "no method is known to be within {:g} degrees: the map has too few "
            "texels to estimate its own error (limit only the added error with "
            "--max-added-error)",
            *request.bound.degrees);
    }
    if (error.map > *request.bound.degrees) {
        return fmt::format(
            "no method is within {:g} degrees ({}): the map itself has an expected "
            "error of {:.3g} ({}), and {} adds {:.3g} (use a better map, or limit "
            "only the added error with --max-added-error){}",
            *request.bound.degrees, kind_name, error.map, experiment.choice.reason, method,
            error.added, hint);
    }
    return fmt::format("no method is within {:g} degrees ({}): the minimum is {:.3g}, with {}{}",
                       *request.bound.degrees, kind_name, error.total(), method, hint);
}

/// Reports that the choice of --kernel auto depends on the interpretation of fine grain.
void report_grain(const KernelChoice& choice, Report& report) {
    if (!choice.is_ambiguous()) return;
    const KernelPrediction& other = choice.otherwise->best;
    const bool is_noise = choice.noise > 0.0;
    const char* const assumed = is_noise ? "noise" : "detail";
    const char* const otherwise = is_noise ? "detail" : "noise";
    report.add({"fine grain that may be noise or detail",
                "map",
                fmt::format("is assumed to be {}, with an expected error of {:.2g} degrees RMS; if "
                            "it is {}, the error is {:.2g}, and {:.2g} with {} (--grain {})",
                            assumed, choice.rms_degrees, otherwise, choice.otherwise->rms_degrees,
                            other.rms_degrees, kernel_name({other.kernel, other.gaussian_radius}),
                            otherwise),
                1,
                {0}});
}

/// Reports that the limit is between the ends of the range of the expected error.
void report_range(const BumpAccuracyRequest& request, const BumpExperiment& experiment,
                  const BumpMeasurement& selected, Report& report) {
    if (!request.bound.degrees) return;
    const ErrorKind kind = request.bound.statistic();
    const double upper = expected_error_upper(experiment.reference, selected, kind).total();
    if (upper <= *request.bound.degrees) return;
    const char* const unknown = experiment.choice.noise > 0.0
                                    ? "how much detail the noise hides"
                                    : "whether its fine detail is real, and how fine it is";
    report.add({"error limit that may be exceeded",
                "map",
                fmt::format("the expected error is {:.2g} to {:.2g} degrees ({}), and --max-error "
                            "is {:g}: the map does not show {}",
                            expected_error(experiment.reference, selected, kind).total(), upper,
                            statistic_name(kind), *request.bound.degrees, unknown),
                1,
                {0}});
}

/// Selects the fastest method within the limits. \throws InvalidInput if there is none
void select_within_limit(const BumpAccuracyRequest& request, BumpConversion& conversion,
                         Report& report) {
    BumpAccuracy& accuracy = conversion.accuracy;
    const BumpMeasurement* selected = cheapest_within(
        *accuracy.experiment,
        {request.bound.degrees, request.max_added_error, request.bound.statistic()});
    if (selected == nullptr) throw InvalidInput(limit_message(request, *accuracy.experiment));
    report_range(request, *accuracy.experiment, *selected, report);
    accuracy.selected = *selected;
    conversion.bump.kernel = selected->method.kernel;
    conversion.bump.gaussian_radius = selected->method.gaussian_radius;
    conversion.bump.arithmetic = selected->method.arithmetic;
    conversion.format.normals.bits = selected->method.bits;
}

/// Chooses kernel, precision and bit depth from parts of the map.
void choose_method(const BumpAccuracyRequest& request, const std::vector<Image>& parts,
                   const std::vector<int>& depths, BumpConversion& conversion, Report& report) {
    BumpOptions& bump = conversion.bump;
    BumpAccuracy& accuracy = conversion.accuracy;
    if (request.precision) bump.arithmetic = request.precision;
    if (request.kernel) bump.kernel = *request.kernel;
    const BumpSampleParts read = parts_to_read(request, conversion.input);
    if (read.analyzed.empty()) return;
    const BumpSample sample = read.sample(parts);
    if (!request.kernel) {
        accuracy.choice = choose_kernel(sample.analyzed, bump, request.destaircase, request.grain);
        report_grain(*accuracy.choice, report);
        report_blurred_noise(*accuracy.choice, report);
        bump.kernel = accuracy.choice->kernel;
        bump.gaussian_radius = accuracy.choice->gaussian_radius;
    }
    if (!request.needs_experiment()) return;
    const int radius =
        accuracy.choice ? best_gaussian_radius(*accuracy.choice) : bump.gaussian_radius;
    BumpExperimentOptions options;
    options.bump = bump;
    options.format = conversion.format.normals;
    options.grain = request.grain;
    if (!request.compare) options.repeats = {1, 0};
    const std::vector<int> measured_depths =
        request.has_limit() ? depths : std::vector<int>{options.format.bits};
    const bool has_steps = accuracy.choice && accuracy.choice->depth.bits > 0 &&
                           accuracy.choice->depth.bits <= 12 && request.compare;
    accuracy.experiment =
        measure_bump(sample, methods_for(request, radius, measured_depths, has_steps), options);
    if (request.has_limit()) select_within_limit(request, conversion, report);
}

/// Smooths the quantization steps of the map. \throws InvalidInput if the map is not in memory
void destaircase_map(const Wraps& wrap, HeightMapFile& map, BumpAccuracy& accuracy) {
    if (map.is_streamed())
        throw InvalidInput(
            "--destaircase: the map is too large to fit in memory (convert it without this "
            "option)");
    Destaircased smooth = destaircase(map.map().heights, {.wrap = wrap});
    accuracy.step = smooth.step;
    if (smooth.step > 0.0) map.map().heights = std::move(smooth.heights);
}

/// Chooses what the options leave open: border mode, kernel, precision and bit depth.
void choose_from_map(HeightMapFile& map, const Job& job, const BumpRequest& request, Stages& stages,
                     BumpConversion& conversion) {
    const BumpAccuracyRequest& accuracy = request.accuracy;
    const std::vector<ImagePart> parts = parts_to_read(accuracy, map.info()).in_order();
    HeightMapFile::Survey survey;
    if (!request.wrap.is_settled() || !parts.empty()) {
        survey = stages.run("look", [&] { return map.survey(parts); });
        if (!request.wrap.is_settled()) conversion.tiling = survey.tiling;
    }
    Report report;
    report_channels(request, map, survey, report);
    conversion.findings.add("", report);
    conversion.bump.wrap = request.wrap.value_or(conversion.tiling.value_or(Tiling{}).wraps());
    if (parts.empty() && !accuracy.destaircase && !accuracy.kernel) return;
    const auto choose = [&] {
        Report choice_report;
        choose_method(accuracy, survey.parts, available_depths(request, job), conversion,
                      choice_report);
        conversion.findings.add("", choice_report);
        if (accuracy.destaircase) destaircase_map(*conversion.bump.wrap, map, conversion.accuracy);
    };
    // A given kernel needs no time, so it has no stage.
    if (!parts.empty() || accuracy.destaircase)
        stages.run("choose", choose);
    else
        choose();
}

void convert_and_write(const HeightMapFile& map, const Job& job, Stages& stages,
                       BumpConversion& conversion) {
    Report report;
    const BumpFileTimes times =
        write_bump_file(map, conversion.bump, job.output, conversion.format, report,
                        [&](double part) { stages.show_progress("convert", part); });
    stages.clear_progress();
    if (map.is_streamed()) stages.book("read", times.read);
    stages.book("convert", times.convert);
    stages.book("write", times.write);
    conversion.findings.add("", report, map.info().width);
}

/// Converts a file. The stages are "read", "look" and "choose" if something is chosen from the map,
/// "convert" and "write".
/// \throws FileError, UsageError
BumpConversion convert_bump(const Job& job, const BumpRequest& request, Stages& stages) {
    BumpConversion conversion;
    conversion.bump = bump_options_of(request);
    conversion.format = file_format_of(request, job.output);
    about(job.input, [&] {
        HeightMapFile map = stages.run("read", [&] {
            return HeightMapFile(
                job.input, {request.channel.value_or(HeightChannel::mean), request.ignore_alpha});
        });
        conversion.input = map.info();
        check_height_map(job, request, map);
        conversion.is_streamed = map.is_streamed();
        conversion.transparent = map.map().transparent_count();
        choose_from_map(map, job, request, stages, conversion);
        convert_and_write(map, job, stages, conversion);
    });
    return conversion;
}

// The summary.

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
           {"own_degrees", reference.reference_degrees},
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
    summary.add("format", format_text(conversion.format),
                {{"content", has_moments ? "slope moments" : "normals"},
                 {"xy_only", conversion.format.xy_only},
                 {"alpha", enum_name(conversion.format.alpha)},
                 {"bits", format.bits},
                 {"green", enum_name(format.green)},
                 {"zero_code", enum_name(format.flat)},
                 {"dither", enum_name(format.dither)}});
    summary.add_findings(conversion.findings);
    const double rate = megapixels_per_second(conversion, stages);
    summary.add_times(stages, fmt::format(" ({:.0f} MPixel/s without file access)", rate));
    summary.add("wrote", file_and_size(job.output), {{"megapixels_per_second", rate}});
    return summary;
}

/// The summary in one line, for a conversion of several files.
std::string line_of(const Job& job, const BumpConversion& conversion, const Stages& stages) {
    return fmt::format("{}: {} x {}, {}, {}, {}", job.output.string(), conversion.input.width,
                       conversion.input.height, kernel_text(conversion.bump),
                       conversion.findings.count_text(), duration(stages.milliseconds()));
}

// The options.

/// Parses "W" or "WxH".
glm::dvec2 parse_texel(const std::string& subject, const std::string& text) {
    const Range sizes{1e-30, 1e30, ""};
    const std::size_t cross = text.find('x');
    const double width = parse_number(subject, text.substr(0, cross), sizes);
    if (cross == std::string::npos) return {width, width};
    return {width, parse_number(subject, text.substr(cross + 1), sizes)};
}

void add_height_options(CLI::App& app, BumpRequest& request) {
    const std::string group = "Heights";
    add_choice(app, "--channel", request.channel, enum_choices<HeightChannel>(),
               "The height of a color texel; luminance is computed from decoded sRGB. Grayscale "
               "images accept mean, luminance and red, which are the same. Default: mean.")
        .group(group);
    add_assume_option(app, request.assumed, {MapKind::height}).group(group);
    add_switch(app, "--ignore-alpha", request.ignore_alpha,
               "Use the heights of transparent texels. Default: texels with alpha 0 become flat, "
               "and their colors do not affect the texels around them.")
        .group(group);
    add_switch(app, "--invert", request.invert,
               "Black is high and white is low; the same as the negative --strength.")
        .group(group);
}

void add_depth_options(CLI::App& app, BumpRequest& request) {
    const std::string group = "Slopes";
    const Range depths{-1e30, 1e30, ""};  // The range of normals_from_height().
    add_number(app, "--strength", "S", request.strength, depths,
               "Height of the value 1.0 (white), in texels; a negative value turns bumps into "
               "dents. Default: 16.")
        .group(group);
    add_number(app, "--height", "H", request.height, depths,
               "Height of the value 1.0 (white), in a unit of length. It replaces --strength and "
               "needs --texel-size.")
        .group(group);
    add_value(app, "--texel-size", "W[xH]",
              "Width of a texel in the unit of --height, and its height if texels are not square.",
              [&](const std::string& subject, const std::string& text) {
                  request.texel = parse_texel(subject, text);
              })
        .group(group);
}

void add_accuracy_options(CLI::App& app, BumpAccuracyRequest& request) {
    const std::string group = "Accuracy";
    add_choice(app, "--kernel", request.kernel, kernel_or_auto_choices(),
               "Derivative kernel; all kernels have the same gain. auto estimates bit depth, noise "
               "and detail of the map and chooses the most accurate kernel. central5 and central7 "
               "suit smooth maps of 16 bits or float; sobel5, scharr5 and gaussian also smooth "
               "quantization steps and noise; forward is shifted by half a texel. Default: auto.")
        .group(group);
    const Choices<Grain> grains = {
        {"auto", Grain::automatic}, {"noise", Grain::noise}, {"detail", Grain::detail}};
    add_choice(app, "--grain", request.grain, grains,
               "How --kernel auto interprets fine, uniform grain: as noise, which it smooths, or "
               "as detail, which it keeps. auto assumes noise, unless the map contains nothing "
               "else. Default: auto.")
        .group(group);
    add_switch(app, "--destaircase", request.destaircase,
               "First smooth the quantization steps of maps with few bits; no height "
               "changes by more than half a step.")
        .group(group);
    const Choices<std::optional<Arithmetic>> precisions = {
        {"float32", Arithmetic::float32}, {"float64", Arithmetic::float64}, {"auto", std::nullopt}};
    add_choice(app, "--precision", request.precision, precisions,
               "Floating-point type of slopes and normals. Default: auto, which is float64 for "
               "32-bit output and float32 otherwise.")
        .group(group);
    add_error_bound(
        app, request.bound, group,
        "Choose the fastest kernel, precision and bit depth whose expected error is at most DEG "
        "degrees; fail if there is none. The expected error is the root sum of squares of the "
        "error of the map (noise, rounding) and the error that the conversion adds. If it is a "
        "range, the lower end counts, and an upper end above DEG is a finding.");
    add_number(app, "--max-added-error", "DEG", request.max_added_error, {0.0, 180.0, "degrees"},
               "The same limit for only the error that the conversion adds: its distance from the "
               "most accurate known result. --max-error-kind applies to it, too.")
        .group(group);
    add_switch(app, "--compare", request.compare,
               "Also measure all methods, and print their errors and times.")
        .group(group);
}

void add_slope_options(CLI::App& app, BumpRequest& request) {
    add_value(app, "--kernel-radius", "R",
              "Radius of --kernel gaussian in texels, 1 to 64. Default: 2.",
              [&](const std::string& subject, const std::string& text) {
                  request.gaussian_radius = parse_integer(subject, text, 1, max_kernel_radius);
              })
        .group("Accuracy");
    add_wrap(app, request.wrap,
             "Border mode: repeat uses the opposite edge, for maps that tile; clamp uses one-sided "
             "differences; mirror uses the mirrored map; auto chooses repeat if the map continues "
             "smoothly across the seam, else clamp. Two words set left and right, then top and "
             "bottom. Default: auto.")
        .group("Slopes");
}

void add_content_options(CLI::App& app, BumpRequest& request) {
    const std::string group = "Output";
    add_switch(app, "--xy", request.xy_only,
               "Store 0 in blue, for shaders that compute z from x and y.")
        .group(group);
    add_choice(app, "--alpha", request.alpha, enum_choices<MapAlpha>(),
               "Content of the alpha channel: none, the height (for parallax mapping), or the "
               "alpha of the height map (keep). Default: none.")
        .group(group);
    add_switch(app, "--slope-moments", request.slope_moments,
               "Instead of normals, write six float channels (.exr or .tif) that can be filtered "
               "(LEAN mapping): height, dh/dx, dh/dy, their squares and their product, with the "
               "channel names of maketx --bumpslopes.")
        .group(group);
}

/// The map of --write-into must be what glTF prescribes.
void check_write_into(const BumpRequest& request, const WriteIntoOptions& write_into,
                      const Job& job) {
    const auto refuse = [](const char* option, const char* problem, const char* remedy) {
        throw UsageError(fmt::format("{}, --write-into: {}", option, problem), remedy);
    };
    if (request.output.green == Green::down)
        refuse("--green", "glTF has green up", "use --green up");
    if (request.output.flat == FlatCode::middle)
        refuse("--zero-code", "glTF decodes zero at 127.5", "use --zero-code 127.5");
    if (request.xy_only) refuse("--xy", "glTF needs z in blue", "leave it out");
    check_image("--write-into", job.output);
    if (!std::filesystem::exists(*write_into.model))
        throw failure(*write_into.model, "does not exist", "name a model that has the surface");
    check_distinct("--write-into", *write_into.model, {job.input, job.output});
}

/// Stores the finished map in the model of --write-into.
MaterialResult write_into_model(const WriteIntoOptions& write_into, const Job& job,
                                Stages& stages) {
    MaterialRequest request;
    request.input = request.output = *write_into.model;
    request.materials.push_back({write_into.material, {{TextureSlot::normal, job.output}}});
    request.embeds = write_into.embed;
    request.normal_scale = write_into.scale;
    request.assumed = {MapKind::normal};  // The options were checked before the conversion.
    return store_maps(request, stages);
}

ExitCode run(const CLI::App& app, const MapFiles& files, const BumpRequest& given,
             const WriteIntoOptions& write_into) {
    BumpRequest request = given;
    apply_engine(request.output);
    check(app, write_into);
    if (!write_into.model) refuse_given(app, {"--scale"}, "--write-into");
    MapWork work;
    std::size_t jobs = 0;
    work.head = {{"tool", "relief-bake bump"}, {"version", version()}};
    work.check = [&](const Job& job) {
        bump_options_of(request);
        file_format_of(request, job.output);
        refuse_to_replace(job.input, "height map", job);
        if (!write_into.model) return;
        if (++jobs > 1) throw UsageError("--write-into: needs a single map");
        check_write_into(request, write_into, job);
    };
    work.work = [&](const Job& job, Stages& stages) -> FileOutcome {
        relief::detail::FileSet outputs;
        BumpConversion conversion = convert_bump(job, request, stages);
        std::optional<MaterialResult> stored;
        if (write_into.model) {
            stored = write_into_model(write_into, job, stages);
            for (const PlacedFinding& placed : stored->findings.all()) {
                Report report;
                report.add(placed.finding);
                conversion.findings.add(placed.where, report, placed.map_width);
            }
        }
        outputs.commit();
        Summary summary = summary_of(job, request, conversion, stages);
        if (stored) {
            summary.add_part("stored", summary_of(*stored));
            summary.add("", file_and_size(*write_into.model));
        }
        return {line_of(job, conversion, stages), conversion.findings, std::move(summary)};
    };
    return run_map_jobs(app, files, work);
}

}  // namespace

Command add_bump_command(CLI::App& tool) {
    struct Options {
        MapFiles files;
        BumpRequest request;
        WriteIntoOptions write_into;
    };
    CLI::App& app =
        add_subcommand(tool, "bump", "Converts height maps to tangent-space normal maps.");
    const auto options = std::make_shared<Options>();
    add_map_files(app, options->files, "height map",
                  "Height maps are grayscale or color images (PNG, TIFF, EXR, HDR, JPEG, ...).");
    add_height_options(app, options->request);
    add_depth_options(app, options->request);
    add_accuracy_options(app, options->request.accuracy);
    add_slope_options(app, options->request);
    add_map_folder(app, options->files);
    add_content_options(app, options->request);
    add_map_output_options(app, options->request.output);
    add_write_into_options(app, options->write_into,
                           "Store the finished map as the normal map of a material of this model "
                           "(.glb .gltf), which is replaced.");
    add_number(app, "--scale", "S", options->write_into.scale, {-100.0, 100.0, ""},
               "Factor of the x and y of the normal map in the material. Default: that of the "
               "material, or 1.")
        .group("glTF");
    add_report_options(app, options->files.report);
    add_general_options(app, options->files.general);
    set_common_options(app, {"--channel", "--strength", "--height", "--texel-size", "--wrap",
                             "--kernel", "--max-error", "--compare", "--output", "--green",
                             "--bits", "--dither", "--write-into", "--report", "--strict"});
    set_examples(
        app,
        {"relief-bake bump data/bricks-height.png out/bricks-normal.png --strength 12",
         "relief-bake bump data/bricks-height.png out/bricks-dx.png --green down --bits 8",
         "relief-bake bump data/bricks-height.png out/bricks.exr --kernel central5 --wrap clamp",
         "relief-bake bump data/bricks-height.png out/bricks.png --compare",
         "relief-bake bump data/bricks-height.png out/bricks.tif --max-error 5",
         "relief-bake bump data/bricks-height.png out/wall.png --height 0.02 --texel-size "
         "0.001",
         "relief-bake bump data/bricks-height.png out/bricks-parallax.png --alpha height",
         "relief-bake bump data/*-height.png -o out/maps/ --strength 8"});
    return {&app, [&app, options] {
                return run(app, options->files, options->request, options->write_into);
            }};
}

}  // namespace relief::tools
