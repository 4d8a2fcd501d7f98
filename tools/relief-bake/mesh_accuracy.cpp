// SPDX-License-Identifier: Apache-2.0
// Binds --compare and --max-error to the measurement of bakes; and compares a finished map with the
// models that it was baked from: errors by cause, an error map, and the convention that explains
// the map if it is not the assumed one.
// Tests: tests/tools/relief_bake_accuracy_test.cpp, relief_bake_check_test.cpp.

#include "mesh_accuracy.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "common/summary.h"
#include "mesh_maps.h"
#include "relief/mesh/bake_check.h"
#include "relief/mesh/image.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/map_description.h"
#include "relief/mesh/report.h"
#include "relief/mesh/statistics.h"

namespace relief::tools {
using namespace relief::accuracy;

// Samples and bits.

namespace {

/// The bit depths that the file can store and the options leave open, in ascending order.
std::vector<int> available_depths(const MeshBakeRequest& request) {
    if (is_texture(request.output)) return {32};
    if (request.map.bits) return {*request.map.bits};
    std::vector<int> depths = depths_of(request.output);
    // Options for codes have no effect on floats.
    if (request.map.flat || request.map.dither) std::erase(depths, 32);
    std::ranges::sort(depths);
    return depths;
}

/// Explains that no samples and bits are within the limit, and what to change.
std::string message_of(const NoBakeWithinLimit& none, const MeshBakeRequest& request) {
    const ErrorBound& bound = request.bound;
    const MeasuredBake& best = none.smallest;
    const double rounding = bound.error(best.quantization);
    const double sampling = bound.error(best.sampling_error);
    std::string parts =
        rounding >= sampling
            ? fmt::format("rounding to {} bits alone causes {:.3g}, sampling {:.3g}",
                          best.format.bits, rounding, sampling)
            : fmt::format("sampling alone causes {:.3g}, rounding to {} bits {:.3g}", sampling,
                          best.format.bits, rounding);
    if (!none.has_all_samples) parts += "; 256 samples cannot be measured on a map of this size";
    std::string remedy = "allow a larger error";
    if (none.other_bits) {
        const int bits = none.other_bits->format.bits;
        const std::vector<int> depths = depths_of(request.output);
        const bool is_supported = std::ranges::find(depths, bits) != depths.end();
        remedy = fmt::format("{} bits are within the limit, with {:.3g}: {}", bits,
                             bound.error(none.other_bits->error),
                             is_supported ? fmt::format("give --bits {}", bits)
                             : bits == 32 ? "write .exr or .tif"
                                          : "write .png or .tif");
    }
    return fmt::format(
        "no choice of samples and bits is within {}: the minimum is {:.3g}, with {}; {} ({})",
        to_string(bound), bound.error(best.error), to_string(best), parts, remedy);
}

}  // namespace

std::string to_string(const MeasuredBake& bake) {
    const std::string samples =
        bake.sampling.sample_degrees
            ? fmt::format("auto samples at {:g} degrees", *bake.sampling.sample_degrees)
            : counted(static_cast<std::size_t>(bake.sampling.samples), "sample");
    return fmt::format("{}, {} bit{}", samples, bake.format.bits,
                       bake.format.dither == Dither::none ? "" : ", dithered");
}

void check_accuracy(const MeshBakeRequest& request) {
    check(request.bound);
    if (!request.measures_errors()) return;
    if (request.compare && request.bound.degrees)
        throw UsageError("--compare, --max-error: contradict each other");
    const std::string option = request.compare ? "--compare" : "--max-error";
    if (request.map.half)
        throw UsageError(option + ", --half: errors of half floats are not measured");
    if (names_word(request.output, material_word) || names_word(request.output, tile_word))
        throw UsageError(option + ": needs a single map, not <material> or <UDIM>");
}

BakeComparison measure_errors(const Baker& baker, const BakeMapOptions& map,
                              MeshBakeRequest& request, NormalMapFormat& format) {
    if (request.compare) return compare_bakes(baker, map, format);
    BakeSearch search;
    search.max_degrees = request.bound.degrees.value_or(0.0);
    search.kind = request.bound.statistic();
    search.format = format;
    search.bits = available_depths(request);
    if (request.samples.is_given)
        search.sampling = {request.samples.count, angle_of(request, request.samples)};
    try {
        BakeComparison result = select_bake(baker, map, search);
        if (!request.samples.is_given) request.samples.count = result.selected->sampling.samples;
        format = result.selected->format;
        return result;
    } catch (const NoBakeWithinLimit& none) {
        throw InvalidInput(message_of(none, request));
    }
}

// Finished maps, for `relief-bake mesh --verify` and `relief-bake check --high`.

namespace {

// The error map.

/// The smallest 1, 2 or 5 times a power of ten that is not below the value.
double rounded_up(double value) {
    if (!(value > 0.0)) return 1.0;
    const double power = std::pow(10.0, std::floor(std::log10(value)));
    for (const double step : {1.0, 2.0, 5.0}) {
        if (value <= step * power) return step * power;
    }
    return 10.0 * power;
}

/// Colors rows of errors; texels without an error are transparent.
Image heat_rows(std::span<const float> degrees, int width, double brightest) {
    const int height = static_cast<int>(degrees.size() / static_cast<std::size_t>(width));
    Image values = make_image(width, height, 1, 32, ColorSpace::data);
    std::copy(degrees.begin(), degrees.end(), values.as<float>().begin());
    const Image heat = false_color_image(values, brightest);
    Image result = make_image(width, height, 4, 8, ColorSpace::srgb);
    const auto from = heat.as<std::uint8_t>();
    const auto to = result.as<std::uint8_t>();
    for (std::size_t i = 0; i < degrees.size(); ++i) {
        if (std::isnan(degrees[i])) continue;
        std::copy_n(&from[3 * i], 3, &to[4 * i]);
        to[4 * i + 3] = 255;
    }
    return result;
}

/// Writes the errors of all texels, in degrees, NaN if there is none. PNG: colors from black (no
/// error) to pale yellow; EXR, TIFF: degrees in one channel. The metadata "relief:brightest" is the
/// error of pale yellow in degrees.
/// \return that error: the 99th percentile, rounded up to 1, 2 or 5 times a power of ten
double write_error_map(const std::filesystem::path& file, const std::vector<float>& degrees,
                       const BakeMapOptions& map, double p99) {
    constexpr std::size_t rows_at_once = 256;
    const double brightest = rounded_up(p99);
    const bool is_picture = extension_of(file) == ".png";
    const ImageShape shape = {map.width, map.height, is_picture ? 4 : 1, is_picture ? 8 : 32,
                              is_picture ? ColorSpace::srgb : ColorSpace::data};
    MapDescription description = {.kind = MapKind::error,
                                  .detail = is_picture ? "as heat" : "degrees",
                                  .color_space = shape.color_space};
    if (is_picture) description.alpha = AlphaContent::coverage;
    std::map<std::string, std::string> metadata = write_description(description, shape.bits);
    metadata["relief:brightest"] = fmt::format("{:g}", brightest);
    ImageRowWriter writer(file, shape, metadata);
    const std::size_t texels_at_once = rows_at_once * static_cast<std::size_t>(map.width);
    for (std::size_t first = 0; first < degrees.size(); first += texels_at_once) {
        const std::span<const float> part = std::span<const float>(degrees).subspan(
            first, std::min(texels_at_once, degrees.size() - first));
        if (is_picture) {
            const Image picture = heat_rows(part, map.width, brightest);
            writer.write(std::as_bytes(picture.as<std::uint8_t>()));
        } else {
            writer.write(std::as_bytes(part));
        }
    }
    writer.finish();
    return brightest;
}

// The convention that explains a map.

/// As --axes of `relief-bake convert` accepts it.
std::string axes_option(const AxisMapping& axes) {
    std::string text;
    for (const SignedAxis& axis : axes) {
        text += text.empty() ? "" : ",";
        text += axis.is_negative ? "-" : "";
        text += "xyz"[axis.axis];
    }
    return text;
}

std::string describe(const AxisMapping& axes) {
    const SignedAxis x{0, false}, y{1, false}, z{2, false};
    const SignedAxis minus_x{0, true}, minus_y{1, true};
    if (axes == AxisMapping{x, minus_y, z})
        return "green is inverted (down instead of up, or up "
               "instead of down)";
    if (axes == AxisMapping{minus_x, y, z}) return "red is inverted";
    if (axes == AxisMapping{minus_x, minus_y, z}) return "red and green are inverted";
    if (axes == AxisMapping{y, x, z}) return "red and green are swapped";
    return fmt::format("the axes differ: x, y, z are {}", axes_option(axes));
}

/// Names a part of a convention for JSON, and describes its value in the map.
struct PartText {
    const char* name;
    std::string description;
};

PartText describe(const MapConvention& found, ConventionPart part) {
    switch (part) {
        case ConventionPart::curve:
            return {"curve", found.curve == StoredCurve::srgb_encoded
                                 ? "the values are sRGB-encoded"
                                 : "the values were decoded as if they were sRGB"};
        case ConventionPart::flat:
            return {"flat", found.flat == FlatCode::half
                                ? "zero is between two codes (127.5 of 255)"
                                : "zero is a code (128 of 255)"};
        case ConventionPart::turn:
            return {"turn", found.turn == ImageOrientation::upside_down ? "the image is upside down"
                            : found.turn == ImageOrientation::mirrored
                                ? "the image is mirrored, left to "
                                  "right"
                                : "the image is rotated by 180 "
                                  "degrees"};
        case ConventionPart::axes:
            return {"axes", describe(found.axes)};
        case ConventionPart::space:
            return {"space", found.space == VectorSpace::tangent  ? "it is in tangent space"
                             : found.space == VectorSpace::object ? "it is in object space"
                                                                  : "it is in world space"};
        case ConventionPart::basis:
            return {"basis", found.basis == TangentMethod::mikktspace
                                 ? "it was baked with MikkTSpace tangents"
                             : found.basis == TangentMethod::area_weighted
                                 ? "it was baked with area-weighted tangents"
                             : found.basis == TangentMethod::lengyel
                                 ? "it was baked with Lengyel's tangents"
                                 : "it was baked with the model's tangents"};
        case ConventionPart::frame:
            return {"frame", found.frame == FrameInterpolation::unit
                                 ? "it was baked with normal and tangent normalized per pixel"
                             : found.frame == FrameInterpolation::orthonormal
                                 ? "it was baked with normal and tangent orthonormalized per pixel"
                             : found.frame == FrameInterpolation::vertex_bitangent
                                 ? "it was baked with bitangents interpolated from the vertices"
                                 : "it was baked with the interpolated normal and tangent"};
        case ConventionPart::mirroring:
            return {"mirroring",
                    "mirrored parts of the texture were baked as if they were not (w is +1)"};
    }
    return {"", ""};
}

/// "green is inverted (...): with this convention, the error is 0.12 degrees instead of 23.4 (RMS)"
std::string describe(const ConventionFit& fit) {
    std::vector<std::string> parts;
    for (const ConventionPart part : fit.changes)
        parts.push_back(describe(fit.convention, part).description);
    return fmt::format(
        "{}: with this convention, the error is {:.3g} degrees instead of {:.3g} "
        "(RMS)",
        fmt::join(parts, "; "), fit.best_degrees, fit.given_degrees);
}

/// Commands that convert the map, or make a model that fits it; the output files are "out.png" and
/// "out.glb". Empty if no single command does it.
std::vector<std::string> convention_remedies(const std::filesystem::path& map,
                                             const std::filesystem::path& low,
                                             const ConventionFit& fit) {
    if (fit.changes.size() != 1) return {};
    const MapConvention& found = fit.convention;
    const std::string convert = fmt::format("relief-bake convert {} out.png", quoted(map));
    switch (fit.changes.front()) {
        case ConventionPart::axes:
            return {convert + " --axes=" + axes_option(found.axes)};
        case ConventionPart::flat:
            return {convert + (found.flat == FlatCode::half
                                   ? " --input-zero-code 127.5"
                                   : " --input-zero-code 128 --zero-code 127.5")};
        case ConventionPart::space:
            if (found.space == VectorSpace::tangent)
                return {fmt::format("{} --to-object {}", convert, quoted(low))};
            if (found.space == VectorSpace::object)
                return {fmt::format("{} --to-tangent {}", convert, quoted(low))};
            return {};
        case ConventionPart::basis:
            if (!found.basis) return {};
            return {fmt::format("relief-mesh process {} out.glb --tangents {}", quoted(low),
                                enum_name(*found.basis))};
        default:
            return {};
    }
}

/// The share of texels that a count is, in percent of those compared with this bake.
double percent_of_compared(std::size_t count, const BakeCheck& check) {
    const std::size_t all = check.stages.at(static_cast<std::size_t>(BakeStage::other)).error.count;
    return all > 0 ? 100.0 * static_cast<double>(count) / static_cast<double>(all) : 0.0;
}

/// Returns whether the codes of a map are not those of this bake: because of other rays, another
/// model, or an edit. Bakers treat silhouettes and borders of charts differently, so a map may have
/// some outliers there.
bool differs_from_bake(const BakeCheck& check) {
    constexpr double max_percent = 5.0, max_percent_inside = 0.5;
    const ErrorStats& other = check.stages.at(static_cast<std::size_t>(BakeStage::other)).error;
    return other.median > outlier_degrees ||
           percent_of_compared(check.outliers, check) > max_percent ||
           percent_of_compared(check.outliers - check.outliers_at_edges, check) >
               max_percent_inside;
}

/// "1.2 % of the texels differ by more than 1 degree, 90 % of them at silhouettes ...: column 3,
/// row 4 by 80 degrees; ..."; empty if there are none.
std::string outlier_text(const BakeCheck& check) {
    constexpr std::size_t max_named = 3;
    if (check.outliers == 0) return "";
    std::string text = fmt::format(
        "{:.2g} % of the texels differ from this bake by more than {:g} degree, {:.0f} % of them "
        "at silhouettes and borders of charts: ",
        percent_of_compared(check.outliers, check), outlier_degrees,
        100.0 * static_cast<double>(check.outliers_at_edges) / static_cast<double>(check.outliers));
    for (std::size_t i = 0; i < std::min(max_named, check.worst_outliers.size()); ++i) {
        const WorstTexel& texel = check.worst_outliers[i];
        text += fmt::format("{}column {}, row {} by {:.3g}", i == 0 ? "" : "; ", texel.x, texel.y,
                            texel.degrees);
    }
    return text + (check.outliers > max_named ? "; ..." : "");
}

/// Adds the problems of a map and their remedies.
void add_problems(VerifiedMap& map, const MeshBakeRequest& bake, const BakeModels& models) {
    const BakeCheck& check = map.check;
    const ErrorBound& bound = map.request.bound;
    const ErrorStats& other = check.stages.at(static_cast<std::size_t>(BakeStage::other)).error;
    if (check.convention.is_explained) {
        map.problems.push_back(describe(check.convention));
        map.remedies = convention_remedies(map.request.map, bake.low, check.convention);
    } else if (differs_from_bake(check)) {
        map.problems.push_back(fmt::format(
            "the map differs from this bake by {:.2g} degrees (median), and {:.2g} % of "
            "its texels by more than {:g} degree ({:.2g} % away from edges); none of "
            "{} conventions explains it (other models, other rays, or edited?)",
            other.median, percent_of_compared(check.outliers, check), outlier_degrees,
            percent_of_compared(check.outliers - check.outliers_at_edges, check),
            check.convention.tried));
    }
    if (!bound.allows(check.error)) {
        map.problems.push_back(fmt::format(
            "the error is {:.3g} degrees ({}), more than the limit of {}", bound.error(check.error),
            statistic_name(bound.statistic()), to_string(bound)));
    }
    const double missed = missed_percent(check.missed, check.error.count + check.frameless);
    if (check.error.count == 0) {
        map.problems.push_back("no texel has a surface to be compared with; " +
                               describe_fit(bake, models));
    } else if (missed > bake.missed_limit()) {
        map.problems.push_back(
            fmt::format("the rays of {:.3g} % of the texels hit nothing, more than {:g} %; {}",
                        missed, bake.missed_limit(), describe_fit(bake, models)));
    }
}

// The summary.

constexpr std::array stage_names = {"projection", "sampling", "quantization", "basis", "other"};

std::vector<std::string> stage_lines(const BakeCheck& check) {
    constexpr std::array descriptions = {"texels without a single normal", "too few samples",
                                         "rounding to codes", "a basis that is not orthogonal",
                                         "codes that this bake does not give"};
    std::vector<std::string> lines;
    for (std::size_t i = 0; i < bake_stage_count; ++i) {
        lines.push_back(fmt::format("{:<12} {:>6.1f} %  {:>8.3g} degrees RMS  {}", stage_names[i],
                                    100.0 * check.stages[i].fraction, check.stages[i].error.rms,
                                    descriptions[i]));
    }
    return lines;
}

std::string texel_text(const BakeCheck& check) {
    std::string text = counted(check.error.count, "texel");
    if (check.discontinuous > 0)
        text += fmt::format(", {} of them torn by the projection", check.discontinuous);
    if (check.missed > 0) text += fmt::format("; {} missed, without a reference", check.missed);
    if (check.frameless > 0) text += fmt::format("; {} without a frame", check.frameless);
    return text;
}

std::string worst_text(const BakeCheck& check) {
    std::string text;
    for (std::size_t i = 0; i < std::min<std::size_t>(check.worst.size(), 4); ++i) {
        const WorstTexel& texel = check.worst[i];
        text += fmt::format("{}column {}, row {}: {:.3g}{}", i == 0 ? "" : "; ", texel.x, texel.y,
                            texel.degrees, texel.is_discontinuous ? " torn" : "");
    }
    return text;
}

std::vector<std::string> verdict_lines(const VerifiedMap& map) {
    if (map.problems.empty()) {
        return {map.request.bound.degrees ? fmt::format("within {}", to_string(map.request.bound))
                                          : "matches this bake"};
    }
    std::vector<std::string> lines = map.problems;
    for (const std::string& remedy : map.remedies)
        lines.push_back("-> " + remedy);
    return lines;
}

Json summary_json(const ErrorStats& summary) {
    return {{"rms", summary.rms},
            {"mean", summary.mean},
            {"p99", summary.p99},
            {"max", summary.max},
            {"texels", summary.count}};
}

Json convention_json(const ConventionFit& fit) {
    return {{"searched", fit.was_searched},
            {"explained", fit.is_explained},
            {"differs_in",
             json_list(fit.changes,
                       [&](ConventionPart part) { return describe(fit.convention, part).name; })},
            {"assumed_degrees", fit.given_degrees},
            {"best_degrees", fit.best_degrees},
            {"tried", fit.tried}};
}

Json worst_json(const WorstTexel& texel) {
    return {{"x", texel.x},
            {"y", texel.y},
            {"degrees", texel.degrees},
            {"torn", texel.is_discontinuous}};
}

}  // namespace

VerifiedMap verify_map(const Baker& baker, const BakeModels& models, const MeshBakeRequest& bake,
                       BakeMapOptions map, const VerifyRequest& request, Report& report) {
    const Stopwatch stopwatch;
    VerifiedMap verified;
    verified.request = request;
    InputMap input = read_normal_map(request.map, request.input);
    map.width = input.image.width;
    map.height = input.image.height;
    map.padding = 0;
    map.border_folder.reset();
    BakeCheckOptions options;
    options.map = map;
    options.format.green = input.green.value_or(Green::up);
    options.format.flat = input.flat;
    options.format.dither = bake.map.dither.value_or(Dither::none);
    options.given = &models.low;
    if (models.world_from_low) options.object_from_mesh = glm::transpose(*models.world_from_low);
    std::vector<float> errors;
    verified.check = about(request.map, [&] {
        return check_bake(
            baker, input.image, options,
            [&](int, std::span<const float> degrees) {
                if (request.error_map) errors.insert(errors.end(), degrees.begin(), degrees.end());
            },
            report);
    });
    if (request.error_map) {
        verified.brightest =
            write_error_map(*request.error_map, errors, map, verified.check.error.p99);
    }
    add_problems(verified, bake, models);
    verified.milliseconds = 1e3 * stopwatch.seconds();
    return verified;
}

std::string to_string(const ErrorStats& summary) {
    return fmt::format("RMS {:.3g} degrees, mean {:.3g}, 99 % within {:.3g}, {:.3g} at most",
                       summary.rms, summary.mean, summary.p99, summary.max);
}

Summary summary_of(const VerifiedMap& map) {
    const BakeCheck& check = map.check;
    Json stages = Json::object();
    for (std::size_t i = 0; i < bake_stage_count; ++i)
        stages[stage_names[i]] = {{"fraction", check.stages[i].fraction},
                                  {"rms", check.stages[i].error.rms}};
    Summary summary;
    summary.add(
        "error",
        {to_string(check.error) +
             fmt::format(", from the mean over each texel ({} samples)", check.reference_samples),
         to_string(check.center) + ", from the normal at its center", texel_text(check)},
        {{"error", summary_json(check.error)},
         {"center", summary_json(check.center)},
         {"remade", summary_json(check.rebaked)},
         {"reference_samples", check.reference_samples},
         {"torn", check.discontinuous},
         {"missed", check.missed},
         {"frameless", check.frameless}});
    summary.add("stages", stage_lines(check), {{"stages", std::move(stages)}});
    summary.add("worst", check.error.max > 0.0 ? worst_text(check) : "",
                {{"worst", json_list(check.worst, worst_json)}});
    const ErrorStats& other = check.stages.at(static_cast<std::size_t>(BakeStage::other)).error;
    summary.add("outliers", outlier_text(check),
                {{"outliers",
                  {{"median", other.median},
                   {"percent", percent_of_compared(check.outliers, check)},
                   {"percent_at_edges", percent_of_compared(check.outliers_at_edges, check)},
                   {"texels", json_list(check.worst_outliers, worst_json)}}}});
    summary.add("verdict", verdict_lines(map),
                {{"convention", convention_json(check.convention)},
                 {"problems", map.problems},
                 {"remedies", map.remedies}});
    if (map.request.error_map) {
        const std::filesystem::path& file = *map.request.error_map;
        summary.add(
            "errors",
            fmt::format("{} ({:g} degrees is brightest)", file_and_size(file), map.brightest),
            {{"error_map", {{"file", file.string()}, {"brightest", map.brightest}}}});
    }
    summary.add("checked", fmt::format("{} rays, {}", check.rays, duration(map.milliseconds)),
                {{"rays", check.rays}, {"milliseconds", map.milliseconds}});
    return summary;
}

}  // namespace relief::tools
