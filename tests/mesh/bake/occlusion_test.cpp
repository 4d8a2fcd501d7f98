// SPDX-License-Identifier: Apache-2.0
// Occlusion against closed forms: under a disc, inside of a bowl, on what hides nothing of itself.
#include "bake/layers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "relief/mesh/mesh.h"
#include "relief/mesh/shapes.h"

namespace relief {
namespace {

RayMesh ray_mesh(const Mesh& mesh) {
    return {mesh.positions, mesh.triangles};
}

/// A disc of radius 1 that faces the z axis, of so many sides; its area is that of the circle.
Mesh disc(float height, double aside = 0.0, int sides = 512) {
    const double angle = 2.0 * std::numbers::pi / sides;
    const double radius = std::sqrt(angle / std::sin(angle));
    Mesh mesh;
    mesh.positions.emplace_back(aside, 0, height);
    for (int i = 0; i < sides; ++i) {
        mesh.positions.emplace_back(aside + radius * std::cos(i * angle),
                                    radius * std::sin(i * angle), height);
        const auto here = static_cast<std::uint32_t>(i);
        mesh.triangles.emplace_back(0, here + 1,
                                    (here + 1) % static_cast<std::uint32_t>(sides) + 1);
    }
    return mesh;
}

/// The same place for so many texels of a map, each of which looks in directions of its own.
std::vector<OcclusionPlace> from_origin(std::size_t texels, std::uint32_t samples = 1) {
    std::vector<OcclusionPlace> places;
    for (std::size_t texel = 0; texel < texels; ++texel) {
        for (std::uint32_t sample = 0; sample < samples; ++sample)
            places.push_back({glm::dvec3(0), {0, 0, 1}, {0, 0, 1}, texel, sample});
    }
    return places;
}

struct OcclusionError {
    double root_mean_square = 0.0;
    double mean = 0.0;
};

OcclusionError error_of(const std::vector<double>& shares, double ground_truth) {
    OcclusionError error;
    for (const double share : shares) {
        error.mean += (share - ground_truth) / static_cast<double>(shares.size());
        error.root_mean_square +=
            (share - ground_truth) * (share - ground_truth) / static_cast<double>(shares.size());
    }
    error.root_mean_square = std::sqrt(error.root_mean_square);
    return error;
}

OcclusionOptions rays(int count, double distance = 10.0) {
    return {.rays = count, .distance = distance};
}

/// What the origin sees beside such a disc; the configuration factor of a disc parallel to an
/// element, in closed form.
double open_beside(double height, double aside) {
    const double away = height * height + aside * aside;
    const double z = 1.0 + away;
    return 1.0 - 0.5 * (1.0 - (away - 1.0) / std::sqrt(z * z - 4.0 * aside * aside));
}

TEST(Occlusion, UnderADiscIsItsClosedForm) {
    Report report;
    EXPECT_DOUBLE_EQ(open_beside(2.0, 0.0), 0.8);
    for (const auto& [height, aside] : {std::pair(0.5F, 0.0), {1.0F, 0.3}, {2.0F, 1.5}}) {
        const Mesh mesh = disc(height, aside);
        const RayScene scene({ray_mesh(mesh)});
        const double ground_truth = open_beside(double{height}, aside);
        const auto shares = Occlusion(rays(256), 1).open_shares(scene, from_origin(500), report);
        EXPECT_LT(error_of(shares, ground_truth).root_mean_square, 0.009) << height;
        EXPECT_NEAR(error_of(shares, ground_truth).mean, 0.0, 0.001) << height;
        // What is further away than rays run hides nothing.
        const auto near =
            Occlusion(rays(64, 0.9 * height), 1).open_shares(scene, from_origin(10), report);
        EXPECT_EQ(error_of(near, 1.0).root_mean_square, 0.0);
    }
    EXPECT_TRUE(report.empty());
}

TEST(Occlusion, ErrorFallsFasterThanThatOfRaysAtRandom) {
    const Mesh mesh = disc(0.8F, 0.6);
    const RayScene scene({ray_mesh(mesh)});
    const double ground_truth = open_beside(0.8F, 0.6);
    Report report;
    double before = 0.0;
    for (const int count : {4, 64, 1024}) {
        const auto shares = Occlusion(rays(count), 1).open_shares(scene, from_origin(1000), report);
        const double error = error_of(shares, ground_truth).root_mean_square;
        // At random it would be nearly 0.5 / sqrt(count), and fall to a quarter for 16 times as
        // many; here it falls to an eighth, for rays that meet a border in the disc of directions.
        EXPECT_LT(error, 0.5 / std::sqrt(count));
        if (before > 0.0) {
            EXPECT_LT(error, 0.16 * before) << count;
        }
        before = error;
    }
    EXPECT_LT(before, 0.003);
}

TEST(Occlusion, SamplesShareTheRaysOfATexel) {
    const Mesh mesh = disc(1.0F);
    const RayScene scene({ray_mesh(mesh)});
    Report report;
    const Occlusion shared(rays(256), 16);
    EXPECT_EQ(shared.rays_of_sample(), 16U);
    EXPECT_EQ(Occlusion(rays(20), 16).rays_of_sample(), 2U);
    const auto shares = shared.open_shares(scene, from_origin(500, 16), report);
    std::vector<double> means;
    for (std::size_t texel = 0; texel < 500; ++texel) {
        double sum = 0.0;
        for (std::size_t sample = 0; sample < 16; ++sample)
            sum += shares[16 * texel + sample] / 16.0;
        means.push_back(sum);
    }
    // As good as those of one sample that casts them all.
    EXPECT_LT(error_of(means, 0.5).root_mean_square, 0.009);
}

TEST(Occlusion, EveryPlaceInABowlSeesTheShareOfTheSphereThatIsMissing) {
    // A sphere's inner side, cut off above y = 0 and above y = 0.5.
    for (const int kept : {32, 48}) {
        constexpr int stacks = 64;
        Mesh mesh = make_sphere(128, stacks);
        std::erase_if(mesh.triangles, [&](const glm::uvec3& triangle) {
            const float height = mesh.positions[triangle.x].y + mesh.positions[triangle.y].y +
                                 mesh.positions[triangle.z].y;
            return height > 3.0F * std::cos(std::numbers::pi_v<float> *
                                            static_cast<float>(stacks - kept) / stacks);
        });
        const RayScene scene({ray_mesh(mesh)});
        std::vector<OcclusionPlace> places;
        for (std::size_t i = 0; i < mesh.triangles.size(); i += 5) {
            const auto corners = scene.corners(0, static_cast<std::uint32_t>(i));
            const glm::dvec3 middle = (corners[0] + corners[1] + corners[2]) / 3.0;
            const glm::dvec3 cross = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
            if (glm::length(cross) < 1e-9) continue;
            places.push_back({middle, -glm::normalize(middle), -glm::normalize(cross), i, 0});
        }
        Report report;
        const double open = 0.5 * (1.0 - std::cos(std::numbers::pi * (stacks - kept) / stacks));
        const auto shares = Occlusion(rays(256), 1).open_shares(scene, places, report);
        EXPECT_LT(error_of(shares, open).root_mean_square, 0.02) << kept;
        EXPECT_NEAR(error_of(shares, open).mean, 0.0, 0.003) << kept;
    }
}

TEST(Occlusion, NothingHidesItself) {
    // A coarse sphere whose smooth normals lean by up to 20 degrees out of its triangles; and twice
    // the same square.
    Report report;
    const Mesh sphere = make_sphere(12, 8);
    const RayScene round({ray_mesh(sphere)});
    std::vector<OcclusionPlace> places;
    for (std::size_t i = 0; i < sphere.triangles.size(); ++i) {
        const auto corners = round.corners(0, static_cast<std::uint32_t>(i));
        const glm::dvec3 cross = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
        if (glm::length(cross) < 1e-9) continue;
        for (const glm::dvec3& weights :
             {glm::dvec3(0.98, 0.01, 0.01), glm::dvec3(0.3, 0.3, 0.4), glm::dvec3(0, 0.5, 0.5)}) {
            const glm::dvec3 point =
                weights.x * corners[0] + weights.y * corners[1] + weights.z * corners[2];
            places.push_back({point, glm::normalize(point), glm::normalize(cross), i, 0});
        }
    }
    for (const double share : Occlusion(rays(64), 1).open_shares(round, places, report))
        EXPECT_EQ(share, 1.0);
    const Mesh square = make_quad(3);
    const RayScene twice({ray_mesh(square), ray_mesh(square)});
    for (const double share : Occlusion(rays(64), 1).open_shares(twice, from_origin(50), report))
        EXPECT_EQ(share, 1.0);
    EXPECT_TRUE(report.empty());
}

TEST(Occlusion, AboutATriangleWhereTheNormalIsOfNoUse) {
    const Mesh mesh = disc(1.0F);
    const RayScene scene({ray_mesh(mesh)});
    std::vector<OcclusionPlace> places = from_origin(300);
    for (std::size_t i = 0; i < places.size(); ++i)
        places[i].normal = i % 2 == 0 ? glm::dvec3(0, 0, -1) : glm::dvec3(1, 0, 0);
    Report report;
    const auto shares = Occlusion(rays(64), 1).open_shares(scene, places, report);
    EXPECT_EQ(report.count("normal along its triangle or behind it"), 300U);
    EXPECT_NEAR(error_of(shares, 0.5).mean, 0.0, 0.01);
}

}  // namespace
}  // namespace relief
