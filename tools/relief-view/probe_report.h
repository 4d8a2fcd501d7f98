// SPDX-License-Identifier: Apache-2.0
/// \file
/// The probe of a pixel as text and as JSON. docs/probe.md describes both.
/// Tests: tests/tools/probe_test.cpp.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/summary.h"
#include "relief/mesh/image.h"
#include "relief/shade/probe.h"
#include "relief/shade/scene.h"

namespace relief::tools {

/// A pixel of a picture.
struct PixelValues {
    glm::dvec4 linear{0.0};  ///< Radiance over the background, and alpha.
    glm::dvec4 codes{0.0};   ///< sRGB codes and alpha, 0 to 255.
};

/// A probe with the same pixel as the renderer draws it.
struct ProbedPixel {
    shade::Probe probe;
    PixelValues reference;
    std::optional<PixelValues> shader;  ///< With one sample, at the center.
    glm::dvec4 picture{0.0};            ///< Its codes with all samples.
    int samples = 1;                    ///< Of the picture.
};

/// Returns a pixel of four channels: 8-bit codes or floats.
glm::dvec4 pixel_of(const Image& image, const glm::ivec2& pixel);

/// Returns a probe with the reference's values, without the renderer's.
/// \param scene  with the camera of the picture
ProbedPixel reference_values(const shade::Probe& probe, const shade::Scene& scene);

/// Lines of text under one heading.
struct ProbeSection {
    std::string label;
    std::vector<std::string> lines;
};

/// Returns the pixel for readers: surfaces with their vectors, textures and lights, the terms with
/// their formulas, and the way to the code.
std::vector<ProbeSection> probe_sections(const ProbedPixel& pixel, const shade::Scene& scene);

/// Returns a number with four digits; a color of equal channels likewise, and others as
/// "(0.5, 0.25, 1)".
std::string number_text(const glm::dvec3& value);

/// Returns for example "diffuse, point light 1: L * n.l * kd = 0.44 * 0.731 * 0.52 = 0.167".
std::string term_text(const shade::Probe& probe, const shade::ProbeTerm& term);

Json probe_json(const ProbedPixel& pixel, const shade::Scene& scene);

/// Returns both, with the JSON as the member "probe".
Summary probe_summary(const ProbedPixel& pixel, const shade::Scene& scene);

}  // namespace relief::tools
