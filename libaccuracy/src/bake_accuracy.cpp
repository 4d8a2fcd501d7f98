// SPDX-License-Identifier: Apache-2.0
// Measures bakes against one reference: errors by format, times, and the search for the fewest
// samples and bits within a limit.
// Tests: tests/accuracy/bake_accuracy_test.cpp, tests/tools/relief_bake_accuracy_test.cpp.
#include "relief/accuracy/bake_accuracy.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <glm/trigonometric.hpp>

#include "experiment_parts.h"
#include "parallel.h"
#include "relief/accuracy/experiment.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/image.h"
#include "relief/mesh/texel_coverage.h"

namespace relief::accuracy {
using namespace relief::accuracy::detail;
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

std::vector<MeasuredBake> measure_bake(const BakeReference& reference, const BakeSampling& sampling,
                                       std::span<const NormalMapFormat> formats) {
    std::vector<MeasuredBake> measured;
    BakedTexels bake;
    const double cast_seconds = seconds_of([&] { bake = baked(reference, sampling); });
    std::vector<float> degrees(reference.texels());
    for (const NormalMapFormat& format : formats) {
        std::vector<float> coded;
        const double code_seconds = seconds_of([&] { coded = reference.coded(bake, format); });
        const BakeCheck check = reference.compare(bake, coded, degrees);
        measured.push_back({sampling, format, check.error, error_of(check, BakeStage::quantization),
                            error_of(check, BakeStage::sampling), check.center, bake.rays,
                            cast_seconds + code_seconds});
    }
    return measured;
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

detail::TimedBakes::TimedBakes(std::shared_ptr<const BakeReference> reference,
                               std::span<const BakeSampling> samplings,
                               std::vector<NormalMapFormat> formats)
    : reference_(std::move(reference)),
      samplings_(samplings.begin(), samplings.end()),
      formats_(std::move(formats)),
      bakes_(samplings_.size()) {}

void detail::TimedBakes::cast(std::size_t sampling) {
    bakes_[sampling] = {measure_bake(*reference_, samplings_[sampling], formats_),
                        std::vector<bool>(formats_.size(), false), thread_count()};
}

const std::vector<MeasuredBake>& detail::TimedBakes::result(std::size_t sampling) {
    if (!bakes_[sampling]) cast(sampling);
    return bakes_[sampling]->by_format;
}

double detail::TimedBakes::seconds_of_round(std::size_t sampling, std::size_t format) {
    std::optional<Bake>& bake = bakes_[sampling];
    if (!bake || bake->is_format_used[format] || bake->threads != thread_count()) cast(sampling);
    bake->is_format_used[format] = true;
    return bake->by_format[format].seconds;
}

std::vector<Method> detail::methods_of(
    const std::shared_ptr<TimedBakes>& bakes,
    const std::function<Method(const BakeSampling&, const NormalMapFormat&)>& described) {
    std::vector<Method> methods;
    for (std::size_t s = 0; s < bakes->samplings().size(); ++s) {
        for (std::size_t f = 0; f < bakes->formats().size(); ++f) {
            Method& method =
                methods.emplace_back(described(bakes->samplings()[s], bakes->formats()[f]));
            method.error = [bakes, s, f] { return bakes->result(s)[f].error; };
            method.round = [bakes, s, f] { return bakes->seconds_of_round(s, f); };
        }
    }
    return methods;
}

namespace {

/// Without a texel, any limit would hold.
void require_texels(const std::vector<MeasuredBake>& measured) {
    if (measured.front().error.count == 0) {
        throw InvalidInput(
            "no measured texel has a normal from the high model: no error can be measured");
    }
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
    const auto bakes = std::make_shared<TimedBakes>(
        std::make_shared<const BakeReference>(baker, map, texels_for_table),
        default_bake_samplings(), default_map_formats(format));
    BakeComparison result;
    describe(bakes->reference(), result);
    RunOptions run;
    run.repeats = {timed_rounds, 0};
    const Experiment experiment = detail::measured(
        {.methods = methods_of(bakes, [](const auto&, const auto&) { return Method(); }),
         .costs = {.one_thread = false, .memory = false}},
        run);
    for (std::size_t i = 0; i < bakes->samplings().size(); ++i) {
        require_texels(bakes->result(i));
        for (const MeasuredBake& one : bakes->result(i)) {
            const Measurement& measurement = experiment.measurements[result.measured.size()];
            MeasuredBake& timed = result.measured.emplace_back(one);
            timed.seconds = median_seconds(measurement);
            timed.is_pareto_optimal = measurement.is_pareto_optimal;
        }
    }
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
        std::vector<MeasuredBake> measured = measure_bake(reference, sampling, formats_);
        require_texels(measured);
        for (MeasuredBake& bake : measured) {
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
