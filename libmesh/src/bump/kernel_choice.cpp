// SPDX-License-Identifier: Apache-2.0
// Selects a kernel by predicted errors, and explains the choice in words. Heights are in the unit
// of the map, where 1.0 is white, and angles are in degrees. Bad images and options throw. Tests:
// tests/mesh/bump/kernel_choice_test.cpp.
//
// The error model restores the map as it may have been before storage, adds the same kinds of
// degradation again, and measures the kernels on the result. Blocks of JPEG and offsets of rows or
// columns are removed first. It then restores the reference in one of three ways. Noise, and
// quantization that behaves like white noise, is removed by spectral subtraction. Quantization
// steps wider than texels are removed by destaircase(). Floats without noise remain unchanged.
#include "relief/mesh/height_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "bump/height_tile.h"
#include "image/height_holes.h"
#include "parallel.h"
#include "portable_math.h"
#include "relief/mesh/report.h"

namespace relief {
using namespace relief::detail;

namespace {

/// The rounding of stored heights.
struct HeightCoding {
    HeightDepth depth;
    int mantissa_bits = 24;  ///< Precision of floats without a step, 11 for half floats.
    /// True for masks and maps of a few terraces, whose levels are exact heights.
    bool has_exact_levels = false;

    /// Returns the quantization step, or 0 if there is none.
    [[nodiscard]] double step() const {
        return depth.bits > 0 && !has_exact_levels ? depth.step : 0.0;
    }
    /// Returns the standard deviation of the rounding error of a height.
    [[nodiscard]] double rounding_deviation(double height) const;
};

/// A reference surface and its degraded version, both from parts of a map.
class KernelErrorModel {
  public:
    /// \param parts  one channel each, all with the same number of bits
    KernelErrorModel(std::span<const Image> parts, const BumpOptions& options, bool destaircased,
                     Grain grain);

    /// Measures the errors of a kernel on the degraded parts.
    [[nodiscard]] KernelPrediction predict(Kernel kernel, int radius) const;

    /// Estimates the maximum error for properties that the map does not reveal: noise that hides or
    /// resembles detail, and detail smaller than texels. The result is an estimate, not a bound.
    ///
    /// \param prediction  the result of predict()
    [[nodiscard]] KernelPrediction predict_upper(const KernelPrediction& prediction) const;

    [[nodiscard]] const HeightCoding& coding() const { return coding_; }
    /// Returns true if the map was stored as JPEG.
    [[nodiscard]] bool has_blocks() const { return blocks_.has_value(); }
    /// Returns the standard deviation of the noise without rounding.
    [[nodiscard]] double noise() const { return stored_is_reference_ ? 0.0 : grain(); }
    /// Returns the standard deviation of the grain, whether it counts as noise or as detail.
    [[nodiscard]] double grain() const {
        return std::sqrt(grain_ * grain_ + lines_.rows * lines_.rows +
                         lines_.columns * lines_.columns);
    }
    /// Returns true if the map contains almost nothing but grain.
    [[nodiscard]] bool is_only_grain() const { return is_only_grain_; }
    /// Returns the share of isolated outliers.
    [[nodiscard]] double outlier_share() const { return outlier_share_; }
    /// Returns the share of texels beside a step edge. They have no reference normal.
    [[nodiscard]] double edge_share() const { return edge_share_; }

  private:
    void remove_blocks();
    void remove_outliers();
    void detect_grain(Grain grain);
    void restore();
    void add_line_noise(HeightTile& tile, Random& random) const;
    [[nodiscard]] Image degraded(const HeightTile& tile, std::uint32_t seed) const;
    void degrade();

    BumpOptions options_;
    bool destaircased_ = false;
    HeightCoding coding_;
    std::vector<HeightTile> tiles_;  ///< The parts, which restore() turns into the reference.
    std::optional<BlockQuantization> blocks_;  ///< Of maps that were stored as JPEG.
    LineNoise lines_;
    double grain_ = 0.0;  ///< Without offsets of lines.
    double noise_ = 0.0;  ///< Like `grain_`; 0 if grain counts as detail.
    std::optional<NoiseByHeight> noise_by_height_;
    bool is_only_grain_ = false;
    bool stored_is_reference_ = false;  ///< True if grain counts as detail.
    std::optional<PowerSpectrum> spectrum_;
    std::optional<NoiseSpectrum> colored_noise_;  ///< Noise and rounding, if they are not white.
    std::optional<NoiseSpectrum> max_noise_;      ///< The strongest noise that the map allows.
    double unresolved_slope_ = 0.0;               ///< RMS slope that texels do not resolve.
    HighPassNoise high_pass_;
    double white_deviation_ = 0.0;  ///< Standard deviation of white noise and rounding.
    double outlier_share_ = 0.0;
    std::vector<double> outliers_;  ///< The heights of the outliers.
    double edge_share_ = 0.0;
    std::vector<std::vector<glm::dvec3>> reference_normals_;  ///< 0 beside step edges.
    std::vector<Image> degraded_;
};

/// Returns the values of all parts in one image, for statistics that do not depend on positions.
Image concatenated(std::span<const Image> parts) {
    return std::visit(
        [&](const auto& first) {
            using Samples = std::remove_cvref_t<decltype(first)>;
            Samples all;
            for (const Image& part : parts) {
                const auto& samples = std::get<Samples>(part.samples);
                all.insert(all.end(), samples.begin(), samples.end());
            }
            Image image{static_cast<int>(all.size()), 1, 1, ColorSpace::data, {}};
            image.samples = std::move(all);
            return image;
        },
        parts[0].samples);
}

/// Returns the number of mantissa bits that the values use.
int mantissa_bits(const Image& values) {
    unsigned used = 0;
    for (const float value : values.as<float>()) {
        if (std::isfinite(value)) used |= std::bit_cast<std::uint32_t>(value);
    }
    return 24 - std::min(23, std::countr_zero(used));
}

HeightTile to_tile(const Image& part) {
    Image floats = to_float(part);
    Report ignored;  // The conversion itself reports the holes.
    std::vector<float> filled = filled_holes(floats, Wrap::clamp, ignored);
    if (!filled.empty()) floats.samples = std::move(filled);
    const std::span<const float> samples = floats.as<float>();
    return {floats.width, floats.height, Wrap::clamp, {samples.begin(), samples.end()}};
}

Image to_image(const HeightTile& tile) {
    Image image = make_image(tile.width, tile.height, 1, 32, ColorSpace::data);
    std::transform(tile.values.begin(), tile.values.end(), image.as<float>().begin(),
                   [](double value) { return static_cast<float>(value); });
    return image;
}

Image remove_steps(const Image& heights, double step) {
    return destaircase(heights, {.wrap = Wrap::clamp, .step = step}).heights;
}

/// Removes details of a few texels, which are remainders of wide quantization steps. If B is the
/// binomial filter (1 4 6 4 1) / 16, the filter is 2 B - B^2, which preserves crests.
HeightTile smoothed(HeightTile tile) {
    static constexpr std::array weights = {122.0 / 256, 72.0 / 256, 4.0 / 256, -8.0 / 256,
                                           -1.0 / 256};
    for (const int spacing : {1, 2})
        tile = filtered(tile, weights, spacing);
    return tile;
}

double root_mean_square_rounding(std::span<const HeightTile> tiles, const HeightCoding& coding) {
    double squares = 0.0;
    double count = 0.0;
    for (const HeightTile& tile : tiles) {
        for (const double value : tile.values)
            squares += coding.rounding_deviation(value) * coding.rounding_deviation(value);
        count += static_cast<double>(tile.values.size());
    }
    return std::sqrt(squares / count);
}

bool have_spectrum(std::span<const HeightTile> tiles) {
    return std::all_of(tiles.begin(), tiles.end(), [&](const HeightTile& tile) {
        return tile.width == tile.height && tile.width == tiles[0].width && tile.width >= 8 &&
               std::has_single_bit(static_cast<unsigned>(tile.width));
    });
}

/// Limit of the relative excess of the power over that of the grain in a map of only grain.
constexpr double max_grain_excess = 0.01;

/// Returns true for masks and terraces, whose few levels are farther apart than the codes.
bool has_exact_levels(const HeightDepth& depth, int bits_of_file) {
    constexpr int max_bits = 2;
    if (depth.bits == 0 || depth.bits > max_bits) return false;
    return bits_of_file == 32 || depth.step > 1.5 / (std::ldexp(1.0, bits_of_file) - 1.0);
}

/// Returns the standard deviation of the remainder, if independent rounding is part of `deviation`.
double quadrature_difference(double deviation, double rounding) {
    return std::sqrt(std::max(0.0, deviation * deviation - rounding * rounding));
}

/// Estimates the strongest noise that a map allows from the quantiles of its octave bands. The
/// noise may be blurred, but not much more than by a binomial filter of 3 x 3 texels. Returns
/// nullopt if there is no noise.
///
/// \param octaves  octave_deviations()
/// \param high  deviation of white noise from the highest frequencies
std::optional<NoiseSpectrum> max_noise(const OctaveDeviations& octaves, double high,
                                       double rounding, int side) {
    // The maximum ratio of such noise in an octave to the next higher one, at first to `high`.
    static constexpr std::array max_ratios = {20.0, 3.5, 1.4, 1.1};
    OctaveDeviations deviations{};
    double max_deviation = quadrature_difference(high, rounding);
    for (std::size_t i = 0; i < deviations.size(); ++i)
        max_deviation = deviations[i] =
            std::min(quadrature_difference(octaves[i], rounding), max_ratios[i] * max_deviation);
    if (!(deviations[0] > 0.5 * rounding) || deviations.back() == 0.0) return std::nullopt;
    NoiseSpectrum noise;
    noise.side = side;
    noise.rings.clear();
    for (int ring = 0; ring < side; ++ring) {
        const double f = std::clamp(2.0 * std::numbers::pi * ring / side, octave_frequencies.back(),
                                    octave_frequencies.front());
        std::size_t i = 0;
        while (i + 2 < deviations.size() && octave_frequencies[i + 1] > f)
            ++i;
        const double w = portable::log(f / octave_frequencies[i]) /
                         portable::log(octave_frequencies[i + 1] / octave_frequencies[i]);
        const double deviation =
            deviations[i] * portable::pow(deviations[i + 1] / deviations[i], w);
        noise.rings.push_back(deviation * deviation);
    }
    return noise;
}

/// Returns every fourth element: the diagonal of 3 x 3 tiles, which suffices for quantiles and for
/// differences.
template <typename T>
std::vector<T> every_fourth(const std::vector<T>& all) {
    std::vector<T> result;
    for (std::size_t i = 0; i < all.size(); i += 4)
        result.push_back(all[i]);
    return result;
}

/// Returns true if the noise is white in the highest octave, which consists of grain.
bool is_flat(const NoiseSpectrum& noise) {
    const auto begin = noise.rings.begin() + noise.side / 4;
    const auto end = noise.rings.begin() + 5 * noise.side / 8;
    const auto [min, max] = std::minmax_element(begin, end);
    return *max < 1.6 * *min;
}

/// Returns true if the noise is in all parts of the map. Edges can have the same power spectrum,
/// but most of the map is smoother than noise of that spectrum, which a quantile of the texels
/// shows.
///
/// \param octaves  octave_deviations() of the map
bool is_stationary(const NoiseSpectrum& noise, const OctaveDeviations& octaves, double rounding) {
    constexpr double min_ratio = 0.85;
    const OctaveDeviations expected = noise.octave_deviations();
    // Lower octaves contain other detail, and rounding hides blurred noise in the highest ones.
    for (std::size_t i = 0; i < octaves.size(); ++i) {
        if (expected[i] > 2.0 * rounding) return octaves[i] > min_ratio * expected[i];
    }
    return false;
}

/// Returns the root of the mean square of the deviations at all heights of the tiles.
double mean_deviation(const NoiseByHeight& noise, std::span<const HeightTile> tiles) {
    double squares = 0.0;
    double count = 0.0;
    for (const HeightTile& tile : tiles) {
        for (const double height : tile.values)
            squares += noise.at(height) * noise.at(height);
        count += static_cast<double>(tile.values.size());
    }
    return std::sqrt(squares / count);
}

/// Statistics of squared angles in radians.
class SquaredAngles {
  public:
    void add(double square) {
        sum_ += square;
        sum_of_angles_ += std::sqrt(square);
        max_ = std::max(max_, square);
        count_ += 1.0;
        if (bins_.empty()) bins_.resize(bin_count, 0);
        ++bins_[bin_of(square)];
    }

    void add(const SquaredAngles& other) {
        sum_ += other.sum_;
        sum_of_angles_ += other.sum_of_angles_;
        max_ = std::max(max_, other.max_);
        count_ += other.count_;
        if (bins_.empty()) bins_.resize(bin_count, 0);
        for (std::size_t i = 0; i < other.bins_.size(); ++i)
            bins_[i] += other.bins_[i];
    }

    [[nodiscard]] KernelPrediction prediction(Kernel kernel, int radius) const {
        constexpr double degrees = 180.0 / std::numbers::pi;
        KernelPrediction result{kernel, radius};
        if (count_ == 0.0) return result;
        result.rms_degrees = std::sqrt(sum_ / count_) * degrees;
        result.max_degrees = std::sqrt(max_) * degrees;
        result.mean_degrees = sum_of_angles_ / count_ * degrees;
        result.p99_degrees = std::sqrt(percentile_99()) * degrees;
        return result;
    }

  private:
    // The bins are those of the upper bits of a float: its exponent and 5 bits of its mantissa.
    static constexpr int shift = 18;
    static constexpr std::uint32_t lowest = std::bit_cast<std::uint32_t>(0x1p-60F) >> shift;
    static constexpr std::size_t bin_count =
        (std::bit_cast<std::uint32_t>(16.0F) >> shift) - lowest + 1;

    static std::size_t bin_of(double square) {
        const std::uint32_t bits = std::bit_cast<std::uint32_t>(static_cast<float>(square));
        return std::clamp<std::size_t>(bits >> shift, lowest, lowest + bin_count - 1) - lowest;
    }

    /// Returns the upper end of the bin in which the smallest 99 % end.
    [[nodiscard]] double percentile_99() const {
        double count = 0.0;
        for (std::size_t i = 0; i < bins_.size(); ++i) {
            count += bins_[i];
            if (count < 0.99 * count_) continue;
            const auto next = static_cast<std::uint32_t>(lowest + i + 1) << shift;
            return std::min<double>(std::bit_cast<float>(next), max_);
        }
        return max_;
    }

    double sum_ = 0.0;
    double sum_of_angles_ = 0.0;
    double max_ = 0.0;
    double count_ = 0.0;
    std::vector<std::uint32_t> bins_;
};

/// Sums the squared angles between float normals and the reference. A series of the chord length
/// approximates the angle; it is exact for small angles and 1% too small at 90 degrees.
///
/// \param margin  texels along the border to exclude
SquaredAngles squared_angles(const Image& normals, std::span<const glm::dvec3> reference,
                             int margin) {
    const std::span<const float> n = normals.as<float>();
    SquaredAngles result;
    for (int y = margin; y < normals.height - margin; ++y) {
        for (int x = margin; x < normals.width - margin; ++x) {
            const auto i = static_cast<std::size_t>(y * normals.width + x);
            if (reference[i] == glm::dvec3(0.0)) continue;
            const glm::dvec3 chord =
                glm::dvec3(n[3 * i], n[3 * i + 1], n[3 * i + 2]) - reference[i];
            const double square = glm::dot(chord, chord);
            const double angle_per_chord = 1.0 + square * (1.0 / 24.0 + square * (3.0 / 640.0));
            result.add(square * angle_per_chord * angle_per_chord);
        }
    }
    return result;
}

double HeightCoding::rounding_deviation(double height) const {
    constexpr double of_rounding = 0.28867513459481287;  // The square root of 1/12.
    if (has_exact_levels) return 0.0;
    if (depth.bits > 0) return of_rounding * depth.step;
    if (height == 0.0) return 0.0;
    int exponent = 0;
    std::frexp(height, &exponent);
    return of_rounding * std::ldexp(1.0, exponent - mantissa_bits);
}

void KernelErrorModel::remove_blocks() {
    constexpr int bits_of_jpeg = 8;
    if (coding_.depth.bits != bits_of_jpeg || coding_.step() == 0.0) return;
    blocks_ = block_quantization(tiles_, coding_.step());
    if (!blocks_) return;
    for (HeightTile& tile : tiles_)
        detail::remove_blocks(tile, *blocks_);
}

void KernelErrorModel::remove_outliers() {
    // A smaller share can be detail, and has little effect.
    constexpr double min_share = 0.001;
    std::size_t texels = 0;
    const std::vector<HeightTile> as_stored = tiles_;
    for (HeightTile& tile : tiles_) {
        const std::vector<double> removed = detail::remove_outliers(tile, 2.5 * coding_.step());
        outliers_.insert(outliers_.end(), removed.begin(), removed.end());
        texels += tile.values.size();
    }
    outlier_share_ = static_cast<double>(outliers_.size()) / static_cast<double>(texels);
    if (outlier_share_ >= min_share) return;
    tiles_ = as_stored;
    outliers_.clear();
    outlier_share_ = 0.0;
}

void KernelErrorModel::detect_grain(Grain grain) {
    const double rounding = root_mean_square_rounding(tiles_, coding_);
    if (!coding_.has_exact_levels) lines_ = line_noise(tiles_, rounding);
    if (grain != Grain::detail) {
        for (HeightTile& tile : tiles_)
            remove_line_noise(tile, lines_);
    }
    high_pass_ = high_pass_noise(tiles_);
    if (have_spectrum(tiles_)) spectrum_.emplace(tiles_);
    white_deviation_ =
        spectrum_ ? std::min(high_pass_.deviation, spectrum_->white_floor()) : high_pass_.deviation;
    // A small excess over rounding can be detail. Rounded planes also contain regular patterns.
    const double min_deviation = (coding_.step() > 0.0 ? 1.1 : 1.25) * rounding;
    OctaveDeviations octaves{};
    if (spectrum_) {
        octaves = octave_deviations(every_fourth(tiles_));
        colored_noise_ = spectrum_->blurred_noise(rounding);
        if (!colored_noise_) colored_noise_ = spectrum_->grain();
        max_noise_ = max_noise(octaves, high_pass_.deviation, rounding, tiles_[0].width);
    }
    if (colored_noise_ &&
        (is_flat(*colored_noise_) || !is_stationary(*colored_noise_, octaves, rounding) ||
         !(colored_noise_->deviation() > min_deviation)))
        colored_noise_.reset();
    // Edges can dominate the spectrum, but not the lower quantiles of the octave bands. The highest
    // band is not compared, because a blur removes most of it.
    constexpr double min_detail_ratio = 1.9;
    constexpr double min_low_ratio = 0.6;  // Blurred noise has at least as much power below.
    if (!colored_noise_ && max_noise_ &&
        max_noise_->deviation() > std::max(min_deviation, 1.5 * white_deviation_) &&
        octaves[1] > 2.0 * rounding && octaves[2] < min_detail_ratio * octaves[1] &&
        std::min(octaves[2], octaves[3]) > min_low_ratio * octaves[1])
        colored_noise_ = max_noise_;
    if (colored_noise_)
        grain_ = quadrature_difference(colored_noise_->deviation(), rounding);
    else if (high_pass_.is_white && white_deviation_ > min_deviation &&
             (!spectrum_ || spectrum_->ends_flat())) {
        if (noise_by_height_) white_deviation_ = mean_deviation(*noise_by_height_, tiles_);
        grain_ = quadrature_difference(white_deviation_, rounding);
    }
    if (grain_ == 0.0) {
        stored_is_reference_ = grain == Grain::detail;
        return;
    }
    if (spectrum_) {
        const NoiseSpectrum noise =
            colored_noise_ ? *colored_noise_ : NoiseSpectrum::white(white_deviation_);
        is_only_grain_ = spectrum_->excess_over(noise) < max_grain_excess;
    }
    stored_is_reference_ = grain == Grain::detail || (grain == Grain::automatic && is_only_grain_);
    if (!stored_is_reference_) noise_ = grain_;
}

void KernelErrorModel::restore() {
    if (stored_is_reference_ || (blocks_ && grain_ == 0.0)) return;
    const double rounding = root_mean_square_rounding(tiles_, coding_);
    const double step = coding_.step();
    // Quantization steps of at most one texel width have as much power in the highest frequencies
    // as white noise. Wider steps have almost none.
    const bool is_coarse_float = step == 0.0 && coding_.mantissa_bits < 20;
    const double min_ratio = step > 0.0 ? 0.3 : is_coarse_float ? 0.0 : 1.25;
    const bool steps_are_wide = step > 0.0 && high_pass_.deviation <= min_ratio * rounding;
    const bool use_spectrum = colored_noise_ || (spectrum_ && high_pass_.is_white &&
                                                 high_pass_.deviation > min_ratio * rounding);
    if (!use_spectrum && step == 0.0) return;
    const NoiseSpectrum noise = colored_noise_
                                    ? *colored_noise_
                                    : NoiseSpectrum::white(std::max(white_deviation_, rounding));
    parallel_for(tiles_.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (use_spectrum) {
                tiles_[i] = without_noise(tiles_[i], *spectrum_, noise);
                continue;
            }
            tiles_[i] = to_tile(remove_steps(to_image(tiles_[i]), step));
            if (!steps_are_wide) continue;
            const HeightTile smooth = smoothed(tiles_[i]);
            // The remainders are smaller than half a step, so the limits preserve edges.
            for (std::size_t texel = 0; texel < smooth.values.size(); ++texel) {
                double& value = tiles_[i].values[texel];
                value = std::clamp(smooth.values[texel], value - 0.5 * step, value + 0.5 * step);
            }
        }
    });
}

void KernelErrorModel::add_line_noise(HeightTile& tile, Random& random) const {
    const auto add = [&](double deviation, int lines, int between, int length, int along) {
        for (int line = 0; line < lines && deviation > 0.0; ++line) {
            const double offset = deviation * random.normal();
            for (int i = 0; i < length; ++i)
                tile.values[static_cast<std::size_t>(line * between + i * along)] += offset;
        }
    };
    add(lines_.rows, tile.height, tile.width, tile.width, 1);
    add(lines_.columns, tile.width, 1, tile.height, tile.width);
}

/// Returns a tile with new rounding, noise and outliers of the same distribution as in the map.
Image KernelErrorModel::degraded(const HeightTile& tile, std::uint32_t seed) const {
    Random random(seed);
    HeightTile result = tile;
    const double step = coding_.step();
    // The shift of the codes separates the new steps from remainders of the stored ones.
    const double shift = 0.382 * step;
    std::vector<double> noise;
    if (noise_ > 0.0 && colored_noise_) {
        noise = noise_field(*colored_noise_, tile.width, seed);
        const double share = noise_ / colored_noise_->deviation();
        for (double& value : noise)
            value *= share;
    }
    if (!stored_is_reference_) add_line_noise(result, random);
    for (std::size_t i = 0; i < result.values.size(); ++i) {
        double& value = result.values[i];
        if (!noise.empty())
            value += noise[i];
        else if (noise_ > 0.0 && noise_by_height_)
            value += noise_by_height_->at(value) * random.normal();
        else if (noise_ > 0.0)
            value += noise_ * random.normal();
        if (!outliers_.empty() && random.between(0.0, 1.0) < outlier_share_) {
            const double which = random.between(0.0, static_cast<double>(outliers_.size()));
            value += outliers_[std::min(outliers_.size() - 1, static_cast<std::size_t>(which))];
        }
    }
    if (blocks_) quantize_blocks(result, *blocks_, step);
    for (double& value : result.values) {
        if (step > 0.0)
            value = step * std::floor((value + shift) / step + 0.5) - shift;
        else
            value += coding_.rounding_deviation(value) * random.normal();
    }
    return to_image(result);
}

void KernelErrorModel::degrade() {
    const double step = coding_.step();
    const double min_edge = std::max(3.0 * step, 6.0 * noise());
    const glm::dvec2 scale = options_.strength / options_.texel;
    edge_share_ = 0.0;
    reference_normals_.assign(tiles_.size(), {});
    degraded_.resize(tiles_.size());
    std::vector<std::size_t> beside_edge(tiles_.size(), 0);
    parallel_for(tiles_.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const TileSlopes reference =
                reference_slopes(tiles_[i], min_edge, coding_.has_exact_levels);
            Random random(static_cast<std::uint32_t>(i) ^ 0x6d697373U);
            for (std::size_t texel = 0; texel < reference.slopes.size(); ++texel) {
                glm::dvec2 slope = reference.slopes[texel] * scale;
                if (unresolved_slope_ > 0.0) {
                    const double along_x = random.normal();
                    slope += scale * unresolved_slope_ * glm::dvec2(along_x, random.normal());
                }
                const bool is_beside_edge = reference.beside_edge[texel] != 0;
                reference_normals_[i].push_back(
                    is_beside_edge ? glm::dvec3(0.0)
                                   : glm::normalize(glm::dvec3(-slope.x, slope.y, 1.0)));
                beside_edge[i] += is_beside_edge ? 1 : 0;
            }
            degraded_[i] = degraded(tiles_[i], static_cast<std::uint32_t>(i));
            if (destaircased_ && step > 0.0) degraded_[i] = remove_steps(degraded_[i], step);
        }
    });
    double texels = 0.0;
    for (std::size_t i = 0; i < tiles_.size(); ++i) {
        edge_share_ += static_cast<double>(beside_edge[i]);
        texels += static_cast<double>(reference_normals_[i].size());
    }
    edge_share_ /= texels;
}

KernelErrorModel::KernelErrorModel(std::span<const Image> parts, const BumpOptions& options,
                                   bool destaircased, Grain grain)
    : options_(options), destaircased_(destaircased) {
    const Image all = concatenated(parts);
    coding_.depth = height_depth(all);
    if (coding_.depth.bits == 0) coding_.mantissa_bits = mantissa_bits(all);
    coding_.has_exact_levels = has_exact_levels(coding_.depth, parts[0].bits());
    options_.wrap = Wrap::clamp;
    options_.arithmetic = Arithmetic::float64;
    tiles_.resize(parts.size());
    std::transform(parts.begin(), parts.end(), tiles_.begin(), to_tile);
    remove_blocks();
    noise_by_height_ = detail::noise_by_height(tiles_);
    if (!blocks_ && !noise_by_height_) remove_outliers();
    detect_grain(grain);
    restore();
    degrade();
}

KernelPrediction KernelErrorModel::predict_upper(const KernelPrediction& prediction) const {
    if (!spectrum_ || coding_.has_exact_levels) return prediction;
    KernelErrorModel upper = *this;
    upper.tiles_ = every_fourth(tiles_);
    upper.reference_normals_ = every_fourth(reference_normals_);
    upper.degraded_ = every_fourth(degraded_);
    const KernelPrediction sample = upper.predict(prediction.kernel, prediction.gaussian_radius);
    const double rounding = root_mean_square_rounding(tiles_, coding_);
    NoiseSpectrum noise = NoiseSpectrum::white(rounding);
    if (noise_ > 0.0)
        noise = colored_noise_ ? *colored_noise_
                               : NoiseSpectrum::white(std::max(white_deviation_, rounding));
    upper.unresolved_slope_ = spectrum_->unresolved_slope(noise);
    if (grain() == 0.0 && !stored_is_reference_) {
        // Fine detail can be blurred noise.
        const NoiseSpectrum blurred =
            spectrum_->max_blurred_noise(octave_deviations(every_fourth(tiles_)));
        if (blurred.deviation() > 2.0 * rounding &&
            (!max_noise_ || blurred.deviation() > max_noise_->deviation()))
            upper.max_noise_ = blurred;
    }
    if (!stored_is_reference_ && upper.max_noise_ && upper.max_noise_->deviation() > 1.5 * noise_) {
        upper.colored_noise_ = upper.max_noise_;
        upper.noise_ = upper.max_noise_->deviation();
    } else if (noise_ > 0.0 && !blocks_) {
        const NoiseSpectrum hidden = spectrum_->hidden_detail(noise);
        for (std::size_t i = 0; i < upper.tiles_.size(); ++i) {
            std::vector<double>& values = upper.tiles_[i].values;
            const std::vector<double> detail = noise_field(
                hidden, upper.tiles_[i].width, static_cast<std::uint32_t>(i) ^ 0x68696464U);
            std::transform(detail.begin(), detail.end(), values.begin(), values.begin(),
                           std::plus<>());
        }
    }
    upper.degrade();
    const KernelPrediction upper_sample =
        upper.predict(prediction.kernel, prediction.gaussian_radius);
    KernelPrediction result = prediction;
    for (double KernelPrediction::*error :
         {&KernelPrediction::mean_degrees, &KernelPrediction::rms_degrees,
          &KernelPrediction::p99_degrees}) {
        const double added = quadrature_difference(upper_sample.*error, sample.*error);
        result.*error = std::sqrt(result.*error * result.*error + added * added);
    }
    result.max_degrees = std::max(result.max_degrees, upper_sample.max_degrees);
    return result;
}

KernelPrediction KernelErrorModel::predict(Kernel kernel, int radius) const {
    BumpOptions options = options_;
    options.kernel = kernel;
    options.gaussian_radius = radius;
    std::vector<SquaredAngles> part_errors(degraded_.size());
    parallel_for(degraded_.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            Report ignored;
            const Image normals = normals_from_height(degraded_[i], options, ignored);
            // Close to the border of a part, the kernel reads extrapolated heights.
            const int margin = std::min(normals.width, normals.height) / 8;
            part_errors[i] = squared_angles(normals, reference_normals_[i], margin);
        }
    });
    SquaredAngles all;
    for (const SquaredAngles& part : part_errors)
        all.add(part);
    return all.prediction(kernel, radius);
}

constexpr int radii[] = {1, 2, 3, 4, 5, 6, 7, 8, 10, 12, 14, 16, 20, 24, 28, 32, 40, 48, 56, 64};
/// The kernels are ordered from fast to slow. Forward differences are never the best, because their
/// results are shifted by half a texel.
constexpr Kernel fixed_kernels[] = {Kernel::central3, Kernel::scharr3,  Kernel::sobel3,
                                    Kernel::prewitt3, Kernel::central5, Kernel::central7,
                                    Kernel::sobel5,   Kernel::scharr5};
/// Kernels within this factor of the smallest error are equivalent, and the fastest is selected.
/// The factor is small because the uncertainty of the reference affects all predictions alike.
constexpr double tie_factor = 1.003;

/// Smaller maps contain too little information for an estimate.
constexpr std::size_t min_texels = 64;

std::vector<KernelPrediction> all_predictions(const KernelErrorModel& model) {
    std::vector<KernelPrediction> all;
    for (const Kernel kernel : fixed_kernels)
        all.push_back(model.predict(kernel, 2));
    double min_error = std::numeric_limits<double>::infinity();
    for (const int radius : radii) {
        all.push_back(model.predict(Kernel::gaussian, radius));
        min_error = std::min(min_error, all.back().rms_degrees);
        // Larger radii only increase the error, and none improves on 0. High outliers spread over
        // more texels before the error decreases again.
        const int min_radius = model.outlier_share() > 0.0 ? 16 : 3;
        if (min_error == 0.0 && radius >= 3) break;
        if (radius >= min_radius && all.back().rms_degrees > 1.3 * min_error) break;
    }
    return all;
}

bool has_less_error(const KernelPrediction& a, const KernelPrediction& b) {
    return a.rms_degrees < b.rms_degrees;
}

/// \param all  from fast to slow
KernelPrediction select_best(const std::vector<KernelPrediction>& all) {
    const double min_error = std::min_element(all.begin(), all.end(), has_less_error)->rms_degrees;
    return *std::find_if(all.begin(), all.end(), [min_error](const KernelPrediction& prediction) {
        return prediction.rms_degrees <= tie_factor * min_error;
    });
}

/// Describes the precision of the heights, for example "8 bits used".
std::string coding_text(const HeightCoding& coding) {
    const int bits = coding.depth.bits;
    if (coding.has_exact_levels) return "a few levels, taken for the true heights";
    if (bits > 0) return fmt::format("{} bit{} used", bits, bits == 1 ? "" : "s");
    return coding.mantissa_bits < 20 ? fmt::format("floats of {} bits", coding.mantissa_bits)
                                     : "float heights";
}

/// Explains the choice of the kernel.
std::string reason_text(const KernelErrorModel& model, const BumpOptions& options,
                        const KernelPrediction& best) {
    const GradientKernel kernel = gradient_kernel(best.kernel, best.gaussian_radius);
    const std::string coding =
        coding_text(model.coding()) + (model.has_blocks() ? " in blocks of JPEG" : "");
    // The unit of these heights is a texel, so that their differences are slopes.
    const double texels = std::abs(options.strength) / std::sqrt(options.texel.x * options.texel.y);
    const double step = texels * model.coding().step();
    const double noise = texels * model.noise();
    if (best.rms_degrees == 0.0) return coding + ": level ground, on which every kernel is exact";
    if (model.grain() > 0.0 && model.noise() == 0.0) {
        return fmt::format("{}: grain of {:.2g} texels{} is taken for detail", coding,
                           texels * model.grain(),
                           model.is_only_grain() ? ", and hardly anything else," : "");
    }
    const bool is_noisy = noise > 0.3 * step && noise > 0.0;
    const bool has_outliers = !is_noisy && model.outlier_share() > 0.0;
    const std::string problem = has_outliers
                                    ? fmt::format("isolated outliers ({:.2g}% of the texels)",
                                                  100.0 * model.outlier_share())
                                : is_noisy   ? fmt::format("noise of {:.2g} texels", noise)
                                : step > 0.0 ? fmt::format("steps of {:.2g} texels", step)
                                             : "rounding";
    if (kernel.smoothing.size() > 1) {
        return fmt::format("{}: {} outweigh{} fine detail, so heights are smoothed over {} texels",
                           coding, problem, is_noisy || (step == 0.0 && !has_outliers) ? "s" : "",
                           2 * kernel.smoothing.size() - 1);
    }
    if (model.edge_share() > 0.005 && kernel.radius == 1) {
        return fmt::format(
            "{}: {:.1f}% of the texels are next to sharp walls, so only the next texels are read",
            coding, 100.0 * model.edge_share());
    }
    return fmt::format(
        "{}: detail outweighs {}, so heights are not smoothed, and slopes are of "
        "order {}",
        coding, problem, kernel.order);
}

void check_parts(std::span<const Image> parts) {
    if (parts.empty())
        throw InvalidInput("a kernel is chosen by parts of a map, of which none were given");
    for (const Image& part : parts) {
        if (part.empty()) throw InvalidInput("an empty part of a height map");
        if (part.channels != 1) {
            throw InvalidInput(
                fmt::format("a height field has one channel, not {}", part.channels));
        }
        if (part.bits() != parts[0].bits()) {
            throw InvalidInput(fmt::format("parts of {} and of {} bits are not of one map",
                                           parts[0].bits(), part.bits()));
        }
    }
}

}  // namespace

std::string expected_error_text(const KernelChoice& choice) {
    return choice.is_range()
               ? fmt::format("{:.2g} to {:.2g}", choice.rms_degrees, choice.upper_rms_degrees)
               : fmt::format("{:.2g}", choice.rms_degrees);
}

int best_gaussian_radius(const KernelChoice& choice) {
    // The predictions are sorted by error.
    for (const KernelPrediction& prediction : choice.predictions) {
        if (prediction.kernel == Kernel::gaussian) return prediction.gaussian_radius;
    }
    return choice.gaussian_radius;
}

std::vector<ImagePart> parts_to_analyze(int width, int height) {
    constexpr int max_side = 128;
    constexpr int max_per_axis = 3;
    if (width <= 0 || height <= 0)
        throw InvalidInput(
            fmt::format("the map has {} x {} texels, but needs at least 1 x 1", width, height));
    if (std::min(width, height) < 8) {
        constexpr int max_length = max_side * max_side;
        return {{0, 0, std::min(width, max_length), std::min(height, max_length)}};
    }
    const int smallest = std::min({width, height, max_side});
    const int side = static_cast<int>(std::bit_floor(static_cast<unsigned>(smallest)));
    // Parts that overlap by more than half share their noise, which would then resemble detail.
    const auto count_along = [&](int length) {
        return 2 * length < 3 * side ? 1 : (length - 1) / side + 1;
    };
    // A long and narrow map has the same number of parts.
    int rows = std::min(count_along(height), max_per_axis);
    const int columns = std::min(count_along(width), max_per_axis * max_per_axis / rows);
    rows = std::min(count_along(height), max_per_axis * max_per_axis / columns);
    const auto offset_along = [side](int i, int count, int length) {
        const std::int64_t max_offset = length - side;
        const std::int64_t offset = std::int64_t{count} * side >= length
                                        ? i * max_offset / std::max(1, count - 1)
                                        : (2 * std::int64_t{i} + 1) * max_offset / (2 * count);
        constexpr int block = 8;  // Parts begin with a block of JPEG.
        return static_cast<int>(offset / block * block);
    };
    std::vector<ImagePart> parts;
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column)
            parts.push_back({offset_along(column, columns, width), offset_along(row, rows, height),
                             side, side});
    }
    return parts;
}

KernelChoice choose_kernel(std::span<const Image> parts, const BumpOptions& options,
                           bool destaircased, Grain grain) {
    check_parts(parts);
    const KernelErrorModel model(parts, options, destaircased, grain);
    KernelChoice choice;
    choice.depth = model.coding().depth;
    choice.noise = model.noise();
    choice.walls = model.edge_share();
    choice.grain = model.grain();
    choice.spikes = model.outlier_share();
    choice.predictions = all_predictions(model);
    const KernelPrediction best = select_best(choice.predictions);
    std::stable_sort(choice.predictions.begin(), choice.predictions.end(), has_less_error);
    choice.kernel = best.kernel;
    choice.gaussian_radius = best.gaussian_radius;
    choice.rms_degrees = best.rms_degrees;
    choice.max_degrees = best.max_degrees;
    choice.mean_degrees = best.mean_degrees;
    choice.p99_degrees = best.p99_degrees;
    choice.reason = reason_text(model, options, best);
    const KernelPrediction upper = model.predict_upper(best);
    choice.upper_rms_degrees = std::max(best.rms_degrees, upper.rms_degrees);
    choice.upper_max_degrees = std::max(best.max_degrees, upper.max_degrees);
    choice.upper_mean_degrees = std::max(best.mean_degrees, upper.mean_degrees);
    choice.upper_p99_degrees = std::max(best.p99_degrees, upper.p99_degrees);
    if (choice.grain > 0.0) {
        const KernelErrorModel other_model(parts, options, destaircased,
                                           choice.noise > 0.0 ? Grain::detail : Grain::noise);
        const KernelPrediction same_kernel = other_model.predict(best.kernel, best.gaussian_radius);
        choice.otherwise = {same_kernel.rms_degrees, select_best(all_predictions(other_model))};
        if (model.is_only_grain() && grain == Grain::automatic) {
            choice.upper_rms_degrees = std::max(choice.upper_rms_degrees, same_kernel.rms_degrees);
            choice.upper_max_degrees = std::max(choice.upper_max_degrees, same_kernel.max_degrees);
            choice.upper_mean_degrees =
                std::max(choice.upper_mean_degrees, same_kernel.mean_degrees);
            choice.upper_p99_degrees = std::max(choice.upper_p99_degrees, same_kernel.p99_degrees);
        }
    }
    std::size_t texels = 0;
    for (const Image& part : parts)
        texels += part.sample_count();
    if (texels < min_texels && choice.rms_degrees > 0.0) {
        choice.rms_degrees = choice.max_degrees = std::numeric_limits<double>::quiet_NaN();
        choice.upper_rms_degrees = choice.upper_max_degrees = choice.rms_degrees;
        choice.mean_degrees = choice.upper_mean_degrees = choice.rms_degrees;
        choice.p99_degrees = choice.upper_p99_degrees = choice.rms_degrees;
        choice.reason = fmt::format("{} texel{} are too few to estimate an error", texels,
                                    texels == 1 ? "" : "s");
    }
    return choice;
}

KernelChoice choose_kernel(const ImageView& height, const BumpOptions& options, bool destaircased,
                           Grain grain) {
    if (height.empty()) throw InvalidInput("the height field is empty");
    std::vector<Image> parts;
    for (const ImagePart& part : parts_to_analyze(height.width, height.height))
        parts.push_back(part_of(height, part));
    return choose_kernel(parts, options, destaircased, grain);
}

}  // namespace relief
