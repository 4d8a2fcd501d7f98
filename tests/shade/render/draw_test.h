// SPDX-License-Identifier: Apache-2.0
/// \file
/// Tests that draw whole scenes, on OSMesa or, where it is not installed, on EGL.
#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "relief/mesh/image.h"
#include "relief/shade/renderer.h"
#include "support/gl_environment.h"

namespace relief::test {

/// The tests of a suite share a context; skipped where no backend is installed. A test that does
/// not leave the context clean (expect_clean_context()) fails.
class DrawTest : public ::testing::Test {
  protected:
    static void TearDownTestSuite() { release_shared_context(); }
    void SetUp() override;
    void TearDown() override;

    [[nodiscard]] const Context& context() const { return *context_; }

    /// The scene's picture by its own camera; findings are discarded.
    [[nodiscard]] Frame render(const Scene& scene, const FrameSettings& settings) const;
    [[nodiscard]] Frame render(const Scene& scene, const FramePlan& plan,
                               const FrameSettings& settings) const;

    /// The same in linear float, 1 sample a pixel: exact radiance at each pixel's centre.
    [[nodiscard]] Image radiance(const Scene& scene, int width, int height) const;

  private:
    const Context* context_ = nullptr;
};

/// The colour of a pixel, from the upper left; 8-bit samples as codes, float as they are.
glm::dvec4 pixel(const Image& image, int x, int y);

/// A camera at (0,0,3) that looks at the origin down -z, and sees 2 units up and down there.
Camera front_camera();

/// A material that shows nothing: a test switches on what it is about.
Material black_material();

/// One mesh with one material at the origin, seen by front_camera(), with nothing else.
Scene scene_of(Mesh mesh, const Material& material);

/// A square of 4 x 4 around the origin that faces +z, its texture upright.
Mesh facing_square();

/// An image of one colour.
Image constant_image(const glm::vec4& color, int channels, int bits, ColorSpace space);

/// An environment of the same radiance everywhere.
Environment constant_environment(const glm::vec3& radiance, bool skybox);

/// Whether two images hold the same bits.
bool same_bits(const Image& a, const Image& b);

}  // namespace relief::test
