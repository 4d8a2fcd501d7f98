// SPDX-License-Identifier: Apache-2.0
// Unwrapping of hard input: every mesh has a result, and the order of triangles, vertices and
// corners, and the number of threads, change no bit of it.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "hard_cases/mesh_changes.h"
#include "hard_cases/random_meshes.h"
#include "mesh/atlas/hard_unwrap_meshes.h"
#include "mesh/atlas/unwrap_promises.h"
#include "relief/mesh/unwrap.h"
#include "support/hard_meshes.h"
#include "support/invariants.h"
#include "support/sanitized.h"
#include "support/shapes.h"

namespace relief {
namespace {

using test::broken_promise;
using test::Dice;
using test::MeshVariant;

TEST(Unwrap, HasAResultForEveryMesh) {
    std::vector<test::NamedMesh> meshes = test::hard_meshes();
    for (std::uint32_t seed = 0; seed < (test::is_sanitized ? 8 : 60); ++seed) {
        meshes.push_back({"random " + std::to_string(seed), test::random_mesh(seed)});
        meshes.push_back({"hostile " + std::to_string(seed), test::hostile_mesh(seed)});
    }
    meshes.push_back({"empty", {}});
    UnwrapOptions options;
    options.size = {512, 512};
    options.padding = 1;
    UnwrapOptions conformal = options;
    conformal.flattening = Flattening::conformal;
    for (std::size_t i = 0; i < meshes.size(); i += 3)
        EXPECT_EQ(broken_promise(unwrap(meshes[i].mesh, conformal)), "") << meshes[i].name;
    for (const auto& [name, mesh] : meshes) {
        Report report;
        const Unwrapped unwrapped = unwrap(mesh, options, report);
        EXPECT_EQ(broken_promise(unwrapped), "") << name;
        EXPECT_EQ(test::triangles_of(unwrapped).without_chart,
                  report.count("triangle without area") +
                      report.count("triangle with a non-finite corner"))
            << name;
        const FramedMesh framed = with_texcoords(mesh, unwrapped);
        ASSERT_EQ(framed.mesh.triangles.size(), mesh.triangles.size()) << name;
        for (std::size_t corner = 0; corner < 3 * mesh.triangles.size(); ++corner) {
            const std::uint32_t vertex = test::vertex_at(framed.mesh, corner);
            EXPECT_EQ(framed.source_vertex[vertex], test::vertex_at(mesh, corner)) << name;
            EXPECT_EQ(framed.mesh.texcoords[vertex], unwrapped.corner_texcoords[corner]) << name;
        }
    }
}

TEST(Unwrap, HandlesHardTopology) {
    UnwrapOptions options;
    options.padding = 1;
    const Unwrapped strip = unwrap(test::moebius_strip(200), options);
    EXPECT_EQ(broken_promise(strip), "");
    EXPECT_LE(strip.stats.charts, 8U);
    EXPECT_EQ(broken_promise(unwrap(test::fan(1000), options)), "");
    Report report;
    EXPECT_EQ(broken_promise(unwrap(test::book(500), options, report)), "");
    EXPECT_EQ(report.count("edge of more than two triangles, or of two in one direction"), 1U);
    const Unwrapped thin = unwrap(test::separate_slivers(1000, 1e-4F), options);
    EXPECT_EQ(broken_promise(thin), "");
    EXPECT_EQ(thin.stats.charts, 1000U);
}

// A strip of 12,000 slivers, which are longer than wide by a factor of 10,000.
TEST(Unwrap, JoinsSlivers) {
    const Unwrapped unwrapped = unwrap(test::sliver_strip(6000, 1e-4, false));
    EXPECT_EQ(unwrapped.stats.charts, 1U);
    EXPECT_NEAR(unwrapped.stats.stretch, 1.0, 1e-3);
}

// A surface that covers itself twice is divided, and so is one whose flat image would overlap.
TEST(Unwrap, DividesASpiralStaircase) {
    Mesh mesh;
    constexpr std::uint32_t steps = 200;
    for (std::uint32_t i = 0; i <= steps; ++i) {
        const double turn = 6.0 * std::numbers::pi * i / steps;
        for (const double radius : {0.5, 1.0})
            mesh.positions.emplace_back(radius * std::cos(turn), radius * std::sin(turn),
                                        0.002 * i);
    }
    for (std::uint32_t i = 0; i < steps; ++i) {
        mesh.triangles.emplace_back(2 * i, 2 * i + 1, 2 * i + 3);
        mesh.triangles.emplace_back(2 * i, 2 * i + 3, 2 * i + 2);
    }
    const Unwrapped unwrapped = unwrap(mesh);
    EXPECT_EQ(broken_promise(unwrapped), "");
    EXPECT_GE(unwrapped.stats.charts, 3U) << "three turns above each other";
    EXPECT_LE(unwrapped.stats.charts, 18U) << "each turn is cut";
}

class UnwrapChanges : public testing::TestWithParam<test::MeshChange> {};

TEST_P(UnwrapChanges, ChangeNoCoordinate) {
    UnwrapOptions options;
    options.size = {256, 256};
    options.padding = 1;
    // The changes have the same meshes, so that cases of one process unwrap each mesh only once.
    static std::map<std::uint32_t, Unwrapped> unwrapped_meshes;
    Dice dice(47);
    for (std::uint32_t seed = 0; seed < (test::is_sanitized ? 12 : 25); ++seed) {
        const Mesh mesh = test::random_mesh(seed);
        MeshVariant variant(mesh);
        GetParam().apply(variant, dice);
        options.flattening = seed % 2 == 0 ? Flattening::arap : Flattening::conformal;
        const auto [place, is_new] = unwrapped_meshes.try_emplace(seed);
        if (is_new) place->second = unwrap(mesh, options);
        const Unwrapped& before = place->second;
        const Unwrapped after = unwrap(variant.mesh, options);
        for (std::size_t corner = 0; corner < variant.original.size(); ++corner) {
            const std::uint32_t original = variant.original[corner];
            if (original == MeshVariant::added) continue;
            ASSERT_EQ(after.corner_texcoords[corner], before.corner_texcoords[original])
                << "mesh " << seed << ", corner " << corner;
        }
        EXPECT_EQ(after.stats.charts, before.stats.charts);
    }
}

INSTANTIATE_TEST_SUITE_P(Unwrap, UnwrapChanges, testing::ValuesIn(test::tested_changes),
                         [](const auto& instance) { return std::string(instance.param.name); });

TEST(Unwrap, DoesNotDependOnThreads) {
    const Mesh torus = make_torus(0.4F, 48, 24);
    UnwrapOptions options;
    options.execution.threads = 1;
    const Unwrapped one = unwrap(torus, options);
    options.execution.threads = 7;
    const Unwrapped many = unwrap(torus, options);
    EXPECT_TRUE(test::same_bits(one.corner_texcoords, many.corner_texcoords));
    options.flattening = Flattening::conformal;
    const Unwrapped many_conformal = unwrap(torus, options);
    options.execution.threads = 1;
    const Unwrapped one_conformal = unwrap(torus, options);
    EXPECT_TRUE(test::same_bits(one_conformal.corner_texcoords, many_conformal.corner_texcoords));
    EXPECT_FALSE(test::same_bits(one.corner_texcoords, one_conformal.corner_texcoords));
}

}  // namespace
}  // namespace relief
