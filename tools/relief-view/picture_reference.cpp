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
    if (map == options.model || map == options.reference || map == options.output ||
        map == options.compare.file)
        throw UsageError("--difference-map: would overwrite the model or a picture");
    require_folder_of(map);
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
        const bool has_sides = options.compare.compares() && options.output;
        refuse_without_reference(options.max_difference.has_value(), "--max-difference");
        refuse_without_reference(options.difference_map && !has_sides, "--difference-map");
        if (options.difference_map) check_map(options);
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
    about(*options.reference,
          [&] { static_cast<PictureComparison&>(result) = compare_pictures(reference, picture); });
    write_difference_map(options, result);
    return result;
}

void write_difference_map(const ViewOptions& options, const PictureComparison& comparison) {
    if (!options.difference_map) return;
    const std::filesystem::path& file = *options.difference_map;
    const Image& map = comparison.flip.map;
    write_image(file, extension_of(file) == ".png" ? heat_picture(map, 1.0) : map);
}

nlohmann::ordered_json comparison_json(const ViewOptions& options,
                                       const ReferenceComparison& comparison) {
    nlohmann::ordered_json json = {{"reference", options.reference->string()},
                                   {"matches", comparison.matches()},
                                   {"allowed", comparison.allowed}};
    json.update(numbers_json(comparison));
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
