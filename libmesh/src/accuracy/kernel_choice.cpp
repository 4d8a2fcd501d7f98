// SPDX-License-Identifier: Apache-2.0
// The choice of a kernel by a rehearsal (kernel_error_model.h), and the reason for it in words.
// Heights in the map's unit, angles in degrees. Bad images and options throw.
// Tests: tests/mesh/accuracy/kernel_choice_test.cpp.
#include "relief/mesh/kernel_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "accuracy/kernel_rehearsal.h"
#include "relief/mesh/error.h"

namespace relief {
namespace {

constexpr int radii[] = {1, 2, 3, 4, 5, 6, 7, 8, 10, 12, 14, 16, 20, 24, 28, 32, 40, 48, 56, 64};
/// From cheap to dear. Forward differences are half a texel off, and never the best.
constexpr Kernel fixed_kernels[] = {Kernel::central3, Kernel::scharr3,  Kernel::sobel3,
                                    Kernel::prewitt3, Kernel::central5, Kernel::central7,
                                    Kernel::sobel5,   Kernel::scharr5};
/// Kernels that are so little worse than the best count as good, and the cheapest is taken.
/// Little, since what is uncertain of the truth adds to all predictions alike.
constexpr double as_good = 1.003;

/// Fewer texels than this say too little of what they may have been.
constexpr std::size_t min_texels = 64;

std::vector<KernelPrediction> all_predictions(const KernelErrorModel& error_model) {
    std::vector<KernelPrediction> all;
    for (const Kernel kernel : fixed_kernels)
        all.push_back(error_model.predict(kernel, 2));
    double least = std::numeric_limits<double>::infinity();
    for (const int radius : radii) {
        all.push_back(error_model.predict(Kernel::gaussian, radius));
        least = std::min(least, all.back().rms_degrees);
        // Wider ones only get worse from here; and none is better than exact. High spikes are
        // spread over more texels before they are smoothed away.
        const int min_radius = error_model.spikes() > 0.0 ? 16 : 3;
        if (least == 0.0 && radius >= 3) break;
        if (radius >= min_radius && all.back().rms_degrees > 1.3 * least) break;
    }
    return all;
}

bool has_less_error(const KernelPrediction& a, const KernelPrediction& b) {
    return a.rms_degrees < b.rms_degrees;
}

/// \param all  from cheap to dear
KernelPrediction best_of(const std::vector<KernelPrediction>& all) {
    const double least = std::min_element(all.begin(), all.end(), has_less_error)->rms_degrees;
    return *std::find_if(all.begin(), all.end(), [least](const KernelPrediction& tried) {
        return tried.rms_degrees <= as_good * least;
    });
}

/// "8 bits used", or what else the heights are.
std::string coding_text(const HeightCoding& coding) {
    const int bits = coding.depth.bits;
    if (coding.has_exact_levels) return "a few levels, taken for the true heights";
    if (bits > 0) return fmt::format("{} bit{} used", bits, bits == 1 ? "" : "s");
    return coding.mantissa_bits < 20 ? fmt::format("floats of {} bits", coding.mantissa_bits)
                                     : "float heights";
}

/// Why the kernel was taken, for people.
std::string reason_of(const KernelErrorModel& error_model, const BumpOptions& options,
                      const KernelPrediction& best) {
    const GradientKernel kernel = gradient_kernel(best.kernel, best.gaussian_radius);
    const std::string coding = coding_text(error_model.coding());
    // Heights in texels, so that slopes are their differences.
    const double texels = std::abs(options.strength) / std::sqrt(options.texel.x * options.texel.y);
    const double step = texels * error_model.coding().step();
    const double noise = texels * error_model.noise();
    if (best.rms_degrees == 0.0) return coding + ": level ground, on which every kernel is exact";
    if (error_model.grain() > 0.0 && error_model.noise() == 0.0) {
        return fmt::format("{}: grain of {:.2g} texels{} is taken for detail", coding,
                           texels * error_model.grain(),
                           error_model.is_only_grain() ? ", and hardly anything else," : "");
    }
    const bool is_noisy = noise > 0.3 * step && noise > 0.0;
    const bool has_spikes = !is_noisy && error_model.spikes() > 0.0;
    const std::string problem = has_spikes
                                    ? fmt::format("{:.2g}% of texels that stick out on their own",
                                                  100.0 * error_model.spikes())
                                : is_noisy   ? fmt::format("noise of {:.2g} texels", noise)
                                : step > 0.0 ? fmt::format("steps of {:.2g} texels", step)
                                             : "rounding";
    if (kernel.smoothing.size() > 1) {
        return fmt::format("{}: {} outweigh{} fine detail, so heights are smoothed over {} texels",
                           coding, problem, is_noisy || (step == 0.0 && !has_spikes) ? "s" : "",
                           2 * kernel.smoothing.size() - 1);
    }
    if (error_model.walls() > 0.005 && kernel.radius == 1) {
        return fmt::format(
            "{}: {:.1f}% of the texels are beside sharp walls, so only the next texels are read",
            coding, 100.0 * error_model.walls());
    }
    return fmt::format(
        "{}: detail outweighs {}, so heights are not smoothed, and slopes are of "
        "order {}",
        coding, problem, kernel.order);
}

void check(std::span<const Image> parts) {
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
    // The best come first.
    for (const KernelPrediction& tried : choice.predictions) {
        if (tried.kernel == Kernel::gaussian) return tried.gaussian_radius;
    }
    return choice.gaussian_radius;
}

std::vector<ImagePart> parts_to_analyze(int width, int height) {
    constexpr int largest_side = 128;
    constexpr int max_each_way = 3;
    if (width <= 0 || height <= 0)
        throw InvalidInput(fmt::format("a map of {} x {} texels has no parts", width, height));
    if (std::min(width, height) < 8) {
        constexpr int longest = largest_side * largest_side;
        return {{0, 0, std::min(width, longest), std::min(height, longest)}};
    }
    const int least = std::min({width, height, largest_side});
    const int side = static_cast<int>(std::bit_floor(static_cast<unsigned>(least)));
    // Parts that overlap by more than half have the same noise, which would look like detail.
    const auto places = [&](int length) {
        return 2 * length < 3 * side ? 1 : (length - 1) / side + 1;
    };
    // A long and narrow map is looked at in as many places.
    int rows = std::min(places(height), max_each_way);
    const int columns = std::min(places(width), max_each_way * max_each_way / rows);
    rows = std::min(places(height), max_each_way * max_each_way / columns);
    const auto place = [side](int i, int count, int length) {
        const std::int64_t room = length - side;
        if (std::int64_t{count} * side >= length)
            return static_cast<int>(i * room / std::max(1, count - 1));
        return static_cast<int>((2 * std::int64_t{i} + 1) * room / (2 * count));
    };
    std::vector<ImagePart> parts;
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column)
            parts.push_back({place(column, columns, width), place(row, rows, height), side, side});
    }
    return parts;
}

KernelChoice choose_kernel(std::span<const Image> parts, const BumpOptions& options,
                           bool destaircased, Grain grain) {
    check(parts);
    const KernelErrorModel error_model(parts, options, destaircased, grain);
    KernelChoice choice;
    choice.depth = error_model.coding().depth;
    choice.noise = error_model.noise();
    choice.walls = error_model.walls();
    choice.grain = error_model.grain();
    choice.spikes = error_model.spikes();
    choice.predictions = all_predictions(error_model);
    const KernelPrediction best = best_of(choice.predictions);
    std::stable_sort(choice.predictions.begin(), choice.predictions.end(), has_less_error);
    choice.kernel = best.kernel;
    choice.gaussian_radius = best.gaussian_radius;
    choice.rms_degrees = best.rms_degrees;
    choice.max_degrees = best.max_degrees;
    choice.reason = reason_of(error_model, options, best);
    const KernelPrediction upper = error_model.predict_upper(best);
    choice.upper_rms_degrees = std::max(best.rms_degrees, upper.rms_degrees);
    choice.upper_max_degrees = std::max(best.max_degrees, upper.max_degrees);
    if (choice.grain > 0.0) {
        const KernelErrorModel other(parts, options, destaircased,
                                     choice.noise > 0.0 ? Grain::detail : Grain::noise);
        const KernelPrediction same = other.predict(best.kernel, best.gaussian_radius);
        choice.otherwise = {same.rms_degrees, best_of(all_predictions(other))};
        if (error_model.is_only_grain() && grain == Grain::automatic) {
            choice.upper_rms_degrees = std::max(choice.upper_rms_degrees, same.rms_degrees);
            choice.upper_max_degrees = std::max(choice.upper_max_degrees, same.max_degrees);
        }
    }
    std::size_t texels = 0;
    for (const Image& part : parts)
        texels += part.sample_count();
    if (texels < min_texels && choice.rms_degrees > 0.0) {
        choice.rms_degrees = choice.max_degrees = std::numeric_limits<double>::quiet_NaN();
        choice.upper_rms_degrees = choice.upper_max_degrees = choice.rms_degrees;
        choice.reason = fmt::format("{} texel{} say too little to expect an error", texels,
                                    texels == 1 ? "" : "s");
    }
    return choice;
}

KernelChoice choose_kernel(const Image& height, const BumpOptions& options, bool destaircased,
                           Grain grain) {
    if (height.empty()) throw InvalidInput("an empty height field has no kernel");
    std::vector<Image> parts;
    for (const ImagePart& place : parts_to_analyze(height.width, height.height))
        parts.push_back(part_of(height, place));
    return choose_kernel(parts, options, destaircased, grain);
}

}  // namespace relief
