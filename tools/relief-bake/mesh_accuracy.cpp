// SPDX-License-Identifier: Apache-2.0
// Measures the errors of samples and bits on a map and selects the fewest within a limit; and
// compares a finished map with the models that it was baked from: errors by cause, an error map,
// and the convention that explains the map if it is not the assumed one. Tests:
// tests/tools/relief_bake_accuracy_test.cpp, relief_bake_check_test.cpp.

#include "mesh_accuracy.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "common/text.h"
#include "mesh_maps.h"
#include "relief/accuracy/experiment.h"
#include "relief/mesh/bake_check.h"
#include "relief/mesh/image.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/report.h"
#include "relief/mesh/timing.h"

namespace relief::tools {

// Samples and bits.

namespace {

constexpr std::size_t texels_for_limit = std::size_t{1} << 17;
constexpr std::size_t texels_for_table = std::size_t{1} << 16;
constexpr std::size_t texels_for_finest = std::size_t{1} << 14;
constexpr std::size_t rounds = 3;
constexpr int max_samples = 256;  // Of --samples.
constexpr int finest_reference = 1024;

/// The bit depths that the file can store and the options leave open, in ascending order.
std::vector<int> available_depths(const MeshBakeRequest& request) {
    if (request.map.bits) return {*request.map.bits};
    std::vector<int> depths = depths_of(request.output);
    // Options for codes have no effect on floats.
    if (request.map.flat || request.map.dither) std::erase(depths, 32);
    std::ranges::sort(depths);
    return depths;
}

/// Searches for the fewest samples and bits within the limit. Depths that only other file formats
/// store are measured too, for the remedy if there is none.
class SampleSearch {
  public:
    SampleSearch(const MeshBakeRequest& request, const NormalMapFormat& format)
        : request_(request), bound_(request.bound), available_(available_depths(request)) {
        for (const int bits : {8, 16, 32}) {
            formats_.push_back(format);
            formats_.back().bits = bits;
        }
        // Other depths are not measured.
        std::erase_if(available_, [](int bits) { return bits != 8 && bits != 16 && bits != 32; });
    }

    /// Measures one number of samples in all formats, and adds those of the file to the result.
    /// \return whether a method is within the limit
    bool try_samples(const BakeBenchmark& trials, const SampleChoice& samples,
                     MeshAccuracy& result) {
        for (MeasuredBake& bake : measure(trials, samples)) {
            const bool available = is_available(bake);
            if (available && !result.selected && bound_.allows(bake.error)) result.selected = bake;
            if (available) result.measured.push_back(bake);
            all_.push_back(std::move(bake));
        }
        return result.selected.has_value();
    }

    /// Discards the measurements, which are of other texels than the next ones.
    void restart() { all_.clear(); }

    /// Returns whether rounding alone exceeds the limit in all formats of the file.
    [[nodiscard]] bool is_bound_by_rounding() const {
        return std::ranges::all_of(all_, [&](const MeasuredBake& bake) {
            return !is_available(bake) || bound_.error(bake.rounding) > *bound_.degrees;
        });
    }

    /// Throws the error that no method is within the limit.
    /// \param has_all_samples  whether 256 samples were measured
    [[noreturn]] void fail(bool has_all_samples) const {
        const MeasuredBake* best = nullptr;
        const MeasuredBake* other_format = nullptr;  // Within the limit in another file format.
        for (const MeasuredBake& bake : all_) {
            if (is_available(bake)) {
                if (best == nullptr || error(bake) < error(*best)) best = &bake;
            } else if (bound_.allows(bake.error) &&
                       (other_format == nullptr || bake.format.bits < other_format->format.bits)) {
                other_format = &bake;
            }
        }
        const double rounding = bound_.error(best->rounding);
        const double sampling = bound_.error(best->sampling);
        std::string parts =
            rounding >= sampling
                ? fmt::format("rounding to {} bits alone causes {:.3g}, sampling {:.3g}",
                              best->format.bits, rounding, sampling)
                : fmt::format("sampling alone causes {:.3g}, rounding to {} bits {:.3g}", sampling,
                              best->format.bits, rounding);
        if (!has_all_samples) parts += "; 256 samples cannot be measured on a map of this size";
        throw InvalidInput(fmt::format(
            "no choice of samples and bits is within {}: the minimum is {:.3g}, with {}; {} ({})",
            to_string(bound_), error(*best), to_string(*best), parts, remedy(other_format)));
    }

  private:
    std::vector<MeasuredBake> measure(const BakeBenchmark& trials, const SampleChoice& samples) {
        const std::optional<double> angle = angle_of(request_, samples);
        const BakeMeasurement trial = trials.measure({samples.count, angle}, formats_);
        std::vector<MeasuredBake> measured;
        for (std::size_t i = 0; i < formats_.size(); ++i) {
            measured.push_back({samples, angle, formats_[i], trial.errors[i], trial.quantization[i],
                                trial.sampling, trial.rays,
                                trial.cast_seconds + trial.code_seconds[i], false});
        }
        // The error of no texels would be within any limit.
        if (measured.front().error.count == 0)
            throw InvalidInput(
                "no measured texel has a normal from the high model: no error can be measured");
        return measured;
    }

    [[nodiscard]] bool is_available(const MeasuredBake& bake) const {
        return std::ranges::find(available_, bake.format.bits) != available_.end();
    }
    [[nodiscard]] double error(const MeasuredBake& bake) const { return bound_.error(bake.error); }

    [[nodiscard]] std::string remedy(const MeasuredBake* other_format) const {
        if (other_format == nullptr) return "allow a larger error";
        const int bits = other_format->format.bits;
        const std::vector<int> depths = depths_of(request_.output);
        const bool is_supported = std::ranges::find(depths, bits) != depths.end();
        const std::string change = is_supported ? fmt::format("give --bits {}", bits)
                                   : bits == 32 ? "write .exr or .tif"
                                                : "write .png or .tif";
        return fmt::format("{} bits are within the limit, with {:.3g}: {}", bits,
                           error(*other_format), change);
    }

    const MeshBakeRequest& request_;
    const ErrorBound& bound_;
    std::vector<int> available_;
    std::vector<NormalMapFormat> formats_;
    std::vector<MeasuredBake> all_;
};

/// The number of texels to measure: all of them for a limit of the maximum.
std::size_t texels_for(const MeshBakeRequest& request, const BakeMapOptions& map,
                       std::size_t usual) {
    const bool needs_all = request.bound.kind == ErrorKind::max;
    return needs_all ? static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height)
                     : usual;
}

void describe(const BakeBenchmark& trials, MeshAccuracy& result) {
    result.texels = trials.texels();
    result.is_whole = trials.is_whole();
    result.reference_samples = trials.reference_samples();
    result.reference_rays += trials.reference_rays();
}

/// Selects samples and bits within the limit.
void select_within_limit(const Baker& baker, const BakeMapOptions& map, MeshBakeRequest& request,
                         NormalMapFormat& format, MeshAccuracy& result) {
    SampleSearch search(request, format);
    const bool is_given = request.samples.is_given;
    const bool needs_finest = is_given && request.samples.count == max_samples;
    const bool has_finest = std::max(map.width, map.height) * 32 <= TexelRasterizer::largest_side;
    if (needs_finest && !has_finest)
        throw InvalidInput(
            "the error of 256 samples can be measured only for maps of at most 2048 texels along a "
            "side");
    if (!needs_finest) {
        const BakeBenchmark trials(baker, map, texels_for(request, map, texels_for_limit));
        describe(trials, result);
        if (is_given) {
            if (!search.try_samples(trials, request.samples, result)) search.fail(true);
        } else {
            for (const int count : {1, 4, 16, 64}) {
                if (search.try_samples(trials, {count, false, false}, result)) break;
                // More samples do not help; only the message needs them.
                if (has_finest && search.is_bound_by_rounding()) break;
            }
        }
    }
    if (!result.selected) {
        if (!has_finest) search.fail(false);
        const BakeBenchmark trials(baker, map, texels_for(request, map, texels_for_finest),
                                   finest_reference);
        describe(trials, result);
        search.restart();
        if (!search.try_samples(trials, {max_samples, false, is_given}, result)) {
            // All methods are measured on the same texels, to find the minimum.
            MeshAccuracy unused;
            if (!is_given) {
                for (const int count : {1, 4, 16, 64})
                    search.try_samples(trials, {count, false, false}, unused);
            }
            search.fail(true);
        }
    }
    request.samples = result.selected->samples;
    format = result.selected->format;
}

/// Measures all methods in all bit depths, including those of other file formats.
void compare_methods(const BakeBenchmark& trials, const NormalMapFormat& format,
                     MeshAccuracy& result) {
    const std::span<const BakeSampling> ways = default_bake_samplings();
    const std::vector<NormalMapFormat> formats = default_map_formats(format);
    const std::vector<TimedBakeMeasurement> timed =
        measure_interleaved(trials, ways, formats, {rounds, 0});
    if (timed.front().trial.errors.front().count == 0)
        throw InvalidInput("no texel has a normal from the high model: no error can be measured");
    std::vector<MethodCost> prices;
    for (std::size_t way = 0; way < ways.size(); ++way) {
        const BakeMeasurement& trial = timed[way].trial;
        const SampleChoice samples{ways[way].samples, ways[way].sample_degrees.has_value(), false};
        for (std::size_t f = 0; f < formats.size(); ++f) {
            result.measured.push_back({samples, ways[way].sample_degrees, formats[f],
                                       trial.errors[f], trial.quantization[f], trial.sampling,
                                       trial.rays, time_statistics(timed[way].seconds[f]).median,
                                       false});
            prices.push_back({result.measured.back().error.rms, result.measured.back().seconds});
        }
    }
    const std::vector<bool> marks = pareto_optimal(prices);
    for (std::size_t i = 0; i < marks.size(); ++i)
        result.measured[i].is_pareto_optimal = marks[i];
}

}  // namespace

std::string to_string(const MeasuredBake& bake) {
    const std::string samples =
        bake.samples.is_auto
            ? fmt::format("auto samples at {:g} degrees", bake.sample_angle.value_or(0.0))
            : counted(static_cast<std::size_t>(bake.samples.count), "sample");
    return fmt::format("{}, {} bit{}", samples, bake.format.bits,
                       bake.format.dither == Dither::none ? "" : ", dithered");
}

void check_accuracy(const MeshBakeRequest& request) {
    check(request.bound);
    if (!request.needs_trials()) return;
    if (request.compare && request.bound.degrees)
        throw UsageError("--compare, --max-error: contradict each other");
    const std::string option = request.compare ? "--compare" : "--max-error";
    if (request.map.half)
        throw UsageError(option + ", --half: errors of half floats are not measured");
    if (names_word(request.output, material_word) || names_word(request.output, tile_word))
        throw UsageError(option + ": needs a single map, not <material> or <UDIM>");
}

MeshAccuracy select_accuracy(const Baker& baker, const BakeMapOptions& map,
                             MeshBakeRequest& request, NormalMapFormat& format) {
    MeshAccuracy result;
    if (request.compare) {
        const BakeBenchmark trials(baker, map, texels_for(request, map, texels_for_table));
        describe(trials, result);
        compare_methods(trials, format, result);
    } else {
        select_within_limit(baker, map, request, format, result);
    }
    return result;
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
    const std::map<std::string, std::string> metadata = {
        {"relief:content", is_picture ? "errors of normals as heat" : "errors of normals, degrees"},
        {"relief:brightest", fmt::format("{:g}", brightest)}};
    const ImageShape shape = {map.width, map.height, is_picture ? 4 : 1, is_picture ? 8 : 32,
                              is_picture ? ColorSpace::srgb : ColorSpace::data};
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
        fmt::join(parts, "; "), fit.found_degrees, fit.given_degrees);
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

/// Adds the problems of a map and their remedies.
void add_problems(VerifiedMap& map, const MeshBakeRequest& bake, const BakeModels& models) {
    // Above this, codes differ from those of the bake: other rays, another program, or an edit.
    constexpr double max_other_degrees = 1.0;
    const BakeCheck& check = map.check;
    const ErrorBound& bound = map.request.bound;
    const double other = check.stages.at(static_cast<std::size_t>(BakeStage::other)).rms;
    if (check.convention.is_explained) {
        map.problems.push_back(describe(check.convention));
        map.remedies = convention_remedies(map.request.map, bake.low, check.convention);
    } else if (other > max_other_degrees) {
        map.problems.push_back(
            fmt::format("the map differs from this bake by {:.3g} degrees (RMS), and none of {} "
                        "conventions explains it (other models, other rays, or edited?)",
                        other, check.convention.tried));
    }
    if (!bound.allows(check.error)) {
        map.problems.push_back(fmt::format("the error is {:.3g} degrees, more than the limit of {}",
                                           bound.error(check.error), to_string(bound)));
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

constexpr std::array stage_names = {"projection", "sampling", "quantisation", "basis", "other"};

std::vector<std::string> stage_lines(const BakeCheck& check) {
    constexpr std::array descriptions = {"texels without a single normal", "too few samples",
                                         "rounding to codes", "a basis that is not orthogonal",
                                         "codes that this bake does not give"};
    std::vector<std::string> lines;
    for (std::size_t i = 0; i < bake_stage_count; ++i) {
        lines.push_back(fmt::format("{:<12} {:>6.1f} %  {:>8.3g} degrees RMS  {}", stage_names[i],
                                    100.0 * check.stages[i].share, check.stages[i].rms,
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
        text += fmt::format("{}({}, {}): {:.3g}{}", i == 0 ? "" : "; ", texel.x, texel.y,
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

nlohmann::ordered_json summary_json(const ErrorStats& summary) {
    return {{"rms", summary.rms},
            {"mean", summary.mean},
            {"p99", summary.p99},
            {"max", summary.max},
            {"texels", summary.count}};
}

nlohmann::ordered_json convention_json(const ConventionFit& fit) {
    std::vector<std::string> parts;
    for (const ConventionPart part : fit.changes)
        parts.emplace_back(describe(fit.convention, part).name);
    return {{"searched", fit.was_searched},
            {"explained", fit.is_explained},
            {"differs_in", parts},
            {"told_degrees", fit.given_degrees},
            {"found_degrees", fit.found_degrees},
            {"tried", fit.tried}};
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
    return fmt::format("RMS {:.3g} degrees, mean {:.3g}, 99 of 100 within {:.3g}, {:.3g} at most",
                       summary.rms, summary.mean, summary.p99, summary.max);
}

void print_verified(const VerifiedMap& map) {
    const BakeCheck& check = map.check;
    print_entry(
        "error",
        {to_string(check.error) +
             fmt::format(", from the mean over each texel ({} samples)", check.reference_samples),
         to_string(check.center) + ", from the normal at its center", texel_text(check)});
    print_entry("stages", stage_lines(check));
    if (check.error.max > 0.0) print_entry("worst", worst_text(check));
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
        worst.push_back({{"x", texel.x},
                         {"y", texel.y},
                         {"degrees", texel.degrees},
                         {"torn", texel.is_discontinuous}});
    }
    nlohmann::ordered_json json = {{"error", summary_json(check.error)},
                                   {"centre", summary_json(check.center)},
                                   {"remade", summary_json(check.rebaked)},
                                   {"reference_samples", check.reference_samples},
                                   {"torn", check.discontinuous},
                                   {"missed", check.missed},
                                   {"frameless", check.frameless},
                                   {"stages", stages},
                                   {"worst", worst},
                                   {"convention", convention_json(check.convention)},
                                   {"trouble", map.problems},
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
