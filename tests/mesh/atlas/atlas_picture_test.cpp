// SPDX-License-Identifier: Apache-2.0
// Pictures of texture coordinates.
#include "relief/mesh/atlas_picture.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "relief/mesh/unwrap.h"
#include "support/invariants.h"

namespace relief {
namespace {

using Color = std::array<int, 3>;

/// Two squares of side 1 in a map of 64 x 32 pixels: one from (4, 4) to (20, 20), the other one
/// twice as dense from (24, 0) to (56, 32).
struct TwoSquares {
    Mesh mesh;
    std::vector<glm::vec2> texcoords;
    std::vector<std::optional<std::uint32_t>> chart{0U, 0U, 1U, 1U};

    TwoSquares() {
        add(0.0F, {4, 4}, {20, 20});
        add(2.0F, {24, 0}, {56, 32});
    }

    [[nodiscard]] Color color(int x, int y, AtlasPicture picture) const {
        const Image image = draw_atlas(mesh, texcoords, chart, {64, 32}, picture);
        const auto samples = image.as<std::uint8_t>();
        const std::size_t at = 3 * static_cast<std::size_t>(64 * y + x);
        return {samples[at], samples[at + 1], samples[at + 2]};
    }

  private:
    void add(float x, const glm::vec2& min, const glm::vec2& max) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const glm::vec2& corner : {glm::vec2(0, 0), {1, 0}, {1, 1}, {0, 1}})
            mesh.positions.emplace_back(x + corner.x, corner.y, 0.0F);
        for (const glm::uvec3& t : {glm::uvec3(0, 1, 2), glm::uvec3(0, 2, 3)}) {
            mesh.triangles.push_back(t + first);
            for (int i = 0; i < 3; ++i) {
                const glm::vec3 p = mesh.positions[first + t[i]];
                texcoords.push_back(
                    glm::vec2(min.x + (p.x - x) * (max.x - min.x), max.y + p.y * (min.y - max.y)) /
                    glm::vec2(64.0F, 32.0F));
            }
        }
    }
};

TEST(AtlasPicture, DrawsChartsWithBorders) {
    const TwoSquares squares;
    const auto color = [&](int x, int y) { return squares.color(x, y, AtlasPicture::charts); };
    EXPECT_EQ(color(1, 1), (Color{0, 0, 0})) << "outside of charts";
    EXPECT_EQ(color(10, 10), color(18, 6)) << "both triangles of a chart";
    EXPECT_NE(color(10, 10), color(40, 16));
    EXPECT_EQ(color(3, 10), (Color{0, 0, 0}));
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(color(4, 10)[static_cast<std::size_t>(c)],
                    0.5 * (20 + color(10, 10)[static_cast<std::size_t>(c)]), 1.0)
            << "half of the pixel is border";
}

// The mean density is that of both areas: sqrt((16^2 + 32^2) / 2) = 25.3 texels per unit.
TEST(AtlasPicture, ColorsDensity) {
    const TwoSquares squares;
    const Color sparse = squares.color(10, 10, AtlasPicture::density);
    const Color dense = squares.color(40, 16, AtlasPicture::density);
    // log2(16 / 25.3) = -0.661 and log2(32 / 25.3) = 0.339 of the way from gray to blue and red.
    EXPECT_NEAR(sparse[0], 221 + 0.661 * (59 - 221), 1.0);
    EXPECT_NEAR(sparse[2], 221 + 0.661 * (192 - 221), 1.0);
    EXPECT_NEAR(dense[0], 221 + 0.339 * (180 - 221), 1.0);
    EXPECT_NEAR(dense[1], 221 + 0.339 * (4 - 221), 1.0);
}

TEST(AtlasPicture, ColorsStretch) {
    TwoSquares squares;
    EXPECT_EQ(squares.color(40, 16, AtlasPicture::stretch), (Color{221, 221, 221}));
    for (std::size_t v = 4; v < 8; ++v)
        squares.mesh.positions[v].y *= 2.0F;
    const Color color = squares.color(40, 16, AtlasPicture::stretch);
    EXPECT_NEAR(color[1], 221 + 0.5 * (4 - 221), 1.0) << "2 is half of the way to 4";
}

TEST(AtlasPicture, DrawsAtlasesOfUnwrapping) {
    Mesh sphere = make_sphere(32, 16);
    const Unwrapped unwrapped = unwrap(sphere);
    const Image image = draw_atlas(sphere, unwrapped.corner_texcoords, unwrapped.chart, {256, 256});
    std::size_t drawn = 0;
    const auto samples = image.as<std::uint8_t>();
    for (std::size_t i = 0; i < samples.size(); i += 3)
        if (samples[i] + samples[i + 1] + samples[i + 2] > 0) ++drawn;
    const double share = static_cast<double>(drawn) / (256.0 * 256.0);
    EXPECT_NEAR(share, unwrapped.stats.used, 0.02) << "up to half a pixel at the borders";
}

TEST(AtlasPicture, RefusesOtherLengths) {
    const TwoSquares squares;
    EXPECT_EQ(test::message_of<InvalidInput>([&] {
                  draw_atlas(squares.mesh, {}, squares.chart, {64, 32});
              }),
              "there are 0 texture coordinates and 4 charts for 4 triangles");
    EXPECT_EQ(test::message_of<InvalidInput>([&] {
                  draw_atlas(squares.mesh, squares.texcoords, squares.chart, {64, 0});
              }),
              "the size of the picture is 0, but must be 1 to 16384 pixels");
}

}  // namespace
}  // namespace relief
