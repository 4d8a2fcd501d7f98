// SPDX-License-Identifier: Apache-2.0
// Error metrics of normal maps and of images.
#include "error_metrics.h"

#include <fmt/format.h>

#include "parallel.h"
#include "relief/mesh/report.h"
#include "relief/mesh/statistics.h"
#include "relief/shade/image_compare.h"

namespace relief {

Image angles_of(const Image& normals, std::span<const glm::dvec3> ground_truth) {
    if (normals.channels != 3 || normals.bits() != 32 ||
        normals.sample_count() != 3 * ground_truth.size()) {
        throw InvalidInput(fmt::format("a map of {} x {} texels of {} channels has no {} normals",
                                       normals.width, normals.height, normals.channels,
                                       ground_truth.size()));
    }
    Image angles = make_image(normals.width, normals.height, 1, 32, ColorSpace::data);
    const std::span<const float> n = normals.as<float>();
    const std::span<float> degrees = angles.as<float>();
    parallel_for(degrees.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const glm::dvec3 actual(n[3 * i], n[3 * i + 1], n[3 * i + 2]);
            degrees[i] = static_cast<float>(degrees_between(actual, ground_truth[i]));
        }
    });
    return angles;
}

std::vector<float> inner_angles(const Image& normals, std::span<const glm::dvec3> ground_truth,
                                int margin) {
    const Image angles = angles_of(normals, ground_truth);
    const std::span<const float> all = angles.as<float>();
    std::vector<float> counted;
    for (int y = margin; y < angles.height - margin; ++y) {
        const auto row = static_cast<std::ptrdiff_t>(y) * angles.width;
        counted.insert(counted.end(), all.begin() + row + margin,
                       all.begin() + row + angles.width - margin);
    }
    return counted;
}

ErrorStats map_errors(const Image& normals, std::span<const glm::dvec3> ground_truth, int margin) {
    return error_stats(inner_angles(normals, ground_truth, margin));
}

namespace {

/// Statistics of any float map; error_stats() accepts all numbers.
ErrorStats stats_of_map(const Image& map) {
    const std::span<const float> errors = map.as<float>();
    return error_stats({errors.begin(), errors.end()});
}

}  // namespace

PictureError picture_error(const Image& ground_truth, const Image& picture) {
    const Image shown = to_srgb(ground_truth, 8);
    FlipDifference flip = flip_difference(shown, picture);
    PictureError error{stats_of_map(flip.map), std::move(flip.map)};
    error.figures.psnr = compare(shown, picture).psnr;
    return error;
}

Image averaged(const Image& linear, int side) {
    if (side < 1 || linear.width % side != 0 || linear.height % side != 0)
        throw InvalidInput("a picture can be averaged only by squares that fit into it");
    Image mean = make_image(linear.width / side, linear.height / side, linear.channels, 32,
                            linear.color_space);
    const std::span<const float> from = linear.as<float>();
    const std::span<float> to = mean.as<float>();
    const auto channels = static_cast<std::size_t>(linear.channels);
    const auto index = [channels](int width, int x, int y) {
        return channels * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                           static_cast<std::size_t>(x));
    };
    for (int y = 0; y < mean.height; ++y) {
        for (int x = 0; x < mean.width; ++x) {
            for (std::size_t channel = 0; channel < channels; ++channel) {
                double sum = 0.0;
                for (int i = 0; i < side * side; ++i) {
                    sum += static_cast<double>(
                        from[index(linear.width, x * side + i % side, y * side + i / side) +
                             channel]);
                }
                to[index(mean.width, x, y) + channel] = static_cast<float>(sum / (side * side));
            }
        }
    }
    return mean;
}

Image without_alpha(const Image& image) {
    Image result{image.width, image.height, 3, image.color_space, {}};
    std::visit(
        [&](const auto& samples) {
            std::decay_t<decltype(samples)> kept;
            kept.reserve(result.sample_count());
            const auto channels = static_cast<std::size_t>(image.channels);
            for (std::size_t i = 0; i < samples.size(); i += channels)
                kept.insert(kept.end(), samples.begin() + static_cast<std::ptrdiff_t>(i),
                            samples.begin() + static_cast<std::ptrdiff_t>(i + 3));
            result.samples = std::move(kept);
        },
        image.samples);
    return result;
}

}  // namespace relief
