// SPDX-License-Identifier: Apache-2.0
// Chooses from a map what the options leave open, and converts it.
#include "bump_conversion.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "relief/mesh/height_march.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/map_description.h"

namespace relief::tools {
using namespace relief::accuracy;

std::string kernel_name(const BumpMethod& method) {
    const std::string name = enum_name(method.kernel);
    return method.kernel == Kernel::gaussian ? fmt::format("{} {}", name, method.gaussian_radius)
                                             : name;
}

std::string method_text(const BumpMethod& method) {
    return fmt::format("{} in {}, {} bit{}", kernel_name(method), enum_name(method.arithmetic),
                       method.bits, method.destaircased ? ", steps smoothed" : "");
}

namespace {

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

/// The bit depths that --max-error can choose from.
std::vector<int> available_depths(const BumpRequest& request, const Job& job) {
    if (is_texture(job.output)) return {32};
    if (request.output.bits) return {*request.output.bits};
    std::vector<int> depths = depths_of(job.output);
    // Options for codes have no effect on floats.
    if (request.output.flat || request.output.dither) std::erase(depths, 32);
    return depths;
}

/// The share of texels above which colors or partial alpha are noticed.
constexpr double min_share = 0.01;

/// Checks that the file is a height map. A channel of alpha may be the heights of any map, and a
/// channel of colors or packed maps confirms that it is one. Textures of two channels without a
/// stated kind, as DDS files are, usually have x and y of normals.
/// \throws FileError
void check_height_map(const Job& job, const BumpRequest& request, const HeightMapFile& map) {
    if (request.channel == HeightChannel::alpha) return;
    MapInput input = {job.input, {MapKind::height}, map.info().metadata};
    if (request.channel)
        input.accepted.insert(input.accepted.end(), {MapKind::color, MapKind::packed});
    const int channels = map.info().channels;
    const bool is_gray =
        channels == 1 || (channels == 2 && !is_texture(job.input)) ||
        (channels > 2 && !map.is_streamed() && map.map().colored_fraction <= min_share);
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

/// Writes the relaxed cones of the heights. The conversion has reported the holes of the map.
void write_cone_map(const HeightMapFile& map, const std::filesystem::path& file, Stages& stages,
                    BumpConversion& conversion) {
    if (map.is_streamed())
        throw InvalidInput(
            "--cone-map: the map is too large to fit in memory (convert it without this option)");
    const Image cones = stages.run("cones", [&] {
        const HeightField heights(map.map().heights, *conversion.bump.wrap);
        return relaxed_cones(heights, depths_of(file).front());
    });
    MapDescription description{.kind = MapKind::height, .color_space = ColorSpace::data};
    description.detail = "relaxed cones";
    stages.run("write",
               [&] { write_image(file, cones, write_description(description, cones.bits())); });
}

}  // namespace

void check_cone_map(const BumpRequest& request, const Job& job) {
    if (!request.cone_map) return;
    const std::filesystem::path& file = *request.cone_map;
    const std::vector<int> depths = depths_of(file);
    if (is_texture(file) || depths.empty() || depths.front() < 16)
        throw UsageError(
            fmt::format("--cone-map {}: needs two channels of 16 bits or more", file.string()),
            "use .png, .tif or .exr");
    if (request.invert)
        throw UsageError("--invert, --cone-map: cones are those of the heights as they are read");
    if (request.accuracy.destaircase)
        throw UsageError(
            "--destaircase, --cone-map: cones are those of the heights as they are read");
    check_distinct("--cone-map", file, {job.input, job.output});
}

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

BumpFileFormat file_format_of(const BumpRequest& request, const std::filesystem::path& output) {
    BumpFileFormat format;
    format.write = write_options_of(request.output, output);
    format.xy_only = request.xy_only;
    format.alpha = request.alpha;
    if (is_texture(output) && (request.xy_only || request.alpha != MapAlpha::none)) {
        throw UsageError("--xy, --alpha: have no effect on textures",
                         "relief-bake convert --format chooses their channels");
    }
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
        if (request.cone_map) write_cone_map(map, *request.cone_map, stages, conversion);
    });
    return conversion;
}

}  // namespace relief::tools
