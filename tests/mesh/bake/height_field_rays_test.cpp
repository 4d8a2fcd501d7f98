// SPDX-License-Identifier: Apache-2.0
// The second reference for rays on height maps: the displaced plane as a mesh, on which the rays of
// the baker are cast. It shares no code with HeightField::first_hit().
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "bake/ray_scene.h"
#include "portable_math.h"
#include "relief/mesh/height_march.h"
#include "relief/mesh/mesh.h"
#include "support/images.h"

namespace relief {
namespace {

constexpr int side = 48;
constexpr double black_depth = 6.0;

/// A field as a mesh: each patch is divided into cells x cells quads of two triangles. x and y are
/// in texels, and z is the height in texels above black.
Mesh displaced_plane(const HeightField& field, int cells) {
    const int quads = (side - 1) * cells;
    Mesh mesh;
    for (int row = 0; row <= quads; ++row) {
        for (int column = 0; column <= quads; ++column) {
            const glm::dvec2 at = glm::dvec2(column, row) / static_cast<double>(cells) + 0.5;
            mesh.positions.emplace_back(at,
                                        black_depth * field.height(at / static_cast<double>(side)));
        }
    }
    const auto stride = static_cast<std::uint32_t>(quads + 1);
    for (std::uint32_t row = 0; row + 1 < stride; ++row) {
        for (std::uint32_t column = 0; column + 1 < stride; ++column) {
            const std::uint32_t first = row * stride + column;
            mesh.triangles.emplace_back(first, first + stride, first + stride + 1);
            mesh.triangles.emplace_back(first, first + stride + 1, first + 1);
        }
    }
    return mesh;
}

/// The largest A - B - C + E of a patch, in texels of height.
double largest_twist(const Image& heights) {
    const std::span<const float> h = heights.as<float>();
    double largest = 0.0;
    for (std::size_t i = 0; i + side + 1 < h.size(); ++i) {
        const double twist = static_cast<double>(h[i]) - h[i + 1] - h[i + side] + h[i + side + 1];
        largest = std::max(largest, black_depth * std::abs(twist));
    }
    return largest;
}

HeightField moved(const Image& heights, double by) {
    Image other = heights;
    for (float& height : other.as<float>())
        height = static_cast<float>(height + by / black_depth);
    return {other, Wrap::clamp};
}

TEST(DisplacedMeshes, BoundTheHitsOfHeightFields) {
    const Image noise = test::rough(side, side, 3);
    const Image heights = test::heights_of(side, side, [&](int x, int y) {
        return 0.3 + 0.4 * noise.as<float>()[static_cast<std::size_t>(y * side + x)];
    });
    const HeightField field(heights, Wrap::clamp);
    for (const int cells : {1, 4, 16}) {
        const Mesh mesh = displaced_plane(field, cells);
        const detail::RayScene scene({{mesh.positions, mesh.triangles}});
        // Two triangles are at most a fourth of the twist of their quad from it. Positions are
        // rounded to floats.
        const double bound = largest_twist(heights) / (4.0 * cells * cells) + 1e-5;
        const HeightField higher = moved(heights, bound);
        const HeightField lower = moved(heights, -bound);
        detail::Random random(9);
        std::vector<double> distances;
        for (int i = 0; i < 2000; ++i) {
            HeightRay ray;
            // Rays stay on the mesh.
            ray.texcoord = {random.between(0.42, 0.58), random.between(0.42, 0.58)};
            ray.direction = {random.between(-3.0, 3.0), random.between(-3.0, 3.0), 1.0};
            ray.black_depth = black_depth;
            const glm::dvec3 origin(ray.texcoord * static_cast<double>(side), black_depth);
            const glm::dvec3 down(glm::dvec2(ray.direction), -1.0);
            const detail::RayHit hit = scene.nearest({origin, glm::normalize(down), 0.0, 100.0});
            ASSERT_TRUE(hit.is_hit());
            const double depth = hit.distance / glm::length(down);
            // A surface above the mesh is hit before it, one below it after it.
            EXPECT_GE(depth, higher.first_hit(ray).depth) << cells;
            EXPECT_LE(depth, lower.first_hit(ray).depth) << cells;
            distances.push_back(std::abs(depth - field.first_hit(ray).depth));
        }
        // The distance falls with the square of the cells. The mean is larger: a few rays pass
        // ridges on one surface that they meet on the other.
        std::nth_element(distances.begin(), distances.begin() + 1000, distances.end());
        EXPECT_LT(distances[1000], 0.03 / (cells * cells));
    }
}

}  // namespace
}  // namespace relief
