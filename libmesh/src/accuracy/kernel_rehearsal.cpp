// SPDX-License-Identifier: Apache-2.0
// What a map may have been: where rounding to codes is as good as white noise, and where there is
// noise, its spectrum is subtracted; where steps are wider than texels, they are smoothed away
// (destaircase.h); floats without noise are taken as they are. On that, rounding and noise are done
// anew, for kernels to be measured. Heights in the map's unit, 1.0 white. Bad images throw.
// Tests: tests/mesh/accuracy/kernel_choice_test.cpp.
#include "accuracy/kernel_rehearsal.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>

#include "accuracy/power_spectrum.h"
#include "accuracy/random.h"
#include "geometry/portable_math.h"
#include "image/height_holes.h"
#include "parallel.h"
#include "relief/mesh/destaircase.h"

namespace relief {
namespace {

/// All values in one image: for what does not depend on their places.
Image joined(std::span<const Image> parts) {
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

/// The bits of mantissa that the values use.
int mantissa_bits(const Image& values) {
    unsigned used = 0;
    for (const float value : values.as<float>()) {
        if (std::isfinite(value)) used |= std::bit_cast<std::uint32_t>(value);
    }
    return 24 - std::min(23, std::countr_zero(used));
}

HeightTile tile_of(const Image& part) {
    Image floats = to_float(part);
    Report ignored;  // The conversion counts holes.
    std::vector<float> whole = filled_holes(floats, Wrap::clamp, ignored);
    if (!whole.empty()) floats.samples = std::move(whole);
    const std::span<const float> samples = floats.as<float>();
    return {floats.width, floats.height, Wrap::clamp, {samples.begin(), samples.end()}};
}

Image image_of(const HeightTile& tile) {
    Image image = make_image(tile.width, tile.height, 1, 32, ColorSpace::data);
    std::transform(tile.values.begin(), tile.values.end(), image.as<float>().begin(),
                   [](double value) { return static_cast<float>(value); });
    return image;
}

Image without_steps(const Image& heights, double step) {
    return destaircase(heights, {.wrap = Wrap::clamp, .step = step}).heights;
}

/// Without what smaller than a few texels is left of wide steps: there was none to be seen in them.
/// Twice the binomial (1 4 6 4 1) / 16 less that applied twice, which leaves crests as they are.
HeightTile evened(HeightTile tile) {
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
            squares += coding.error_of(value) * coding.error_of(value);
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

/// A map whose spectrum exceeds that of its grain by less than this, of the grain, is nothing else.
constexpr double min_excess = 0.01;

/// The levels of masks and terraces: few, and farther apart than the codes of the file.
bool has_exact_levels(const HeightDepth& depth, int bits_of_file) {
    constexpr int max_bits = 2;
    if (depth.bits == 0 || depth.bits > max_bits) return false;
    return bits_of_file == 32 || depth.step > 1.5 / (std::ldexp(1.0, bits_of_file) - 1.0);
}

double beyond(double deviation, double rounding) {
    return std::sqrt(std::max(0.0, deviation * deviation - rounding * rounding));
}

/// The strongest noise that a map may have: what even its quietest texels have in each octave.
/// Noise may be blurred, but hardly more than by a binomial over 3 x 3 texels.
///
/// \param quiet  quiet_deviations()
/// \param high   deviation of white noise by the highest frequencies
std::optional<NoiseSpectrum> possible_noise(const QuietDeviations& quiet, double high,
                                            double rounding, int side) {
    // What such a blur leaves in an octave, of the next higher one; at first of `high`.
    static constexpr std::array greatest_rise = {20.0, 3.5, 1.4, 1.1};
    QuietDeviations deviations{};
    double higher = beyond(high, rounding);
    for (std::size_t i = 0; i < deviations.size(); ++i)
        higher = deviations[i] = std::min(beyond(quiet[i], rounding), greatest_rise[i] * higher);
    if (!(deviations[0] > 0.5 * rounding) || deviations.back() == 0.0) return std::nullopt;
    NoiseSpectrum noise;
    noise.side = side;
    noise.rings.clear();
    for (int ring = 0; ring < side; ++ring) {
        const double f = std::clamp(2.0 * std::numbers::pi * ring / side, quiet_frequencies.back(),
                                    quiet_frequencies.front());
        std::size_t i = 0;
        while (i + 2 < deviations.size() && quiet_frequencies[i + 1] > f)
            ++i;
        const double w = portable::log(f / quiet_frequencies[i]) /
                         portable::log(quiet_frequencies[i + 1] / quiet_frequencies[i]);
        const double deviation =
            deviations[i] * portable::pow(deviations[i + 1] / deviations[i], w);
        noise.rings.push_back(deviation * deviation);
    }
    return noise;
}

/// The tiles on the diagonal of nine: enough for quantiles and for differences.
template <typename T>
std::vector<T> some_of(const std::vector<T>& all) {
    std::vector<T> some;
    for (std::size_t i = 0; i < all.size(); i += 4)
        some.push_back(all[i]);
    return some;
}

bool is_flat(const NoiseSpectrum& noise) {
    // Where it is grain for sure: the highest octave.
    const auto begin = noise.rings.begin() + noise.side / 4;
    const auto end = noise.rings.begin() + 5 * noise.side / 8;
    const auto [least, greatest] = std::minmax_element(begin, end);
    return *greatest < 1.6 * *least;
}

struct MeanSquare {
    double sum = 0.0;
    double count = 0.0;
    double max = 0.0;
};

/// Of the angles in radians between float normals and the truth: by the chord, which is as good as
/// an arc tangent for small angles and 1% short at 90 degrees.
///
/// \param margin  texels along the border that are left out
MeanSquare square_error(const Image& normals, std::span<const glm::dvec3> reference, int margin) {
    const std::span<const float> n = normals.as<float>();
    MeanSquare result;
    for (int y = margin; y < normals.height - margin; ++y) {
        for (int x = margin; x < normals.width - margin; ++x) {
            const auto i = static_cast<std::size_t>(y * normals.width + x);
            if (reference[i] == glm::dvec3(0.0)) continue;
            const glm::dvec3 chord =
                glm::dvec3(n[3 * i], n[3 * i + 1], n[3 * i + 2]) - reference[i];
            const double square = glm::dot(chord, chord);
            const double longer = 1.0 + square * (1.0 / 24.0 + square * (3.0 / 640.0));
            result.sum += square * longer * longer;
            result.max = std::max(result.max, square * longer * longer);
            result.count += 1.0;
        }
    }
    return result;
}

}  // namespace

double HeightCoding::error_of(double height) const {
    constexpr double of_rounding = 0.28867513459481287;  // The root of 1/12.
    if (has_exact_levels) return 0.0;
    if (depth.bits > 0) return of_rounding * depth.step;
    if (height == 0.0) return 0.0;
    int exponent = 0;
    std::frexp(height, &exponent);
    return of_rounding * std::ldexp(1.0, exponent - mantissa_bits);
}

void KernelErrorModel::remove_spikes() {
    // Fewer are as well detail, and change little.
    constexpr double min_share = 0.001;
    std::size_t texels = 0;
    const std::vector<HeightTile> as_stored = tiles_;
    for (HeightTile& tile : tiles_) {
        const std::vector<double> found = relief::remove_spikes(tile, 2.5 * coding_.step());
        spikes_.insert(spikes_.end(), found.begin(), found.end());
        texels += tile.values.size();
    }
    spike_share_ = static_cast<double>(spikes_.size()) / static_cast<double>(texels);
    if (spike_share_ >= min_share) return;
    tiles_ = as_stored;
    spikes_.clear();
    spike_share_ = 0.0;
}

void KernelErrorModel::find_grain(Grain grain) {
    const double rounding = root_mean_square_rounding(tiles_, coding_);
    high_ = high_frequencies(tiles_);
    if (have_spectrum(tiles_)) spectrum_.emplace(tiles_);
    white_ = spectrum_ ? std::min(high_.deviation, spectrum_->white_floor()) : high_.deviation;
    // What little there is beyond rounding may as well be detail; and planes that are rounded make
    // patterns.
    const double least = (coding_.step() > 0.0 ? 1.1 : 1.25) * rounding;
    QuietDeviations quiet{};
    if (spectrum_) {
        quiet = quiet_deviations(some_of(tiles_));
        colored_ = spectrum_->grain();
        possible_ = possible_noise(quiet, high_.deviation, rounding, tiles_[0].width);
    }
    // Grain is everywhere. Edges have as much power in a few places: most of the map is smoother
    // than noise of their spectrum would be, and a fifth of its texels tells the deviation.
    constexpr double min_share_of_noise = 0.85;
    const bool is_everywhere =
        high_.deviation > least &&
        (!colored_ || high_.deviation > min_share_of_noise * colored_->high_deviation());
    if (colored_ && (is_flat(*colored_) || !is_everywhere || !(colored_->deviation() > least)))
        colored_.reset();
    // Edges may fill the spectrum, but not the quietest texels. The highest octave does not count,
    // since a blur leaves little in it.
    constexpr double min_fall_of_detail = 1.9;
    if (!colored_ && possible_ && possible_->deviation() > std::max(least, 1.5 * white_) &&
        quiet[1] > 2.0 * rounding && quiet[2] < min_fall_of_detail * quiet[1])
        colored_ = possible_;
    if (colored_)
        grain_ = beyond(colored_->deviation(), rounding);
    else if (high_.is_white && white_ > least)
        grain_ = beyond(white_, rounding);
    if (grain_ == 0.0) return;
    if (spectrum_) {
        const NoiseSpectrum noise = colored_ ? *colored_ : NoiseSpectrum::white(white_);
        is_only_grain_ = spectrum_->excess_over(noise) < min_excess;
    }
    is_as_stored_ = grain == Grain::detail || (grain == Grain::automatic && is_only_grain_);
    if (!is_as_stored_) noise_ = grain_;
}

void KernelErrorModel::restore() {
    if (is_as_stored_) return;
    const double rounding = root_mean_square_rounding(tiles_, coding_);
    const double step = coding_.step();
    // Steps that texels climb one by one or faster leave as much in the highest frequencies as
    // white noise; wider ones next to nothing.
    const bool is_coarse_float = step == 0.0 && coding_.mantissa_bits < 20;
    const double least = step > 0.0 ? 0.3 : is_coarse_float ? 0.0 : 1.25;
    const bool steps_are_wide = step > 0.0 && high_.deviation <= least * rounding;
    const bool by_spectrum =
        colored_ || (spectrum_ && high_.is_white && high_.deviation > least * rounding);
    if (!by_spectrum && step == 0.0) return;
    const NoiseSpectrum noise =
        colored_ ? *colored_ : NoiseSpectrum::white(std::max(white_, rounding));
    parallel_for(tiles_.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (by_spectrum) {
                tiles_[i] = without_noise(tiles_[i], *spectrum_, noise);
                continue;
            }
            tiles_[i] = tile_of(without_steps(image_of(tiles_[i]), step));
            if (!steps_are_wide) continue;
            const HeightTile even = evened(tiles_[i]);
            // What is left of the steps is less than half of one: edges stay.
            for (std::size_t texel = 0; texel < even.values.size(); ++texel) {
                double& value = tiles_[i].values[texel];
                value = std::clamp(even.values[texel], value - 0.5 * step, value + 0.5 * step);
            }
        }
    });
}

/// Rounding, noise and spikes as the map has them, but not the same ones.
Image KernelErrorModel::spoilt(const HeightTile& tile, std::uint32_t seed) const {
    Random random(seed);
    HeightTile result = tile;
    const double step = coding_.step();
    // Codes lie elsewhere: what is left of the old steps must not fit them.
    const double shift = 0.382 * step;
    std::vector<double> noise;
    if (noise_ > 0.0 && colored_) {
        noise = noise_field(*colored_, tile.width, seed);
        const double share = noise_ / colored_->deviation();
        for (double& value : noise)
            value *= share;
    }
    for (std::size_t i = 0; i < result.values.size(); ++i) {
        double& value = result.values[i];
        if (!noise.empty())
            value += noise[i];
        else if (noise_ > 0.0)
            value += noise_ * random.normal();
        if (!spikes_.empty() && random.between(0.0, 1.0) < spike_share_) {
            const double which = random.between(0.0, static_cast<double>(spikes_.size()));
            value += spikes_[std::min(spikes_.size() - 1, static_cast<std::size_t>(which))];
        }
        if (step > 0.0)
            value = step * std::floor((value + shift) / step + 0.5) - shift;
        else
            value += coding_.error_of(value) * random.normal();
    }
    return image_of(result);
}

void KernelErrorModel::spoil() {
    const double step = coding_.step();
    const double min_cliff = std::max(3.0 * step, 6.0 * noise_);
    const glm::dvec2 scale = options_.strength / options_.texel;
    walls_ = 0.0;
    normals_.assign(tiles_.size(), {});
    spoilt_.resize(tiles_.size());
    std::vector<std::size_t> beside(tiles_.size(), 0);
    parallel_for(tiles_.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const TileSlopes reference =
                true_slopes(tiles_[i], min_cliff, coding_.has_exact_levels);
            Random missed(static_cast<std::uint32_t>(i) ^ 0x6d697373U);
            for (std::size_t texel = 0; texel < reference.slopes.size(); ++texel) {
                glm::dvec2 slope = reference.slopes[texel] * scale;
                if (missed_slope_ > 0.0) {
                    const double along_x = missed.normal();
                    slope += scale * missed_slope_ * glm::dvec2(along_x, missed.normal());
                }
                const bool has_none = reference.beside_cliff[texel] != 0;
                normals_[i].push_back(has_none
                                          ? glm::dvec3(0.0)
                                          : glm::normalize(glm::dvec3(-slope.x, slope.y, 1.0)));
                beside[i] += has_none ? 1 : 0;
            }
            spoilt_[i] = spoilt(tiles_[i], static_cast<std::uint32_t>(i));
            if (destaircased_ && step > 0.0) spoilt_[i] = without_steps(spoilt_[i], step);
        }
    });
    double texels = 0.0;
    for (std::size_t i = 0; i < tiles_.size(); ++i) {
        walls_ += static_cast<double>(beside[i]);
        texels += static_cast<double>(normals_[i].size());
    }
    walls_ /= texels;
}

KernelErrorModel::KernelErrorModel(std::span<const Image> parts, const BumpOptions& options,
                                   bool destaircased, Grain grain)
    : options_(options), destaircased_(destaircased) {
    const Image all = joined(parts);
    coding_.depth = height_depth(all);
    if (coding_.depth.bits == 0) coding_.mantissa_bits = mantissa_bits(all);
    coding_.has_exact_levels = has_exact_levels(coding_.depth, parts[0].bits());
    options_.wrap = Wrap::clamp;
    options_.arithmetic = Arithmetic::float64;
    tiles_.resize(parts.size());
    std::transform(parts.begin(), parts.end(), tiles_.begin(), tile_of);
    remove_spikes();
    find_grain(grain);
    restore();
    spoil();
}

KernelPrediction KernelErrorModel::predict_upper(const KernelPrediction& shown) const {
    if (!spectrum_ || coding_.has_exact_levels) return shown;
    KernelErrorModel upper = *this;
    upper.tiles_ = some_of(tiles_);
    upper.normals_ = some_of(normals_);
    upper.spoilt_ = some_of(spoilt_);
    const KernelPrediction lower = upper.predict(shown.kernel, shown.gaussian_radius);
    const double rounding = root_mean_square_rounding(tiles_, coding_);
    NoiseSpectrum noise = NoiseSpectrum::white(rounding);
    if (noise_ > 0.0)
        noise = colored_ ? *colored_ : NoiseSpectrum::white(std::max(white_, rounding));
    upper.missed_slope_ = spectrum_->missed_slope(noise);
    if (!is_as_stored_ && possible_ && possible_->deviation() > 1.5 * noise_) {
        upper.colored_ = possible_;
        upper.noise_ = possible_->deviation();
    } else if (noise_ > 0.0) {
        const NoiseSpectrum hidden = spectrum_->hidden_detail(noise);
        for (std::size_t i = 0; i < upper.tiles_.size(); ++i) {
            std::vector<double>& values = upper.tiles_[i].values;
            const std::vector<double> detail = noise_field(
                hidden, upper.tiles_[i].width, static_cast<std::uint32_t>(i) ^ 0x68696464U);
            std::transform(detail.begin(), detail.end(), values.begin(), values.begin(),
                           std::plus<>());
        }
    }
    upper.spoil();
    const KernelPrediction some = upper.predict(shown.kernel, shown.gaussian_radius);
    KernelPrediction result = shown;
    const double added = beyond(some.rms_degrees, lower.rms_degrees);
    result.rms_degrees = std::sqrt(result.rms_degrees * result.rms_degrees + added * added);
    result.max_degrees = std::max(result.max_degrees, some.max_degrees);
    return result;
}

KernelPrediction KernelErrorModel::predict(Kernel kernel, int radius) const {
    BumpOptions options = options_;
    options.kernel = kernel;
    options.gaussian_radius = radius;
    std::vector<MeanSquare> of_parts(spoilt_.size());
    parallel_for(spoilt_.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            Report ignored;
            const Image normals = normals_from_height(spoilt_[i], options, ignored);
            // Close to the border of a part, what lies beyond it is guessed.
            const int margin = std::min(normals.width, normals.height) / 8;
            of_parts[i] = square_error(normals, normals_[i], margin);
        }
    });
    MeanSquare all;
    for (const MeanSquare& part : of_parts) {
        all.sum += part.sum;
        all.count += part.count;
        all.max = std::max(all.max, part.max);
    }
    const double radians = all.count > 0.0 ? std::sqrt(all.sum / all.count) : 0.0;
    const double degrees = 180.0 / std::numbers::pi;
    return {kernel, radius, radians * degrees, std::sqrt(all.max) * degrees};
}

}  // namespace relief
