// SPDX-License-Identifier: Apache-2.0
// Plain normal maps are made in their place; of others, three codes or two slopes a texel are made
// first, a few rows at a time, and then brought into the form of the file.
// Tests: tests/mesh/io/maps/bump_file_test.cpp.
#include "io/maps/bump_bands.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <type_traits>
#include <vector>

#include "image/bump/bump_rows.h"
#include "image/largest_sample.h"
#include "image/normals/normal_coding.h"
#include "parallel.h"

namespace relief {
namespace {

/// A sample of any depth, 1.0 being white.
double value_at(const void* row, int bits, std::size_t x) {
    if (bits == 8) return static_cast<const std::uint8_t*>(row)[x] / largest_sample<std::uint8_t>;
    if (bits == 16)
        return static_cast<const std::uint16_t*>(row)[x] / largest_sample<std::uint16_t>;
    return static_cast<double>(static_cast<const float*>(row)[x]);
}

/// Stores numbers from 0 to 1, and counts those that are not.
template <typename Sample>
class UnitCoding {
  public:
    UnitCoding(const char* kind, Report& found) : kind_(kind), found_(found) {}

    Sample operator()(double value, std::size_t texel) {
        if constexpr (std::is_same_v<Sample, float>) return static_cast<float>(value);
        // Written so that NaN is outside.
        if (!(value >= 0.0 && value <= 1.0)) {
            found_.add(kind_, "texel", texel, "is written as the nearest of 0 and 1");
            value = value > 1.0 ? 1.0 : 0.0;
        }
        return static_cast<Sample>(value * largest_sample<Sample> + 0.5);
    }

  private:
    const char* kind_;
    Report& found_;
};

/// Makes pieces of a band.
class BandMaker {
  public:
    BandMaker(const BumpBandSource& source, const BumpOptions& options,
              const BumpFileFormat& format)
        : source_(source),
          options_(options),
          format_(format),
          shape_(shape_of(format, source.heights.width, source.heights.height)) {}

    bool make(int first, int last, std::byte* rows, Report& found) const {
        if (format_.content == BumpContent::slope_moments)
            return make_moments(first, last, reinterpret_cast<float*>(rows));
        if (shape_.bits == 8) return make_normals<std::uint8_t>(first, last, rows, found);
        if (shape_.bits == 16) return make_normals<std::uint16_t>(first, last, rows, found);
        return make_normals<float>(first, last, rows, found);
    }

  private:
    [[nodiscard]] std::size_t width() const {
        return static_cast<std::size_t>(source_.heights.width);
    }

    template <typename Sample>
    bool make_normals(int first, int last, std::byte* rows, Report& found) const {
        auto* const samples = reinterpret_cast<Sample*>(rows);
        const bool is_plain = shape_.channels == 3 && !format_.xy_only && !source_.transparent;
        std::vector<Sample> scratch;
        if (!is_plain) scratch.resize(width() * 3 * static_cast<std::size_t>(last - first));
        Sample* const codes = is_plain ? samples : scratch.data();
        const BumpTarget target{
            BumpResult::codes, format_.normals,
            [&](int row) { return codes + static_cast<std::size_t>(row - first) * 3 * width(); }};
        if (!make_bump_rows(source_.heights, options_, target, first, last)) return false;
        if (is_plain) return true;
        const std::size_t row_size = width() * static_cast<std::size_t>(shape_.channels);
        for (int row = first; row < last; ++row) {
            const auto index = static_cast<std::size_t>(row - first);
            form_row(row, codes + index * 3 * width(), samples + index * row_size, found);
        }
        return true;
    }

    /// Three codes a texel to the samples of the file.
    template <typename Sample>
    void form_row(int row, Sample* codes, Sample* samples, Report& found) const {
        if (source_.transparent) flatten(source_.transparent(row), codes);
        const auto channels = static_cast<std::size_t>(shape_.channels);
        for (std::size_t x = 0; x < width(); ++x) {
            Sample* const texel = samples + x * channels;
            texel[0] = codes[3 * x];
            texel[1] = codes[3 * x + 1];
            texel[2] = format_.xy_only ? Sample{} : codes[3 * x + 2];
        }
        if (format_.alpha == MapAlpha::height) add_height(row, samples, found);
        if (format_.alpha == MapAlpha::keep) add_alpha(row, samples, found);
    }

    template <typename Sample>
    void flatten(const std::uint8_t* transparent, Sample* codes) const {
        const NormalCoding<Sample> coding{format_.normals.flat};
        const Sample zero = coding.encoded(0.0);
        const Sample one = coding.encoded(1.0);
        for (std::size_t x = 0; x < width(); ++x) {
            if (transparent[x] == 0) continue;
            codes[3 * x] = codes[3 * x + 1] = zero;
            codes[3 * x + 2] = one;
        }
    }

    template <typename Sample>
    void add_height(int row, Sample* samples, Report& found) const {
        const void* const heights = source_.heights.row(row);
        UnitCoding<Sample> coded("height outside 0 to 1", found);
        for (std::size_t x = 0; x < width(); ++x) {
            const double height = value_at(heights, source_.heights.bits, x);
            const double kept = options_.strength < 0.0 ? 1.0 - height : height;
            samples[4 * x + 3] = coded(kept, static_cast<std::size_t>(row) * width() + x);
        }
    }

    template <typename Sample>
    void add_alpha(int row, Sample* samples, Report& found) const {
        const void* const alpha = source_.alpha ? source_.alpha(row) : nullptr;
        UnitCoding<Sample> coded("alpha outside 0 to 1", found);
        for (std::size_t x = 0; x < width(); ++x) {
            const double value = alpha ? value_at(alpha, source_.alpha_bits, x) : 1.0;
            samples[4 * x + 3] = coded(value, static_cast<std::size_t>(row) * width() + x);
        }
    }

    bool make_moments(int first, int last, float* samples) const {
        const std::size_t row_size = 2 * width();
        std::vector<float> slopes(row_size * static_cast<std::size_t>(last - first));
        const BumpTarget target{BumpResult::slopes, {}, [&](int row) {
                                    return slopes.data() +
                                           static_cast<std::size_t>(row - first) * row_size;
                                }};
        if (!make_bump_rows(source_.heights, options_, target, first, last)) return false;
        const float green = format_.normals.green == Green::up ? 1.0F : -1.0F;
        for (int row = first; row < last; ++row) {
            const void* const heights = source_.heights.row(row);
            const std::uint8_t* const transparent =
                source_.transparent ? source_.transparent(row) : nullptr;
            const float* const slope = static_cast<const float*>(target.row(row));
            for (std::size_t x = 0; x < width(); ++x, samples += 6) {
                const bool is_flat = transparent && transparent[x] != 0;
                const double height = value_at(heights, source_.heights.bits, x);
                const float dx = is_flat ? 0.0F : slope[2 * x];
                const float dy = is_flat ? 0.0F : slope[2 * x + 1] * green;
                samples[0] = static_cast<float>(height * options_.strength);
                samples[1] = dx;
                samples[2] = dy;
                samples[3] = dx * dx;
                samples[4] = dy * dy;
                samples[5] = dx * dy;
            }
        }
        return true;
    }

    const BumpBandSource& source_;
    const BumpOptions& options_;
    const BumpFileFormat& format_;
    ImageShape shape_;
};

}  // namespace

ImageShape shape_of(const BumpFileFormat& format, int width, int height) {
    if (format.content == BumpContent::slope_moments)
        return {width,
                height,
                6,
                32,
                ColorSpace::data,
                {"b0_h", "b1_dhds", "b2_dhdt", "b3_dhds2", "b4_dhdt2", "b5_dh2dsdt"}};
    const int channels = format.alpha == MapAlpha::none ? 3 : 4;
    return {width, height, channels, format.normals.bits, ColorSpace::data, {}};
}

bool make_bump_band(const BumpBandSource& source, const BumpOptions& options,
                    const BumpFileFormat& format, int first, int last, std::span<std::byte> rows,
                    Report& report) {
    const BandMaker maker(source, options, format);
    const auto count = static_cast<std::size_t>(last - first);
    const std::size_t row_bytes = rows.size() / count;
    const std::size_t grain = std::max<std::size_t>(
        1, bump_texels_per_piece / static_cast<std::size_t>(source.heights.width));
    std::atomic<bool> finite = true;
    Report found_here;
    parallel_for_reporting(
        count, grain, found_here, [&](std::size_t begin, std::size_t end, Report& found) {
            if (!maker.make(first + static_cast<int>(begin), first + static_cast<int>(end),
                            rows.data() + begin * row_bytes, found))
                finite = false;
        });
    if (finite) report.merge(found_here);
    return finite;
}

}  // namespace relief
