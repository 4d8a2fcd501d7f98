// SPDX-License-Identifier: Apache-2.0
// Measures the errors of samples and bits on a map, and selects the fewest within a limit.
// Tests: tests/tools/relief_bake_accuracy_test.cpp.
#include <fmt/format.h>

#include <algorithm>

#include "common/text.h"
#include "mesh_bake.h"
#include "relief/mesh/bake_check.h"
#include "relief/mesh/frontier.h"
#include "relief/mesh/report.h"
#include "relief/mesh/timing.h"

namespace relief::tools {
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
    const bool needs_all = request.bound.kind == BoundKind::max;
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

}  // namespace relief::tools
