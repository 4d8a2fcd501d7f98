// SPDX-License-Identifier: Apache-2.0
// Errors and times of bakes with several sample counts and encodings. The reference is baked once,
// for bands spread over the map. Tests: tests/mesh/bake/bake_check_test.cpp.
#include "relief/mesh/bake_check.h"

#include <algorithm>
#include <array>
#include <glm/trigonometric.hpp>

#include "bake/bake_check_rows.h"
#include "progress_stage.h"

namespace relief {
namespace {

/// Rows with their reference.
struct Band {
    BakeRowRange rows;
    BakeCasts casts;
};

}  // namespace

struct BakeBenchmark::Implementation {
    const Baker& baker;
    BakeMapOptions map;  ///< With one sample.
    int reference_samples;
    std::vector<Band> bands;
    bool is_whole = true;

    [[nodiscard]] BakeMapOptions map_by(const BakeSampling& way) const {
        BakeMapOptions made = map;
        made.samples = way.samples;
        if (way.sample_degrees) made.sample_angle = glm::radians(*way.sample_degrees);
        return made;
    }

    [[nodiscard]] std::size_t texels_of(const BakeRowRange& rows) const {
        return static_cast<std::size_t>(map.width) *
               static_cast<std::size_t>(rows.last - rows.first);
    }
};

BakeBenchmark::BakeBenchmark(const Baker& baker, const BakeMapOptions& map, std::size_t texels,
                             int reference_samples)
    : implementation_(new Implementation{baker, map, 0, {}, true}) {
    Implementation& data = *implementation_;
    data.map.samples = 1;
    data.map.sample_angle.reset();
    data.reference_samples =
        reference_of(map, reference_samples > 0 ? reference_samples : 256).samples;
    constexpr int band = TexelRasterizer::band_rows;
    const int bands = (map.height + band - 1) / band;
    const std::size_t band_texels =
        static_cast<std::size_t>(map.width) * static_cast<std::size_t>(band);
    const auto count =
        static_cast<int>(std::min(texels / band_texels + 1, static_cast<std::size_t>(bands)));
    data.is_whole = count == bands;
    Report ignored;
    for (int i = 0; i < count; ++i) {
        // The middle band of each of `count` equal parts.
        const int first = (2 * i + 1) * bands / (2 * count) * band;
        const BakeRowRange rows{first, std::min(first + band, map.height)};
        data.bands.push_back({rows, BakeCasts(baker, data.map, data.reference_samples, rows.first,
                                              rows.last, ignored)});
    }
}

BakeBenchmark::~BakeBenchmark() = default;

BakeMeasurement BakeBenchmark::measure(const BakeSampling& way,
                                       std::span<const NormalMapFormat> formats) const {
    const Implementation& data = *implementation_;
    const BakeMapOptions map = data.map_by(way);
    BakeMeasurement trial;
    trial.code_seconds.resize(formats.size());
    std::vector<CheckSums> sums(formats.size());
    Report ignored;
    for (const Band& part : data.bands) {
        CastRows made;
        trial.cast_seconds += seconds_of(
            [&] { made = cast_rows(data.baker, map, part.rows.first, part.rows.last, ignored); });
        trial.rays += made.rays;
        std::vector<float> degrees(data.texels_of(part.rows));
        for (std::size_t f = 0; f < formats.size(); ++f) {
            std::vector<float> rebaked;
            trial.code_seconds[f] +=
                seconds_of([&] { rebaked = coded(made.normals, map.width, formats[f]); });
            sums[f].add(compare_rows(data.baker, map, part.casts, made, rebaked, {},
                                     part.rows.first, 0, degrees));
        }
    }
    for (const CheckSums& sum : sums) {
        trial.errors.push_back(sum.error.summary());
        const auto codes = static_cast<std::size_t>(BakeStage::quantization);
        trial.quantization.push_back(sum.stages[codes].summary());
        trial.center.push_back(sum.center.summary());
    }
    if (!sums.empty()) {
        const auto samples = static_cast<std::size_t>(BakeStage::sampling);
        trial.sampling = sums.front().stages[samples].summary();
    }
    return trial;
}

Image BakeBenchmark::error_map(const BakeSampling& way, const NormalMapFormat& format) const {
    const Implementation& data = *implementation_;
    const BakeMapOptions map = data.map_by(way);
    Image errors =
        make_image(map.width, static_cast<int>(texels()) / map.width, 1, 32, ColorSpace::data);
    std::span<float> left = errors.as<float>();
    Report ignored;
    for (const Band& part : data.bands) {
        const CastRows made = cast_rows(data.baker, map, part.rows.first, part.rows.last, ignored);
        const std::vector<float> rebaked = coded(made.normals, map.width, format);
        const std::span<float> rows = left.first(data.texels_of(part.rows));
        compare_rows(data.baker, map, part.casts, made, rebaked, {}, part.rows.first, 0, rows);
        left = left.subspan(rows.size());
    }
    return errors;
}

std::size_t BakeBenchmark::texels() const {
    std::size_t sum = 0;
    for (const Band& part : implementation_->bands)
        sum += implementation_->texels_of(part.rows);
    return sum;
}

bool BakeBenchmark::is_whole() const {
    return implementation_->is_whole;
}

int BakeBenchmark::reference_samples() const {
    return implementation_->reference_samples;
}

std::size_t BakeBenchmark::reference_rays() const {
    std::size_t sum = 0;
    for (const Band& part : implementation_->bands)
        sum += part.casts.reference.rays;
    return sum;
}

std::span<const BakeSampling> default_bake_samplings() {
    static const std::array<BakeSampling, 7> ways = {
        {{1, {}}, {4, {}}, {16, {}}, {64, {}}, {16, 8.0}, {16, 2.0}, {16, 0.5}}};
    return ways;
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

std::vector<TimedBakeMeasurement> measure_interleaved(const BakeBenchmark& trials,
                                                      std::span<const BakeSampling> ways,
                                                      std::span<const NormalMapFormat> formats,
                                                      const Repeats& repeats) {
    std::vector<TimedBakeMeasurement> results(ways.size());
    interleave(ways.size(), repeats, [&](std::size_t way, bool counted) {
        check_cancelled();
        TimedBakeMeasurement& one = results[way];
        one.trial = trials.measure(ways[way], formats);
        one.seconds.resize(formats.size());
        for (std::size_t f = 0; counted && f < formats.size(); ++f)
            one.seconds[f].push_back(one.trial.cast_seconds + one.trial.code_seconds[f]);
    });
    return results;
}

}  // namespace relief
