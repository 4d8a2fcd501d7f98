// SPDX-License-Identifier: Apache-2.0
/// \file
/// Comparison of pictures: with a reference picture (--reference), with a variant of the scene
/// (--compare), or with another file (--compare-to).
/// Tests: tests/tools/compare_options_test.cpp, picture_reference_test.cpp.
#pragma once

#include <string>

#include "common/summary.h"
#include "relief/shade/image_compare.h"
#include "relief/shade/renderer.h"
#include "scene_options.h"
#include "view_options.h"

namespace relief::tools {

struct PictureComparison {
    shade::ImageDifference difference;
    shade::FlipDifference flip;
    double peak = 1;  ///< The largest sample value: 255, 65535 or 1.
};

/// Adds an opaque alpha channel.
Image with_alpha(const Image& image);

/// The largest sample value of an image: 255, 65535 or 1.
double peak_of(const Image& image);

/// Compares two pictures. A picture without alpha is opaque.
/// \throws InvalidInput if the sizes, bits or channels differ
PictureComparison compare_pictures(const Image& reference, const Image& picture);

/// For example "largest 3 of 255, mean 0.02, PSNR 58.1 dB, FLIP 0.004 (largest 0.21), 812 pixels
/// differ".
std::string difference_text(const PictureComparison& comparison);

/// For example "3 of 255" or "0.25".
std::string with_peak(double value, double peak);

/// {"max", "mean", "rms", "psnr", "differing_pixels", "flip_mean", "flip_max"}. Infinite values,
/// such as the PSNR of equal pictures, are null.
Json numbers_json(const PictureComparison& comparison);

/// The largest difference of any channel at each pixel, from 0 to 1, as one float channel.
/// \throws InvalidInput if the sizes, bits or channels differ
Image largest_differences(const Image& a, const Image& b);

/// Joins the left columns of one picture with the right columns of another.
/// \param split  the width of the left part, from 0 to 1
Image split_picture(const Image& left, const Image& right, float split);

void add_reference_options(CLI::App& app, ViewOptions& options);

/// \throws UsageError if an option needs another one
/// \throws FileError if the folder of the difference map does not exist
void check_reference(const ViewOptions& options);

/// Reads the reference picture.
/// \throws FileError if it cannot be read or does not have the size of --size
Image read_reference(const ViewOptions& options);

/// The difference from the reference.
struct ReferenceComparison : PictureComparison {
    double allowed = 0;  ///< --max-difference

    [[nodiscard]] bool matches() const { return difference.max <= allowed; }
};

/// Compares the picture with the reference, and writes --difference-map.
/// \throws FileError if the formats differ, or the map cannot be written
ReferenceComparison compare_with_reference(const ViewOptions& options, const Image& picture,
                                           const Image& reference);

/// Writes --difference-map, if it is given. \throws FileError
void write_difference_map(const ViewOptions& options, const PictureComparison& comparison);

/// Adds the member "comparison".
void add_comparison(Summary& summary, const ViewOptions& options,
                    const ReferenceComparison& comparison);

/// \throws FileError, which leads to exit code 1, if the pictures do not match
void require_match(const ViewOptions& options, const ReferenceComparison& comparison);

void add_compare_options(CLI::App& app, ViewOptions& options);

/// \throws UsageError if options contradict each other or have no effect
void check_compare_options(const ViewOptions& options);

/// The other side of a comparison.
struct OtherSide {
    shade::Scene scene;
    shade::Camera camera;
};

/// \param composed  the scene of these options
/// \throws UsageError if the variant would change nothing
/// \throws FileError if a file cannot be read
OtherSide other_side(const ViewOptions& options, const ComposedScene& composed, Stages& stages,
                     Report& report);

/// The scene of another file. A model gets the lighting of this scene; a scene file has its own.
/// \param options  options whose model is the other file
OtherSide side_of_file(const shade::Scene& scene, const shade::Camera& camera,
                       const ViewOptions& options, shade::Scene other);

/// For example "kernel=central3", or the name of the file.
std::string side_name(const CompareChoices& choices);

/// Adds the member "compare": {"with", "split"} and the members of numbers_json().
void add_sides(Summary& summary, const CompareChoices& choices,
               const PictureComparison& comparison);

/// The options of the comparison, each after a space; "" without a comparison.
std::string command_line_of(const CompareChoices& choices);

}  // namespace relief::tools
