// SPDX-License-Identifier: Apache-2.0
#include "picture_reference.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "common/text.h"
#include "relief/mesh/heat_picture.h"
#include "relief/mesh/image_file.h"

namespace relief::tools {
namespace {

bool holds_linear_light(const std::filesystem::path& file) {
    const std::string extension = extension_of(file);
    return extension == ".exr" || extension == ".hdr";
}

void refuse_without_reference(bool given, const std::string& option) {
    if (given)
        throw UsageError(option + ": there is no --reference to compare with",
                         "give one, or leave it out");
}

void check_map(const ViewOptions& options) {
    const std::filesystem::path& map = *options.difference_map;
    const std::string extension = extension_of(map);
    if (extension != ".png" && extension != ".exr") {
        throw UsageError("--difference-map " + map.string() + ": no format to write a map in",
                         "use .png for colours or .exr for numbers");
    }
    if (map == options.model || map == *options.reference || map == options.output)
        throw UsageError("--difference-map: would overwrite the model or a picture");
    require_folder_of(map);
}

/// The same picture with an alpha channel that is full everywhere.
Image with_alpha(const Image& image) {
    Image covered = make_image(image.width, image.height, 4, image.bits(), image.color_space);
    std::visit(
        [&](const auto& samples) {
            using Samples = std::decay_t<decltype(samples)>;
            using Sample = typename Samples::value_type;
            auto& to = std::get<Samples>(covered.samples);
            const auto full = std::is_integral_v<Sample> ? std::numeric_limits<Sample>::max()
                                                         : static_cast<Sample>(1);
            for (std::size_t i = 0; i < to.size(); ++i)
                to[i] = i % 4 == 3 ? full : samples[i / 4 * 3 + i % 4];
        },
        image.samples);
    return covered;
}

double peak_of(const Image& image) {
    return image.bits() == 8 ? 255.0 : (image.bits() == 16 ? 65535.0 : 1.0);
}

void write_map(const ViewOptions& options, const Image& map) {
    const std::filesystem::path& file = *options.difference_map;
    write_image(file, extension_of(file) == ".png" ? heat_picture(map, 1.0) : map);
}

std::string with_peak(double value, double peak) {
    return peak == 1.0 ? fmt::format("{:.4g}", value) : fmt::format("{:.4g} of {}", value, peak);
}

}  // namespace

void add_reference_options(CLI::App& app, ViewOptions& options) {
    const std::string group = "Comparison";
    add_path(app, "--reference", options.reference,
             "Picture that is known to be right. What is drawn is compared with it, and where they "
             "differ by more than --max-difference, the exit code is 1. Needs no --output.")
        .group(group);
    add_number(app, "--max-difference", "D", options.max_difference, {0, 65535, ""},
               "Largest difference from the reference that is no mismatch, in any channel of any "
               "pixel: in steps of its 255, or in the units of an .exr. Default: 0.")
        .group(group);
    add_path(app, "--difference-map", options.difference_map,
             "Where to write what an eye sees of the difference (FLIP): .png from black, no "
             "difference, to pale yellow, or .exr as numbers from 0 to 1.")
        .group(group);
}

void check_reference(const ViewOptions& options) {
    if (!options.reference) {
        refuse_without_reference(options.max_difference.has_value(), "--max-difference");
        refuse_without_reference(options.difference_map.has_value(), "--difference-map");
        return;
    }
    if (options.output == options.reference)
        throw UsageError("--output: would overwrite the reference");
    if (options.output &&
        holds_linear_light(*options.output) != holds_linear_light(*options.reference)) {
        throw UsageError("--reference " + options.reference->string() +
                             ": sRGB and linear light cannot be compared",
                         "name a reference of the same kind as --output");
    }
    if (options.difference_map) check_map(options);
}

Image read_reference(const ViewOptions& options) {
    Image reference = read_image(*options.reference, ImageUse::color);
    if (reference.width != options.size.x || reference.height != options.size.y) {
        throw failure(*options.reference,
                      fmt::format("has {} x {} pixels, but {} x {} would be drawn", reference.width,
                                  reference.height, options.size.x, options.size.y),
                      fmt::format("add --size {}x{}", reference.width, reference.height));
    }
    return reference;
}

ReferenceComparison compare_with_reference(const ViewOptions& options, const Image& picture,
                                           const Image& reference) {
    ReferenceComparison result;
    result.allowed = options.max_difference.value_or(0.0);
    result.peak = peak_of(reference);
    about(*options.reference, [&] {
        const bool one_has_alpha = picture.channels + reference.channels == 7;
        result.difference =
            compare(one_has_alpha && reference.channels == 3 ? with_alpha(reference) : reference,
                    one_has_alpha && picture.channels == 3 ? with_alpha(picture) : picture);
        result.flip = flip_difference(reference, picture);
    });
    if (options.difference_map) write_map(options, result.flip.map);
    return result;
}

std::string in_words(const ReferenceComparison& comparison) {
    const ImageDifference& difference = comparison.difference;
    if (difference.differing_pixels == 0) return "no difference";
    return fmt::format("largest {}, mean {:.3g}, PSNR {:.1f} dB, FLIP {:.3g} (largest {:.3g}), {}",
                       with_peak(difference.max, comparison.peak), difference.mean, difference.psnr,
                       comparison.flip.mean, comparison.flip.max,
                       difference.differing_pixels == 1
                           ? "1 pixel differs"
                           : fmt::format("{} pixels differ", difference.differing_pixels));
}

nlohmann::ordered_json comparison_json(const ViewOptions& options,
                                       const ReferenceComparison& comparison) {
    const ImageDifference& difference = comparison.difference;
    nlohmann::ordered_json json = {{"reference", options.reference->string()},
                                   {"matches", comparison.matches()},
                                   {"allowed", comparison.allowed},
                                   {"max", difference.max},
                                   {"mean", difference.mean},
                                   {"rms", difference.rms},
                                   {"psnr", difference.psnr},
                                   {"differing_pixels", difference.differing_pixels},
                                   {"flip_mean", comparison.flip.mean},
                                   {"flip_max", comparison.flip.max}};
    if (options.difference_map) json["difference_map"] = options.difference_map->string();
    return json;
}

void require_match(const ViewOptions& options, const ReferenceComparison& comparison) {
    if (comparison.matches()) return;
    throw failure(
        *options.reference,
        fmt::format("the picture differs by {}, and --max-difference allows {:.4g}",
                    with_peak(comparison.difference.max, comparison.peak), comparison.allowed),
        options.difference_map ? options.difference_map->string() + " shows where"
                               : "--difference-map FILE shows where");
}

}  // namespace relief::tools
