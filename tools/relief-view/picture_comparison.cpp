// SPDX-License-Identifier: Apache-2.0
#include "picture_comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/summary.h"
#include "relief/mesh/image.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/report.h"
#include "variant_options.h"
#include "view_options.h"
#include "window/orbit_camera.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

/// The first column of the right side.
int first_right_column(const Image& image, float split) {
    return static_cast<int>(std::lround(split * static_cast<float>(image.width)));
}

}  // namespace

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

PictureComparison compare_pictures(const Image& reference, const Image& picture) {
    PictureComparison result;
    result.peak = peak_of(reference);
    const bool one_has_alpha = picture.channels + reference.channels == 7;
    result.difference =
        compare(one_has_alpha && reference.channels == 3 ? with_alpha(reference) : reference,
                one_has_alpha && picture.channels == 3 ? with_alpha(picture) : picture);
    result.flip = flip_difference(reference, picture);
    return result;
}

std::string with_peak(double value, double peak) {
    return peak == 1.0 ? fmt::format("{:.4g}", value) : fmt::format("{:.4g} of {}", value, peak);
}

std::string difference_text(const PictureComparison& comparison) {
    const ImageDifference& difference = comparison.difference;
    if (difference.differing_pixels == 0) return "no difference";
    return fmt::format("largest {}, mean {:.3g}, PSNR {:.1f} dB, FLIP {:.3g} (largest {:.3g}), {}",
                       with_peak(difference.max, comparison.peak), difference.mean, difference.psnr,
                       comparison.flip.mean, comparison.flip.max,
                       difference.differing_pixels == 1
                           ? "1 pixel differs"
                           : fmt::format("{} pixels differ", difference.differing_pixels));
}

Json numbers_json(const PictureComparison& comparison) {
    const ImageDifference& difference = comparison.difference;
    return {{"max", difference.max},
            {"mean", difference.mean},
            {"rms", difference.rms},
            {"psnr", difference.psnr},
            {"differing_pixels", difference.differing_pixels},
            {"flip_mean", comparison.flip.mean},
            {"flip_max", comparison.flip.max}};
}

Image largest_differences(const Image& a, const Image& b) {
    (void)compare(a, b);  // Throws if the formats differ.
    Image result = make_image(a.width, a.height, 1, 32, ColorSpace::data);
    auto& largest = std::get<std::vector<float>>(result.samples);
    const auto channels = static_cast<std::size_t>(a.channels);
    const double peak = peak_of(a);
    std::visit(
        [&](const auto& from) {
            const auto& other = std::get<std::decay_t<decltype(from)>>(b.samples);
            for (std::size_t i = 0; i < from.size(); ++i) {
                const double apart =
                    std::abs(static_cast<double>(from[i]) - static_cast<double>(other[i])) / peak;
                float& pixel = largest[i / channels];
                pixel = std::max(pixel, static_cast<float>(apart));
            }
        },
        a.samples);
    return result;
}

Image split_picture(const Image& left, const Image& right, float split) {
    Image result = left;
    const int first = first_right_column(left, split);
    std::visit(
        [&](auto& to) {
            const auto& from = std::get<std::decay_t<decltype(to)>>(right.samples);
            const auto row = static_cast<std::ptrdiff_t>(left.width) * left.channels;
            const auto begin = static_cast<std::ptrdiff_t>(first) * left.channels;
            for (std::ptrdiff_t y = 0; y < left.height; ++y) {
                std::copy(from.begin() + y * row + begin, from.begin() + (y + 1) * row,
                          to.begin() + y * row + begin);
            }
        },
        result.samples);
    return result;
}

namespace {

bool is_linear_format(const std::filesystem::path& file) {
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
        throw UsageError("--difference-map " + map.string() + ": unsupported format",
                         "use .png for colors or .exr for numbers");
    }
    require_folder_of(map);
}

}  // namespace

void add_reference_options(CLI::App& app, ViewOptions& options) {
    const std::string group = "Comparison";
    add_path(app, "--reference", options.reference,
             "Compare the picture with a reference picture. If they differ by more than "
             "--max-difference, the exit code is 1. This option needs no --output.")
        .group(group);
    add_number(app, "--max-difference", "D", options.max_difference, {0, 65535, ""},
               "Allow this difference from the reference in any channel of any pixel: in steps of "
               "its 255, or in the units of an .exr. Default: 0.")
        .group(group);
    add_path(app, "--difference-map", options.difference_map,
             "Write the perceived difference (FLIP) to FILE: as .png from black (no difference) to "
             "pale yellow, or as .exr with numbers from 0 to 1.")
        .group(group);
}

void check_reference(const ViewOptions& options) {
    if (!options.reference) {
        const bool has_sides =
            ((options.compare.compares() || options.exercise) && options.output) ||
            options.mistakes.size() == 1;
        refuse_without_reference(options.max_difference.has_value(), "--max-difference");
        refuse_without_reference(options.difference_map && !has_sides, "--difference-map");
        if (options.difference_map) check_map(options);
        return;
    }
    if (options.output &&
        is_linear_format(*options.output) != is_linear_format(*options.reference)) {
        throw UsageError("--reference " + options.reference->string() +
                             ": sRGB and linear colors cannot be compared",
                         "use the same kind of file as --output");
    }
    if (options.difference_map) check_map(options);
}

Image read_reference(const ViewOptions& options) {
    Image reference = read_image(*options.reference, ImageUse::color);
    if (reference.width != options.size.x || reference.height != options.size.y) {
        throw failure(
            *options.reference,
            fmt::format("has {} x {} pixels, but the picture has {} x {}", reference.width,
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
    write_image(file, extension_of(file) == ".png" ? false_color_image(map, 1.0) : map);
}

void add_comparison(Summary& summary, const ViewOptions& options,
                    const ReferenceComparison& comparison) {
    Json json = {{"reference", options.reference->string()},
                 {"matches", comparison.matches()},
                 {"allowed", comparison.allowed}};
    json.update(numbers_json(comparison));
    if (options.difference_map) json["difference_map"] = options.difference_map->string();
    summary.add("compared", difference_text(comparison), {{"comparison", std::move(json)}});
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

void add_compare_options(CLI::App& app, ViewOptions& options) {
    const std::string group = "Comparison";
    std::vector<std::string> topics;
    for (const VariantTopic& topic : variant_topics()) {
        std::vector<std::string> words;
        for (const auto& [word, variant] : topic.choices)
            words.push_back(word);
        topics.push_back(fmt::format("{}= {}", topic.name, fmt::join(words, ", ")));
    }
    add_value(app, "--compare", "WHAT=VALUE",
              fmt::format("Show the right part with one change, and measure the difference of the "
                          "two pictures. Changes: {}.",
                          fmt::join(topics, "; ")),
              [&](const std::string& subject, const std::string& text) {
                  options.compare.variant = parse_variant(subject, text);
              })
        .group(group);
    add_path(app, "--compare-to", options.compare.file,
             "Show another model or scene file in the right part, with the same camera. A model "
             "also gets the same lighting.")
        .group(group);
    add_number(
        app, "--split", "X", options.compare.split, {0, 1, ""},
        "Set where the right part begins: 0 is the left edge, 1 the right edge. Default: 0.5.")
        .group(group);
}

void check_compare_options(const ViewOptions& options) {
    const CompareChoices& choices = options.compare;
    if (!choices.compares()) return;
    const std::string option = choices.variant ? "--compare" : "--compare-to";
    refuse(options.reference.has_value(), option, "contradicts --reference",
           "leave one of them out");
    refuse(options.turntable || options.frames, option, "compares one picture, not a sequence",
           "leave --turntable or --frames out");
    refuse(options.effects.budget.has_value(), option,
           "contradicts --budget, which changes the picture too", "leave one of them out");
    refuse(!options.output && !options.wants_window(), option, "there is no --output", "add one");
}

OtherSide side_of_file(const Scene& scene, const Camera& camera, const ViewOptions& options,
                       Scene other) {
    OtherSide side{extension_of(options.model) == ".json"
                       ? std::move(other)
                       : with_lighting_of(scene, std::move(other)),
                   camera};
    side.camera = with_depth_range(camera, bounding_sphere(world_bounds(side.scene)));
    return side;
}

OtherSide other_side(const ViewOptions& options, const ComposedScene& composed, Stages& stages,
                     Report& report) {
    if (options.compare.variant) {
        const PreparedVariant prepared = stages.run("other side", [&] {
            return prepare(*options.compare.variant, composed.scene(), options, report);
        });
        return {with_variant(composed.scene(), prepared), composed.camera};
    }
    ViewOptions other = options;
    other.model = *options.compare.file;
    ComposedScene read = compose_scene(other, stages, report);
    return side_of_file(composed.scene(), composed.camera, other, std::move(read.scene()));
}

std::string side_name(const CompareChoices& choices) {
    return choices.variant ? to_text(*choices.variant) : choices.file->filename().string();
}

void add_sides(Summary& summary, const CompareChoices& choices,
               const PictureComparison& comparison) {
    Json json = {{"with", choices.variant ? to_text(*choices.variant) : choices.file->string()},
                 {"split", choices.split.value_or(default_split)}};
    json.update(numbers_json(comparison));
    summary.add("compared",
                fmt::format("with {}: {}", side_name(choices), difference_text(comparison)),
                {{"compare", std::move(json)}});
}

std::string command_line_of(const CompareChoices& choices) {
    if (!choices.compares()) return "";
    const std::string what = choices.variant ? " --compare " + to_text(*choices.variant)
                                             : " --compare-to " + choices.file->string();
    return what + (choices.split ? fmt::format(" --split {:.4g}", *choices.split) : "");
}

}  // namespace relief::tools
