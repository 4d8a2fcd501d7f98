// SPDX-License-Identifier: Apache-2.0
// Measures bakes against one reference: errors by format, times, and the search for the fewest
// samples and bits within a limit.
// Tests: tests/accuracy/bake_accuracy_test.cpp, tests/tools/relief_bake_accuracy_test.cpp.
#include "relief/accuracy/bake_accuracy.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <glm/trigonometric.hpp>

#include "progress_stage.h"
#include "relief/accuracy/experiment.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/image.h"
#include "relief/mesh/texel_coverage.h"

namespace relief::accuracy {
using namespace relief::detail;

namespace {

constexpr std::size_t texels_for_limit = std::size_t{1} << 17;
constexpr std::size_t texels_for_table = std::size_t{1} << 16;
constexpr std::size_t texels_for_finest = std::size_t{1} << 14;
constexpr std::size_t timed_rounds = 3;
constexpr int max_samples = 256;
constexpr int finest_reference = 1024;

BakedTexels baked(const BakeReference& reference, const BakeSampling& sampling) {
    std::optional<double> angle;
    if (sampling.sample_degrees) angle = glm::radians(*sampling.sample_degrees);
    return reference.bake(sampling.samples, angle);
}

const ErrorStats& error_of(const BakeCheck& check, BakeStage stage) {
    return check.stages.at(static_cast<std::size_t>(stage)).error;
}

}  // namespace

BakeMeasurement measure_bake(const BakeReference& reference, const BakeSampling& sampling,
                             std::span<const NormalMapFormat> formats) {
    BakeMeasurement result;
    BakedTexels bake;
    result.cast_seconds = seconds_of([&] { bake = baked(reference, sampling); });
    result.rays = bake.rays;
    std::vector<float> degrees(reference.texels());
    for (const NormalMapFormat& format : formats) {
        std::vector<float> coded;
        result.code_seconds.push_back(seconds_of([&] { coded = reference.coded(bake, format); }));
        const BakeCheck check = reference.compare(bake, coded, degrees);
        result.errors.push_back(check.error);
        result.center.push_back(check.center);
        result.quantization.push_back(error_of(check, BakeStage::quantization));
        result.sampling = error_of(check, BakeStage::sampling);
    }
    return result;
}

Image bake_error_map(const BakeReference& reference, const BakeSampling& sampling,
                     const NormalMapFormat& format) {
    const auto rows =
        static_cast<int>(reference.texels() / static_cast<std::size_t>(reference.width()));
    Image errors = make_image(reference.width(), rows, 1, 32, ColorSpace::data);
    const BakedTexels bake = baked(reference, sampling);
    reference.compare(bake, reference.coded(bake, format), errors.as<float>());
    return errors;
}

std::span<const BakeSampling> default_bake_samplings() {
    static const std::array<BakeSampling, 7> samplings = {
        {{1, {}}, {4, {}}, {16, {}}, {64, {}}, {16, 8.0}, {16, 2.0}, {16, 0.5}}};
    return samplings;
}

std::vector<NormalMapFormat> default_map_formats(const NormalMapFormat& format) {
    std::vector<NormalMapFormat> formats(4, format);
    for (NormalMapFormat& one : formats)
        one.dither = Dither::none;
    formats[0].bits = formats[1].bits = 8;
    formats[1].dither = Dither::blue_noise;
    formats[2].bits = 16;
    formats[3].bits = 32;
    return formats;
}

std::vector<TimedBakeMeasurement> measure_interleaved(const BakeReference& reference,
                                                      std::span<const BakeSampling> samplings,
                                                      std::span<const NormalMapFormat> formats,
                                                      const Repeats& repeats) {
    std::vector<TimedBakeMeasurement> results(samplings.size());
    interleave(samplings.size(), repeats, [&](std::size_t i, bool counted) {
        check_cancelled();
        TimedBakeMeasurement& one = results[i];
        one.measurement = measure_bake(reference, samplings[i], formats);
        one.seconds.resize(formats.size());
        for (std::size_t f = 0; counted && f < formats.size(); ++f) {
            one.seconds[f].push_back(one.measurement.cast_seconds +
                                     one.measurement.code_seconds[f]);
        }
    });
    return results;
}

namespace {

/// Returns the measurement of a sampling in each format.
std::vector<MeasuredBake> by_format(const BakeSampling& sampling,
                                    std::span<const NormalMapFormat> formats,
                                    const BakeMeasurement& measurement) {
    std::vector<MeasuredBake> measured;
    for (std::size_t f = 0; f < formats.size(); ++f) {
        measured.push_back({sampling, formats[f], measurement.errors[f],
                            measurement.quantization[f], measurement.sampling, measurement.rays,
                            measurement.cast_seconds + measurement.code_seconds[f], false});
    }
    // Without a texel, any limit would hold.
    if (measured.front().error.count == 0) {
        throw InvalidInput(
            "no measured texel has a normal from the high model: no error can be measured");
    }
    return measured;
}

void describe(const BakeReference& reference, BakeComparison& result) {
    result.texels = reference.texels();
    result.is_whole = reference.is_whole();
    result.reference_samples = reference.samples();
    result.reference_rays += reference.rays();
}

}  // namespace

BakeComparison compare_bakes(const Baker& baker, const BakeMapOptions& map,
                             const NormalMapFormat& format) {
    const BakeReference reference(baker, map, texels_for_table);
    BakeComparison result;
    describe(reference, result);
    const std::span<const BakeSampling> samplings = default_bake_samplings();
    const std::vector<NormalMapFormat> formats = default_map_formats(format);
    const std::vector<TimedBakeMeasurement> timed =
        measure_interleaved(reference, samplings, formats, {timed_rounds, 0});
    std::vector<MethodCost> costs;
    for (std::size_t i = 0; i < samplings.size(); ++i) {
        std::vector<MeasuredBake> measured = by_format(samplings[i], formats, timed[i].measurement);
        for (std::size_t f = 0; f < formats.size(); ++f) {
            measured[f].seconds = time_statistics(timed[i].seconds[f]).median;
            costs.push_back({measured[f].error.rms, measured[f].seconds, timed[i].seconds[f]});
            result.measured.push_back(std::move(measured[f]));
        }
    }
    const std::vector<bool> is_optimal = pareto_optimal(costs);
    for (std::size_t i = 0; i < is_optimal.size(); ++i)
        result.measured[i].is_pareto_optimal = is_optimal[i];
    return result;
}

namespace {

/// Measures numbers of samples until one is within the limit. Bits that are not permitted are
/// measured too, because they may be the remedy.
class SampleSearch {
  public:
    explicit SampleSearch(const BakeSearch& search) : search_(search) {
        for (const int bits : {8, 16, 32}) {
            formats_.push_back(search.format);
            formats_.back().bits = bits;
        }
    }

    /// Measures one number of samples in all formats, and adds those with permitted bits to the
    /// result. \return whether one is within the limit
    bool try_samples(const BakeReference& reference, const BakeSampling& sampling,
                     BakeComparison& result) {
        const BakeMeasurement measurement = measure_bake(reference, sampling, formats_);
        for (MeasuredBake& bake : by_format(sampling, formats_, measurement)) {
            if (is_permitted(bake)) {
                if (!result.selected && is_within(bake)) result.selected = bake;
                result.measured.push_back(bake);
            }
            all_.push_back(std::move(bake));
        }
        return result.selected.has_value();
    }

    /// Discards the measurements, which are of other texels than the next ones.
    void restart() { all_.clear(); }

    /// Returns whether rounding alone exceeds the limit with all permitted bits.
    [[nodiscard]] bool is_bound_by_rounding() const {
        return std::ranges::all_of(all_, [&](const MeasuredBake& bake) {
            return !is_permitted(bake) ||
                   bake.quantization.*figure_of(search_.kind) > search_.max_degrees;
        });
    }

    /// \throws NoBakeWithinLimit
    [[noreturn]] void fail(bool has_all_samples) const {
        const MeasuredBake* smallest = nullptr;
        for (const MeasuredBake& bake : all_) {
            if (is_permitted(bake) && (smallest == nullptr || error(bake) < error(*smallest)))
                smallest = &bake;
        }
        NoBakeWithinLimit failure(
            fmt::format("no choice of samples and bits is within {:g} degrees ({}): the minimum is "
                        "{:.3g}",
                        search_.max_degrees, statistic_name(search_.kind), error(*smallest)));
        failure.smallest = *smallest;
        failure.has_all_samples = has_all_samples;
        for (const MeasuredBake& bake : all_) {
            if (!is_permitted(bake) && is_within(bake) &&
                (!failure.other_bits || bake.format.bits < failure.other_bits->format.bits))
                failure.other_bits = bake;
        }
        throw failure;
    }

  private:
    [[nodiscard]] bool is_permitted(const MeasuredBake& bake) const {
        return std::ranges::find(search_.bits, bake.format.bits) != search_.bits.end();
    }
    [[nodiscard]] double error(const MeasuredBake& bake) const {
        return bake.error.*figure_of(search_.kind);
    }
    [[nodiscard]] bool is_within(const MeasuredBake& bake) const {
        return error(bake) <= search_.max_degrees;
    }

    const BakeSearch& search_;
    std::vector<NormalMapFormat> formats_;
    std::vector<MeasuredBake> all_;
};

}  // namespace

BakeComparison select_bake(const Baker& baker, const BakeMapOptions& map,
                           const BakeSearch& options) {
    constexpr std::array counts = {1, 4, 16, 64};
    // A limit of the maximum applies to all texels.
    const auto texels = [&](std::size_t usual) {
        return options.kind != ErrorKind::max
                   ? usual
                   : static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height);
    };
    SampleSearch search(options);
    BakeComparison result;
    const bool needs_finest = options.sampling && options.sampling->samples == max_samples;
    const bool has_finest = std::max(map.width, map.height) * 32 <= TexelRasterizer::largest_side;
    if (needs_finest && !has_finest)
        throw InvalidInput(
            "the error of 256 samples can be measured only for maps of at most 2048 texels along a "
            "side");
    if (!needs_finest) {
        const BakeReference reference(baker, map, texels(texels_for_limit));
        describe(reference, result);
        if (options.sampling) {
            if (!search.try_samples(reference, *options.sampling, result)) search.fail(true);
        } else {
            for (const int count : counts) {
                if (search.try_samples(reference, {count, {}}, result)) break;
                // More samples do not help; only the message needs them.
                if (has_finest && search.is_bound_by_rounding()) break;
            }
        }
    }
    if (result.selected) return result;
    if (!has_finest) search.fail(false);
    const BakeReference reference(baker, map, texels(texels_for_finest), finest_reference);
    describe(reference, result);
    search.restart();
    if (search.try_samples(reference, options.sampling.value_or(BakeSampling{max_samples, {}}),
                           result))
        return result;
    // All samplings are measured on the same texels, to find the minimum.
    BakeComparison unused;
    for (const int count : counts) {
        if (!options.sampling) search.try_samples(reference, {count, {}}, unused);
    }
    search.fail(true);
}

}  // namespace relief::accuracy
