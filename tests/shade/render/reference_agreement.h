// SPDX-License-Identifier: Apache-2.0
/// \file
/// The comparison of OpenGL's picture with the CPU reference, away from edges.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "relief/shade/effects.h"
#include "relief/shade/reference.h"
#include "relief/shade/renderer.h"
#include "shade/render/draw_support.h"
#include "support/shapes.h"

namespace relief::test {

/// In codes: half a code of rounding, and the rest for float arithmetic and vertices rounded to
/// 1/256 pixel.
inline constexpr double agreement_tolerance = 1.0;

/// In codes, for blurred environments: OpenGL mixes the two maps of the nearest roughness, each
/// with an error of up to two percent.
inline constexpr double blurred_tolerance = 3.5;

/// The largest difference between two pictures and its position.
struct Worst {
    double codes = 0.0;
    int x = 0;
    int y = 0;
    int compared = 0;
};

inline Worst furthest(const Image& drawn, const Image& expected, const Image& edges) {
    Worst worst;
    for (int y = 0; y < drawn.height; ++y) {
        for (int x = 0; x < drawn.width; ++x) {
            if (pixel(edges, x, y)[0] > 0.0) continue;
            ++worst.compared;
            for (int i = 0; i < 4; ++i) {
                const double apart =
                    std::abs(pixel(drawn, x, y)[i] - 255.0 * pixel(expected, x, y)[i]);
                if (apart > worst.codes) worst = {apart, x, y, worst.compared};
            }
        }
    }
    return worst;
}

/// Returns the effects of all draws of a scene, for messages.
inline std::string effects_of(const shade::Scene& scene) {
    std::string text;
    for (const shade::DrawPlan& draw : shade::plan_effects(scene, {.samples = 1}).draws)
        text += "\n    " + shade::describe(draw.features);
    return text;
}

/// Expects that OpenGL's picture of size x size pixels is that of the reference.
/// \param tolerance  in codes
inline void expect_agreement(const shade::Context& context, const shade::Scene& scene, int size,
                             double tolerance) {
    Report report;
    const shade::Reference reference = shade::render_reference(scene, {size, size}, report);
    const Image expected =
        shade::reference_picture(reference.radiance, scene, shade::OutputCoding::srgb);
    const Image drawn =
        shade::Renderer(context, scene, {size, size, 1, shade::OutputCoding::srgb}, report)
            .draw(*scene.camera)
            .image;
    const Worst worst = furthest(drawn, expected, reference.edges);
    EXPECT_LE(worst.codes, tolerance) << "at " << worst.x << ", " << worst.y << effects_of(scene);
    EXPECT_GT(worst.compared, size * size / 4) << "edges nearly everywhere";
}

/// The width and height of compared pictures.
inline constexpr int reference_size = 32;

class AgainstReference : public DrawTest {
  protected:
    void expect_agreement(const shade::Scene& scene, double tolerance = agreement_tolerance) const {
        test::expect_agreement(context(), scene, reference_size, tolerance);
    }
};

/// A sphere under three lights, rotated so that neither poles nor seam are in front.
inline shade::Scene lit_sphere() {
    shade::Scene scene = scene_of(sphere(32, 24), Material{});
    scene.ambient = {0.1F, 0.15F, 0.2F};
    scene.directional_lights = {{{-1, -2, -3}, {0.6F, 0.5F, 0.4F}}};
    scene.point_lights = {{{-2, 1, 2}, {0.9F, 1.2F, 1.5F}}};
    return scene;
}

}  // namespace relief::test
