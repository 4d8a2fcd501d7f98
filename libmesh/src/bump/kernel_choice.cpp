// SPDX-License-Identifier: Apache-2.0
// Selects a kernel by predicted errors (kernel_error_model.h), and explains the choice in words.
// Bad images and options throw. Tests: tests/mesh/bump/kernel_choice_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "bump/kernel_error_model.h"
#include "image/texel_loops.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/height_map.h"
#include "relief/mesh/report.h"

namespace relief {
using namespace relief::detail;

namespace {

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

bool has_less_error(const KernelPrediction& a, const KernelPrediction& b) {
    return a.rms_degrees < b.rms_degrees;
}

/// Measures Gaussians of increasing radii on a sample of the parts, until the error increases.
std::vector<KernelPrediction> sampled_gaussians(const KernelErrorModel& model) {
    constexpr std::size_t max_beyond = 3;  ///< Radii beyond that of the smallest error.
    // High outliers spread over more texels before the error decreases again.
    const int min_radius = model.outlier_share() > 0.0 ? 16 : 3;
    std::vector<KernelPrediction> all;
    std::size_t best = 0;
    for (const int radius : radii) {
        all.push_back(model.predict(Kernel::gaussian, radius, true));
        if (has_less_error(all.back(), all[best])) best = all.size() - 1;
        const double min_error = all[best].rms_degrees;
        if (min_error == 0.0 && radius >= 3) break;
        if (radius >= min_radius &&
            (all.back().rms_degrees > 1.3 * min_error || all.size() > best + max_beyond))
            break;
    }
    return all;
}

void scale(KernelPrediction& prediction, double factor) {
    for (double KernelPrediction::*error :
         {&KernelPrediction::mean_degrees, &KernelPrediction::rms_degrees,
          &KernelPrediction::p99_degrees, &KernelPrediction::max_degrees})
        prediction.*error = std::min(180.0, factor * prediction.*error);
}

/// Measures the best Gaussian on all parts, and its neighbors in both directions until the error is
/// clearly larger. The errors of the others change by the factor of the nearest of these.
void measure_best_on_all_parts(const KernelErrorModel& model,
                               std::vector<KernelPrediction>& gaussians) {
    // Parts of different detail can have two minima.
    constexpr double clearly_larger = 1.1;
    const auto measure = [&](KernelPrediction& one) {
        const double of_sample = one.rms_degrees;
        one = model.predict(Kernel::gaussian, one.gaussian_radius);
        return of_sample > 0.0 ? one.rms_degrees / of_sample : 1.0;
    };
    const auto best = std::min_element(gaussians.begin(), gaussians.end(), has_less_error);
    const double factor_of_best = measure(*best);
    const auto measure_from = [&](auto one, auto end) {
        double min_error = best->rms_degrees;
        double factor = factor_of_best;
        for (; one != end; ++one) {
            factor = measure(*one);
            min_error = std::min(min_error, one->rms_degrees);
            if (one->rms_degrees > clearly_larger * min_error) break;
        }
        while (one != end && ++one != end)
            scale(*one, factor);
    };
    measure_from(std::next(best), gaussians.end());
    measure_from(std::make_reverse_iterator(best), gaussians.rend());
}

/// Measures all kernels on a sample of the parts, and those that may be the best on all parts.
std::vector<KernelPrediction> all_predictions(const KernelErrorModel& model) {
    constexpr double max_factor = 1.25;
    std::vector<KernelPrediction> all;
    for (const Kernel kernel : fixed_kernels)
        all.push_back(model.predict(kernel, 2, true));
    std::vector<KernelPrediction> gaussians = sampled_gaussians(model);
    if (model.has_sample()) {
        const auto min_error = [](const std::vector<KernelPrediction>& some) {
            return std::min_element(some.begin(), some.end(), has_less_error)->rms_degrees;
        };
        const double of_gaussians = min_error(gaussians);
        const double limit = max_factor * std::min(min_error(all), of_gaussians);
        for (KernelPrediction& one : all) {
            if (one.rms_degrees <= limit) one = model.predict(one.kernel, one.gaussian_radius);
        }
        if (of_gaussians <= limit) measure_best_on_all_parts(model, gaussians);
    }
    all.insert(all.end(), gaussians.begin(), gaussians.end());
    return all;
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

constexpr std::size_t many_parts = 9;

/// Returns the four corners and the center of 3 x 3 parts. Others are all returned.
std::vector<Image> every_other(std::span<const Image> parts) {
    std::vector<Image> result;
    const std::size_t step = parts.size() == many_parts ? 2 : 1;
    for (std::size_t i = 0; i < parts.size(); i += step)
        result.push_back(parts[i]);
    return result;
}

/// Returns the roughness of a block of a part: the mean of the magnitudes of the second differences
/// along rows and columns, at every other row. Holes do not count.
template <typename Sample>
double roughness_of(const Image& part, const ImagePart& block) {
    const std::ptrdiff_t pitch = part.width;
    const Sample* const first = part.as<Sample>().data() + block.y * pitch + block.x;
    // The sums need not wait for each other.
    constexpr int sum_count = 8;
    std::array<float, sum_count> sums{};
    double sum = 0.0;
    for (int y = 1; y + 1 < block.height; y += 2) {
        sums.fill(0.0F);
        const Sample* const row = first + y * pitch;
        const auto add = [&](int x, float& lane) {
            const auto twice = 2.0F * static_cast<float>(row[x]);
            const float bend =
                std::abs(static_cast<float>(row[x - 1]) + static_cast<float>(row[x + 1]) - twice) +
                std::abs(static_cast<float>(row[x - pitch]) + static_cast<float>(row[x + pitch]) -
                         twice);
            lane += bend <= std::numeric_limits<float>::max() ? bend : 0.0F;
        };
        int x = 1;
        for (; x + sum_count < block.width; x += sum_count) {
            for (int lane = 0; lane < sum_count; ++lane)
                add(x + lane, sums[static_cast<std::size_t>(lane)]);
        }
        for (; x + 1 < block.width; ++x)
            add(x, sums[0]);
        for (const float one : sums)
            sum += static_cast<double>(one);
    }
    return sum;
}

/// Returns five blocks of 64 x 64 texels of many parts: those in the middle of each fifth of all
/// blocks by roughness, so that they stand for smooth and rough places alike. The first and the
/// last one, which are a sample of them, are neither the smoothest nor the roughest. Empty if the
/// parts contain too little.
std::vector<Image> typical_blocks(std::span<const Image> parts) {
    constexpr std::size_t min_parts = (many_parts + 1) / 2;
    constexpr int part_side = 128;
    constexpr int side = 64;  // A multiple of the blocks of JPEG.
    struct Block {
        double roughness = 0.0;
        std::size_t part = 0;
        ImagePart place;
    };
    if (parts.size() < min_parts) return {};
    std::vector<Block> blocks;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (parts[i].width != part_side || parts[i].height != part_side) return {};
        for (const auto& [left, top] : {std::pair(0, 0), {side, side}, {side, 0}, {0, side}}) {
            const ImagePart place{left, top, side, side};
            const double roughness = with_sample_type(parts[i], [&]<typename Sample>(Sample) {
                return roughness_of<Sample>(parts[i], place);
            });
            blocks.push_back({roughness, i, place});
        }
    }
    std::stable_sort(blocks.begin(), blocks.end(),
                     [](const Block& a, const Block& b) { return a.roughness < b.roughness; });
    std::vector<Image> result;
    for (const std::size_t fifth : {1U, 0U, 2U, 4U, 3U}) {
        const Block& block = blocks[(2 * fifth + 1) * blocks.size() / 10];
        result.push_back(part_of(parts[block.part], block.place));
    }
    return result;
}

/// Returns true if the best kernel is a Gaussian that typical_blocks() do not contain often enough.
bool is_wide(const KernelPrediction& prediction) {
    constexpr int max_radius = 6;
    return prediction.kernel == Kernel::gaussian && prediction.gaussian_radius > max_radius;
}

/// Moves the upper end of the expected RMS error, and those of the other statistics by the same
/// factor.
void extend_range(KernelChoice& choice, double upper_rms_degrees) {
    if (!(upper_rms_degrees > choice.upper_rms_degrees)) return;
    if (choice.upper_rms_degrees > 0.0) {
        const double factor = upper_rms_degrees / choice.upper_rms_degrees;
        for (double KernelChoice::*error :
             {&KernelChoice::upper_mean_degrees, &KernelChoice::upper_p99_degrees,
              &KernelChoice::upper_max_degrees})
            choice.*error = std::min(180.0, factor * choice.*error);
    } else {
        choice.upper_mean_degrees = choice.upper_p99_degrees = upper_rms_degrees;
    }
    choice.upper_rms_degrees = upper_rms_degrees;
    choice.upper_max_degrees = std::max(choice.upper_max_degrees, upper_rms_degrees);
}

/// Returns the factor by which the expected error can be wrong in both directions, because the
/// storage of the map hides detail in a way that the model does not resolve.
double uncertainty_of(const KernelErrorModel& model) {
    constexpr double of_blocks = 1.25;  // Coefficients of 0 hide small ones.
    constexpr double of_coarse_steps = 1.5;
    constexpr int max_coarse_bits = 6;
    if (model.has_blocks()) return of_blocks;
    const bool is_coarse =
        model.coding().step() > 0.0 && model.coding().depth.bits <= max_coarse_bits;
    return is_coarse ? of_coarse_steps : 1.0;
}

/// The best kernel, and the model that predicts its error.
struct BestKernel {
    KernelErrorModel model;
    std::vector<KernelPrediction> predictions;  ///< From fast to slow.
    KernelPrediction prediction;
    unsigned max_threads = 0;  ///< 0: no limit.
};

/// The questions to the model of a map.
struct ChoiceRequest {
    BumpOptions options;
    bool destaircased = false;
    Grain grain = Grain::automatic;
};

BestKernel best_on(std::span<const Image> parts, const HeightCoding& coding,
                   const ChoiceRequest& request) {
    KernelErrorModel model(parts, coding, request.options, request.destaircased, request.grain);
    std::vector<KernelPrediction> predictions = all_predictions(model);
    const KernelPrediction best = select_best(predictions);
    return {std::move(model), std::move(predictions), best};
}

BestKernel best_of_map(std::span<const Image> parts, const HeightCoding& coding,
                       const ChoiceRequest& request) {
    // Some blocks suffice, except for kernels that are wide compared with them.
    const std::vector<Image> blocks = typical_blocks(parts);
    if (!blocks.empty()) {
        // Loops over so few texels end before other threads have begun.
        const ExecutionScope one_thread({1, nullptr});
        BestKernel best = best_on(blocks, coding, request);
        best.max_threads = 1;
        if (!is_wide(best.prediction)) return best;
    }
    return best_on(every_other(parts), coding, request);
}

/// Describes the best kernel, without the range of its error.
KernelChoice choice_of(const BestKernel& best, const BumpOptions& options) {
    const KernelErrorModel& model = best.model;
    KernelChoice choice;
    choice.depth = model.coding().depth;
    choice.noise = model.noise();
    choice.walls = model.edge_share();
    choice.grain = model.grain();
    choice.spikes = model.outlier_share();
    choice.predictions = best.predictions;
    std::stable_sort(choice.predictions.begin(), choice.predictions.end(), has_less_error);
    choice.kernel = best.prediction.kernel;
    choice.gaussian_radius = best.prediction.gaussian_radius;
    choice.rms_degrees = best.prediction.rms_degrees;
    choice.max_degrees = best.prediction.max_degrees;
    choice.mean_degrees = best.prediction.mean_degrees;
    choice.p99_degrees = best.prediction.p99_degrees;
    choice.reason = reason_text(model, options, best.prediction);
    return choice;
}

/// Adds the upper ends of the expected error, and its other readings.
///
/// \param blurred  widely_blurred_noise() of the map
void add_range(KernelChoice& choice, const BestKernel& chosen,
               const std::optional<NoiseSpectrum>& blurred, Grain grain) {
    const ExecutionScope scope({chosen.max_threads, nullptr});
    const KernelErrorModel& model = chosen.model;
    const KernelPrediction& best = chosen.prediction;
    const KernelPrediction upper = model.predict_upper(best);
    choice.upper_rms_degrees = std::max(best.rms_degrees, upper.rms_degrees);
    choice.upper_max_degrees = std::max(best.max_degrees, upper.max_degrees);
    choice.upper_mean_degrees = std::max(best.mean_degrees, upper.mean_degrees);
    choice.upper_p99_degrees = std::max(best.p99_degrees, upper.p99_degrees);
    if (blurred && !model.is_noisy() && !model.coding().has_exact_levels) {
        const double added = model.degrees_of_noise(best.kernel, best.gaussian_radius, *blurred);
        const BlurredNoiseReading reading = {blurred->deviation(), choice.upper_rms_degrees,
                                             std::hypot(choice.rms_degrees, added),
                                             std::hypot(choice.upper_rms_degrees, added)};
        if (reading.is_significant(choice.rms_degrees)) choice.blurred_noise = reading;
    }
    const double uncertainty = uncertainty_of(model);
    for (double KernelChoice::*error : {&KernelChoice::mean_degrees, &KernelChoice::rms_degrees,
                                        &KernelChoice::p99_degrees, &KernelChoice::max_degrees})
        choice.*error /= uncertainty;
    extend_range(choice, uncertainty * choice.upper_rms_degrees);
    if (choice.blurred_noise) extend_range(choice, choice.blurred_noise->upper_rms_degrees);
    if (choice.grain > 0.0) {
        const KernelErrorModel other_model =
            model.interpreted(choice.noise > 0.0 ? Grain::detail : Grain::noise);
        const KernelPrediction same_kernel = other_model.predict(best.kernel, best.gaussian_radius);
        choice.otherwise = {same_kernel.rms_degrees, select_best(all_predictions(other_model))};
        if (model.is_only_grain() && grain == Grain::automatic)
            extend_range(choice, same_kernel.rms_degrees);
        // Up to half of the power of blurred noise can be detail.
        if (model.is_noise_blurred() && choice.noise > 0.0) {
            extend_range(choice, std::hypot(choice.upper_rms_degrees,
                                            std::numbers::sqrt2 / 2.0 * same_kernel.rms_degrees));
        }
    }
}

/// Formats both ends of a range, or the lower one if they hardly differ.
std::string range_text(double lower, double upper) {
    return upper > KernelChoice::min_range * lower ? fmt::format("{:.2g} to {:.2g}", lower, upper)
                                                   : fmt::format("{:.2g}", lower);
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
    return range_text(choice.rms_degrees, choice.upper_rms_degrees);
}

void report_blurred_noise(const KernelChoice& choice, Report& report) {
    if (!choice.blurred_noise) return;
    const BlurredNoiseReading& reading = *choice.blurred_noise;
    report.add(
        {"fine detail that may be blurred noise",
         "map",
         fmt::format("the map does not show which: if it is detail, the expected error is {} "
                     "degrees RMS; if it is noise that was blurred over 2.5 texels or more, {}",
                     range_text(choice.rms_degrees, reading.detail_upper_rms_degrees),
                     range_text(reading.rms_degrees, reading.upper_rms_degrees)),
         1,
         {0}});
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
    const HeightCoding coding = coding_of(parts);
    const BestKernel best = best_of_map(parts, coding, {options, destaircased, grain});
    KernelChoice choice = choice_of(best, options);
    add_range(choice, best, blurred_noise_of(parts, coding), grain);
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

namespace {

std::vector<Image> parts_of(const ImageView& height) {
    if (height.empty()) throw InvalidInput("the height field is empty");
    std::vector<Image> parts;
    for (const ImagePart& part : parts_to_analyze(height.width, height.height))
        parts.push_back(part_of(height, part));
    return parts;
}

}  // namespace

KernelChoice choose_kernel(const ImageView& height, const BumpOptions& options, bool destaircased,
                           Grain grain) {
    return choose_kernel(parts_of(height), options, destaircased, grain);
}

KernelPrediction detail::best_kernel(const ImageView& height, const BumpOptions& options) {
    const std::vector<Image> parts = parts_of(height);
    check_parts(parts);
    return best_of_map(parts, coding_of(parts), {options}).prediction;
}

}  // namespace relief
