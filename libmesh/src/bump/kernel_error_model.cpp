// SPDX-License-Identifier: Apache-2.0
// Nothing throws. Tests: tests/mesh/bump/kernel_choice_test.cpp.
#include "bump/kernel_error_model.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <numeric>

#include "bump/bump_rows.h"
#include "bump/tile_loops.h"
#include "image/height_holes.h"
#include "parallel.h"
#include "relief/mesh/report.h"

namespace relief::detail {
namespace {

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

/// Returns true for masks and terraces, whose few levels are farther apart than the codes.
bool has_exact_levels(const HeightDepth& depth, int bits_of_file) {
    constexpr int max_bits = 2;
    if (depth.bits == 0 || depth.bits > max_bits) return false;
    return bits_of_file == 32 || depth.step > 1.5 / (std::ldexp(1.0, bits_of_file) - 1.0);
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
    if (coding.depth.bits > 0) return coding.rounding_deviation(0.0);
    double squares = 0.0;
    double count = 0.0;
    for (const HeightTile& tile : tiles) {
        for (const double value : tile.values) {
            const double deviation = coding.rounding_deviation(value);
            squares += deviation * deviation;
        }
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

/// Statistics of angles in radians.
class AngleStatistics {
  public:
    AngleStatistics() : bins_(bin_count, 0) {}

    /// Adds the angles at which a weight is positive.
    void add(std::span<const double> angles, std::span<const double> squares,
             const double* weights) {
        // The lanes of the sums need not wait for each other.
        for (std::size_t i = 0; i < angles.size(); ++i) {
            if (!(weights[i] > 0.0)) continue;
            const std::size_t lane = i % lanes;
            sums_[lane] += squares[i];
            sums_of_angles_[lane] += angles[i];
            max_[lane] = std::max(max_[lane], squares[i]);
            ++bins_[bin_of(squares[i])];
        }
    }

    void add(const AngleStatistics& other) {
        for (std::size_t lane = 0; lane < lanes; ++lane) {
            sums_[lane] += other.sums_[lane];
            sums_of_angles_[lane] += other.sums_of_angles_[lane];
            max_[lane] = std::max(max_[lane], other.max_[lane]);
        }
        for (std::size_t i = 0; i < other.bins_.size(); ++i)
            bins_[i] += other.bins_[i];
    }

    [[nodiscard]] KernelPrediction prediction(Kernel kernel, int radius) const {
        constexpr double degrees = 180.0 / std::numbers::pi;
        KernelPrediction result{kernel, radius};
        const double count = std::accumulate(bins_.begin(), bins_.end(), 0.0);
        if (count == 0.0) return result;
        const double max = *std::max_element(max_.begin(), max_.end());
        const auto mean = [count](const std::array<double, lanes>& sums) {
            return std::accumulate(sums.begin(), sums.end(), 0.0) / count;
        };
        result.rms_degrees = std::sqrt(mean(sums_)) * degrees;
        result.max_degrees = std::sqrt(max) * degrees;
        result.mean_degrees = mean(sums_of_angles_) * degrees;
        result.p99_degrees = std::sqrt(percentile_99(count, max)) * degrees;
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
    [[nodiscard]] double percentile_99(double all, double max) const {
        double count = 0.0;
        for (std::size_t i = 0; i < bins_.size(); ++i) {
            count += bins_[i];
            if (count < 0.99 * all) continue;
            const auto next = static_cast<std::uint32_t>(lowest + i + 1) << shift;
            return std::min<double>(std::bit_cast<float>(next), max);
        }
        return max;
    }

    static constexpr std::size_t lanes = 4;
    std::array<double, lanes> sums_{};
    std::array<double, lanes> sums_of_angles_{};
    std::array<double, lanes> max_{};
    std::vector<std::uint32_t> bins_;
};

/// Measures the angles between the normals of a kernel and the reference, without the border of a
/// part.
class PartErrors {
  public:
    /// \param options  with the kernel
    PartErrors(const Image& part, const ReferenceNormals& reference, const BumpOptions& options,
               int margin)
        : part_(part), reference_(reference), options_(options), margin_(margin) {}

    [[nodiscard]] AngleStatistics measured() {
        const GradientKernel kernel = gradient_kernel(*options_.kernel, options_.gaussian_radius);
        // Close to the border, a kernel reads extrapolated heights.
        if (kernel.radius > margin_)
            measure_extrapolated();
        else
            measure_inside(kernel);
        return std::move(all_);
    }

  private:
    [[nodiscard]] std::size_t texel_at(int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(part_.width) +
               static_cast<std::size_t>(margin_);
    }

    void measure_inside(const GradientKernel& kernel) {
        const VectorTarget target = best_vector_target();
        const KernelWeights<double> weights(kernel);
        const glm::dvec2 scale = options_.strength / (kernel.divisor * options_.texel);
        const auto reach = static_cast<std::size_t>(kernel.radius);
        const auto count = static_cast<std::size_t>(part_.width - 2 * margin_);
        const float* const heights = part_.as<float>().data();
        RowsAround<float> rows;
        rows.steep.resize(2 * reach + 1);
        std::vector<double> smoothed(count + 2 * reach);
        std::vector<double> rise(smoothed.size());
        std::vector<double> right(count);
        std::vector<double> up(count);
        for (int y = margin_; y < part_.height - margin_; ++y) {
            for (std::size_t k = 0; k < rows.steep.size(); ++k)
                rows.steep[k] = heights + texel_at(y - kernel.radius + static_cast<int>(k)) - reach;
            rows.across = rows.steep;
            combine_rows(target, rows, weights, 0, smoothed.size(), smoothed.data(), rise.data());
            combine_columns(target, weights, smoothed.data() + reach, rise.data() + reach, count,
                            scale.x, scale.y, right.data(), up.data());
            add_row(target, texel_at(y), right, up);
        }
    }

    void measure_extrapolated() {
        const VectorTarget target = best_vector_target();
        Report ignored;
        const Image slopes = slopes_from_height(part_, options_, ignored);
        const std::span<const float> values = slopes.as<float>();
        std::vector<double> right(static_cast<std::size_t>(part_.width - 2 * margin_));
        std::vector<double> up(right.size());
        for (int y = margin_; y < part_.height - margin_; ++y) {
            for (std::size_t i = 0; i < right.size(); ++i) {
                right[i] = values[2 * (texel_at(y) + i)];
                up[i] = values[2 * (texel_at(y) + i) + 1];
            }
            add_row(target, texel_at(y), right, up);
        }
    }

    void add_row(VectorTarget target, std::size_t first, const std::vector<double>& right,
                 const std::vector<double>& up) {
        angles_.resize(right.size());
        squares_.resize(right.size());
        angles_between(
            target, right.data(), up.data(),
            {reference_.x.data() + first, reference_.y.data() + first, reference_.z.data() + first},
            right.size(), angles_.data(), squares_.data());
        all_.add(angles_, squares_, reference_.z.data() + first);
    }

    const Image& part_;
    const ReferenceNormals& reference_;
    const BumpOptions& options_;
    int margin_;
    AngleStatistics all_;
    std::vector<double> angles_;
    std::vector<double> squares_;
};

}  // namespace

HeightCoding coding_of(std::span<const Image> parts) {
    const Image all = concatenated(parts);
    HeightCoding coding;
    coding.depth = height_depth(all);
    if (coding.depth.bits == 0) coding.mantissa_bits = mantissa_bits(all);
    coding.has_exact_levels = has_exact_levels(coding.depth, parts[0].bits());
    return coding;
}

std::optional<NoiseSpectrum> blurred_noise_of(std::span<const Image> parts,
                                              const HeightCoding& coding) {
    constexpr std::size_t many = 9;
    const std::size_t step = parts.size() >= many ? 4 : 1;
    std::vector<HeightTile> tiles;
    for (std::size_t i = 0; i < parts.size(); i += step)
        tiles.push_back(to_tile(parts[i]));
    if (!have_spectrum(tiles) || tiles.front().width < 16) return std::nullopt;
    return widely_blurred_noise(tiles, root_mean_square_rounding(tiles, coding));
}

void KernelErrorModel::remove_blocks() {
    constexpr int bits_of_jpeg = 8;
    if (map_.coding.depth.bits != bits_of_jpeg || map_.coding.step() == 0.0) return;
    map_.blocks = block_quantization(tiles_, map_.coding.step());
    if (!map_.blocks) return;
    for (HeightTile& tile : tiles_)
        detail::remove_blocks(tile, *map_.blocks);
}

void KernelErrorModel::remove_outliers() {
    // A smaller share can be detail, and has little effect.
    constexpr double min_share = 0.001;
    std::size_t texels = 0;
    const std::vector<HeightTile> as_stored = tiles_;
    for (HeightTile& tile : tiles_) {
        const std::vector<double> removed = detail::remove_outliers(tile, 2.5 * map_.coding.step());
        map_.outliers.insert(map_.outliers.end(), removed.begin(), removed.end());
        texels += tile.values.size();
    }
    map_.outlier_share = static_cast<double>(map_.outliers.size()) / static_cast<double>(texels);
    if (map_.outlier_share >= min_share) return;
    tiles_ = as_stored;
    map_.outliers.clear();
    map_.outlier_share = 0.0;
}

void KernelErrorModel::detect_grain() {
    const double rounding = root_mean_square_rounding(tiles_, map_.coding);
    if (!map_.coding.has_exact_levels) map_.lines = line_noise(tiles_, rounding);
    if (map_.lines.rows > 0.0 || map_.lines.columns > 0.0) {
        tiles_with_lines_ = tiles_;
        for (HeightTile& tile : tiles_)
            remove_line_noise(tile, map_.lines);
    }
    noisy_tiles_ = tiles_;
    map_.rounding = rounding;
    map_.high_pass = high_pass_noise(tiles_);
    if (have_spectrum(tiles_)) map_.spectrum.emplace(tiles_);
    map_.white_deviation = map_.spectrum
                               ? std::min(map_.high_pass.deviation, map_.spectrum->white_floor())
                               : map_.high_pass.deviation;
    // A small excess over rounding can be detail. Rounded planes also contain regular patterns.
    const double min_deviation = (map_.coding.step() > 0.0 ? 1.1 : 1.25) * rounding;
    OctaveDeviations octaves{};
    if (map_.spectrum) {
        octaves = octave_deviations(every_fourth(tiles_));
        map_.colored_noise = map_.spectrum->blurred_noise(rounding);
        map_.is_noise_blurred = map_.colored_noise.has_value();
        if (!map_.colored_noise) map_.colored_noise = map_.spectrum->grain();
        map_.max_noise = max_noise(octaves, map_.high_pass.deviation, rounding, tiles_[0].width);
    }
    if (map_.colored_noise &&
        (is_flat(*map_.colored_noise) || !is_stationary(*map_.colored_noise, octaves, rounding) ||
         !(map_.colored_noise->deviation() > min_deviation)))
        map_.colored_noise.reset();
    // Edges can dominate the spectrum, but not the lower quantiles of the octave bands. The highest
    // band is not compared, because a blur removes most of it.
    constexpr double min_detail_ratio = 1.9;
    constexpr double min_low_ratio = 0.6;  // Blurred noise has at least as much power below.
    if (!map_.colored_noise && map_.max_noise &&
        map_.max_noise->deviation() > std::max(min_deviation, 1.5 * map_.white_deviation) &&
        octaves[1] > 2.0 * rounding && octaves[2] < min_detail_ratio * octaves[1] &&
        std::min(octaves[2], octaves[3]) > min_low_ratio * octaves[1]) {
        map_.colored_noise = map_.max_noise;
        map_.is_noise_blurred = true;
    }
    if (!map_.colored_noise) map_.is_noise_blurred = false;
    if (map_.colored_noise)
        map_.grain = quadrature_difference(map_.colored_noise->deviation(), rounding);
    else if (map_.high_pass.is_white && map_.white_deviation > min_deviation &&
             (!map_.spectrum || map_.spectrum->ends_flat())) {
        if (map_.noise_by_height)
            map_.white_deviation = mean_deviation(*map_.noise_by_height, tiles_);
        map_.grain = quadrature_difference(map_.white_deviation, rounding);
    }
    if (map_.grain > 0.0 && map_.spectrum) {
        const NoiseSpectrum noise =
            map_.colored_noise ? *map_.colored_noise : NoiseSpectrum::white(map_.white_deviation);
        map_.is_only_grain = map_.spectrum->excess_over(noise) < max_grain_excess;
    }
}

void KernelErrorModel::interpret(Grain grain) {
    map_.stored_is_reference =
        grain == Grain::detail || (grain == Grain::automatic && map_.is_only_grain);
    map_.noise = map_.stored_is_reference ? 0.0 : map_.grain;
    if (map_.stored_is_reference && !tiles_with_lines_.empty()) tiles_ = tiles_with_lines_;
}

NoiseSpectrum KernelErrorModel::white_noise(double rounding) const {
    double deviation = std::max(map_.white_deviation, rounding);
    // The windows of the spectrum do not weight all heights alike.
    if (map_.noise_by_height && map_.spectrum)
        deviation = std::max(deviation, map_.spectrum->white_floor());
    return NoiseSpectrum::white(deviation);
}

void KernelErrorModel::restore() {
    if (map_.stored_is_reference || (map_.blocks && map_.grain == 0.0)) return;
    const double rounding = root_mean_square_rounding(tiles_, map_.coding);
    const double step = map_.coding.step();
    // Quantization steps of at most one texel width have as much power in the highest frequencies
    // as white noise. Wider steps have almost none.
    const bool is_coarse_float = step == 0.0 && map_.coding.mantissa_bits < 20;
    const double min_ratio = step > 0.0 ? 0.3 : is_coarse_float ? 0.0 : 1.25;
    const bool steps_are_wide = step > 0.0 && map_.high_pass.deviation <= min_ratio * rounding;
    const bool use_spectrum =
        map_.colored_noise || (map_.spectrum && map_.high_pass.is_white &&
                               map_.high_pass.deviation > min_ratio * rounding);
    if (!use_spectrum && step == 0.0) return;
    const NoiseSpectrum noise = map_.colored_noise ? *map_.colored_noise : white_noise(rounding);
    if (use_spectrum) {
        const std::vector<double> gains =
            map_.spectrum->gains_of_extension(map_.spectrum->gains(noise));
        const std::size_t pairs = (tiles_.size() + 1) / 2;
        parallel_for(pairs, 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const std::size_t count = std::min<std::size_t>(2, tiles_.size() - 2 * i);
                remove_noise(std::span(tiles_).subspan(2 * i, count), gains);
            }
        });
        return;
    }
    parallel_for(tiles_.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
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
    add(map_.lines.rows, tile.height, tile.width, tile.width, 1);
    add(map_.lines.columns, tile.width, 1, tile.height, tile.width);
}

/// Returns noise of the same distribution as in the map, for heights that have none. Empty if there
/// is none.
std::vector<double> KernelErrorModel::new_noise(const HeightTile& tile, std::uint32_t seed) const {
    std::vector<double> noise;
    if (!(map_.noise > 0.0)) return noise;
    if (map_.colored_noise) {
        noise = noise_field(*map_.colored_noise, tile.width, seed);
        const double share = map_.noise / map_.colored_noise->deviation();
        for (double& value : noise)
            value *= share;
        return noise;
    }
    noise.resize(tile.values.size());
    random_normals(best_vector_target(), seed, noise.size(), noise.data());
    for (std::size_t i = 0; i < noise.size(); ++i)
        noise[i] *= map_.noise_by_height ? map_.noise_by_height->at(tile.values[i]) : map_.noise;
    return noise;
}

void KernelErrorModel::add_outliers(HeightTile& tile, std::uint32_t seed) const {
    if (map_.outliers.empty()) return;
    Random random(seed);
    for (double& value : tile.values) {
        if (!(random.between(0.0, 1.0) < map_.outlier_share)) continue;
        const double which = random.between(0.0, static_cast<double>(map_.outliers.size()));
        value += map_.outliers[std::min(map_.outliers.size() - 1, static_cast<std::size_t>(which))];
    }
}

/// Returns a tile with new rounding, noise and outliers of the same distribution as in the map.
Image KernelErrorModel::degraded(const HeightTile& tile, std::uint32_t seed) const {
    HeightTile result = tile;
    const double step = map_.coding.step();
    // The shift of the codes separates the new steps from remainders of the stored ones.
    const double shift = 0.382 * step;
    Random random(seed ^ 0x6c696e65U);
    if (!map_.stored_is_reference) add_line_noise(result, random);
    const std::vector<double> noise = new_noise(result, seed);
    for (std::size_t i = 0; i < noise.size(); ++i)
        result.values[i] += noise[i];
    add_outliers(result, seed ^ 0x73706b65U);
    if (map_.blocks) quantize_blocks(result, *map_.blocks, step);
    if (step > 0.0) {
        round_to_steps(best_vector_target(), step, shift, result.values.size(),
                       result.values.data());
    } else {
        for (double& value : result.values)
            value += std::numbers::sqrt3 * map_.coding.rounding_deviation(value) *
                     random.between(-1.0, 1.0);
    }
    return to_image(result);
}

/// Stores the normals of the slopes.
void KernelErrorModel::set_reference(std::size_t part, const TileSlopes& reference) {
    const VectorTarget target = best_vector_target();
    const std::size_t count = reference.right.size();
    const glm::dvec2 scale = map_.options.strength / map_.options.texel;
    std::vector<double> right(count, 0.0);
    std::vector<double> down(count, 0.0);
    if (map_.unresolved_slope > 0.0) {
        const auto seed = static_cast<std::uint32_t>(part) ^ 0x6d697373U;
        random_normals(target, seed, count, right.data());
        random_normals(target, seed ^ 0x80000000U, count, down.data());
    }
    for (std::size_t i = 0; i < count; ++i) {
        right[i] = scale.x * (reference.right[i] + map_.unresolved_slope * right[i]);
        down[i] = scale.y * (reference.down[i] + map_.unresolved_slope * down[i]);
    }
    ReferenceNormals& normals = reference_normals_[part];
    normals.x.resize(count);
    normals.y.resize(count);
    normals.z.resize(count);
    unit_normals(target, right.data(), down.data(), count,
                 {normals.x.data(), normals.y.data(), normals.z.data()});
    for (std::size_t i = 0; i < count; ++i) {
        if (reference.beside_edge[i] != 0) normals.x[i] = normals.y[i] = normals.z[i] = 0.0;
    }
}

void KernelErrorModel::degrade() {
    const double step = map_.coding.step();
    const double min_edge = std::max(3.0 * step, 6.0 * noise());
    map_.edge_share = 0.0;
    reference_normals_.assign(tiles_.size(), {});
    degraded_.resize(tiles_.size());
    std::vector<std::ptrdiff_t> beside_edge(tiles_.size(), 0);
    parallel_for(tiles_.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const TileSlopes reference =
                reference_slopes(tiles_[i], min_edge, map_.coding.has_exact_levels);
            set_reference(i, reference);
            beside_edge[i] =
                std::count(reference.beside_edge.begin(), reference.beside_edge.end(), 1);
            degraded_[i] = degraded(tiles_[i], static_cast<std::uint32_t>(i));
            if (map_.destaircased && step > 0.0) degraded_[i] = remove_steps(degraded_[i], step);
        }
    });
    double texels = 0.0;
    for (std::size_t i = 0; i < tiles_.size(); ++i) {
        map_.edge_share += static_cast<double>(beside_edge[i]);
        texels += static_cast<double>(tiles_[i].values.size());
    }
    map_.edge_share /= texels;
}

KernelErrorModel::KernelErrorModel(std::span<const Image> parts, const HeightCoding& coding,
                                   const BumpOptions& options, bool destaircased, Grain grain) {
    map_.options = options;
    map_.destaircased = destaircased;
    map_.coding = coding;
    map_.options.wrap = Wrap::clamp;
    map_.options.arithmetic = Arithmetic::float64;
    tiles_.resize(parts.size());
    std::transform(parts.begin(), parts.end(), tiles_.begin(), to_tile);
    remove_blocks();
    map_.noise_by_height = detail::noise_by_height(tiles_);
    if (!map_.blocks && !map_.noise_by_height) remove_outliers();
    detect_grain();
    interpret(grain);
    restore();
    degrade();
}

KernelErrorModel KernelErrorModel::interpreted(Grain grain) const {
    KernelErrorModel other(map_);
    other.tiles_ = every_fourth(noisy_tiles_);
    other.tiles_with_lines_ = every_fourth(tiles_with_lines_);
    other.interpret(grain);
    other.restore();
    other.degrade();
    return other;
}

KernelPrediction KernelErrorModel::predict_upper(const KernelPrediction& prediction) const {
    if (!map_.spectrum || map_.coding.has_exact_levels) return prediction;
    KernelErrorModel upper(map_);
    upper.tiles_ = every_fourth(tiles_);
    upper.reference_normals_ = every_fourth(reference_normals_);
    upper.degraded_ = every_fourth(degraded_);
    const KernelPrediction sample = upper.predict(prediction.kernel, prediction.gaussian_radius);
    const double rounding = root_mean_square_rounding(tiles_, map_.coding);
    NoiseSpectrum noise = NoiseSpectrum::white(rounding);
    if (map_.noise > 0.0) noise = map_.colored_noise ? *map_.colored_noise : white_noise(rounding);
    upper.map_.unresolved_slope = map_.spectrum->unresolved_slope(noise);
    if (!is_noisy() && !map_.stored_is_reference) {
        // Fine detail can be blurred noise.
        const NoiseSpectrum blurred =
            map_.spectrum->max_blurred_noise(octave_deviations(every_fourth(tiles_)));
        if (blurred.deviation() > 2.0 * rounding &&
            (!map_.max_noise || blurred.deviation() > map_.max_noise->deviation()))
            upper.map_.max_noise = blurred;
    }
    if (!map_.stored_is_reference && upper.map_.max_noise &&
        upper.map_.max_noise->deviation() > 1.5 * map_.noise) {
        upper.map_.colored_noise = upper.map_.max_noise;
        upper.map_.noise = upper.map_.max_noise->deviation();
    } else if (map_.noise > 0.0 && !map_.blocks) {
        const NoiseSpectrum hidden = map_.spectrum->hidden_detail(noise);
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

double KernelErrorModel::degrees_of_noise(Kernel kernel, int radius,
                                          const NoiseSpectrum& noise) const {
    const glm::dvec2 scale = map_.options.strength / map_.options.texel;
    const double variance =
        slope_variance(gradient_kernel(kernel, radius), noise) * 0.5 * glm::dot(scale, scale);
    double sum = 0.0;
    double count = 0.0;
    for (const ReferenceNormals& normals : reference_normals_) {
        for (const double z : normals.z) {
            // A slope error along the slope turns the normal by z^2, and one across it by z. Large
            // errors reduce the z of the normal themselves.
            const double z2 = z * z;
            sum += z2 * (1.0 + z2) * variance / (1.0 + z2 * variance);
            count += z > 0.0 ? 1.0 : 0.0;
        }
    }
    return count > 0.0 ? std::sqrt(sum / count) * 180.0 / std::numbers::pi : 0.0;
}

KernelPrediction KernelErrorModel::predict(Kernel kernel, int radius, bool of_sample) const {
    BumpOptions options = map_.options;
    options.kernel = kernel;
    options.gaussian_radius = radius;
    // A sample consists of parts on a diagonal, or of two of five blocks.
    const std::size_t step = !(of_sample && has_sample()) ? 1 : degraded_.size() == 4 ? 3 : 4;
    std::vector<AngleStatistics> part_errors((degraded_.size() + step - 1) / step);
    parallel_for(part_errors.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Image& part = degraded_[i * step];
            const int margin = std::min(part.width, part.height) / 8;
            part_errors[i] =
                PartErrors(part, reference_normals_[i * step], options, margin).measured();
        }
    });
    AngleStatistics all;
    for (const AngleStatistics& part : part_errors)
        all.add(part);
    return all.prediction(kernel, radius);
}

}  // namespace relief::detail
