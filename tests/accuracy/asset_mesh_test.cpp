// SPDX-License-Identifier: Apache-2.0
// Experiments on a mesh whose exact surface is known: their results must agree with it.
#include "relief/accuracy/asset.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/trigonometric.hpp>
#include <numbers>

#include "asset_report.h"
#include "experiment_checks.h"
#include "experiment_driver.h"
#include "experiment_parts.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/report.h"
#include "support/invariants.h"
#include "support/shapes.h"

namespace relief {
using namespace relief::accuracy;
using namespace relief::accuracy::detail;

namespace {

using test::found;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

const AssetOptions untimed_mesh = test::untimed_asset("vase.obj");

AssetExperiment normals_of(const Mesh& mesh, const AssetMeshOptions& how = {}) {
    return measure_asset_mesh(mesh, how, untimed_mesh).front();
}

TEST(AssetNormals, FittedSurfaceAgreesWithTheKnownOne) {
    const AnalyticMesh ground_truth =
        analytic_mesh(AnalyticSurface::torus, Triangulation::jittered, 48, 1);
    const AssetExperiment own = normals_of(ground_truth.mesh);
    for (const NormalMethod& method : normal_methods(std::array{Arithmetic::float64})) {
        const double exact = normal_errors(method.compute(ground_truth.mesh), ground_truth).rms;
        EXPECT_NEAR(found(own, method.choices.front().second).error.rms, exact, 0.02 * exact)
            << method.name;
    }
    EXPECT_EQ(found(own, "max").error.count, ground_truth.mesh.positions.size());
    EXPECT_EQ(own.command(), "relief-mesh process vase.obj -o OUT.glb --normals max");
    EXPECT_THAT(own.experiment.ground_truth, HasSubstr("2304 of 2304 examined vertices"));
    EXPECT_THAT(own.experiment.finding, HasSubstr(". To do it: relief-mesh process"));
}

TEST(AssetNormals, ErrorOfAWrongMethodIsMeasured) {
    AnalyticMesh ground_truth =
        analytic_mesh(AnalyticSurface::saddle, Triangulation::regular, 48, 1);
    // The file's normals: exact ones, each rotated by one degree about a perpendicular axis.
    for (const glm::dvec3& normal : ground_truth.normals) {
        const glm::dvec3 across = glm::normalize(glm::cross(normal, glm::dvec3(0.3, 0.5, 0.7)));
        ground_truth.mesh.normals.emplace_back(std::cos(glm::radians(1.0)) * normal +
                                               std::sin(glm::radians(1.0)) * across);
    }
    const AssetExperiment own = normals_of(ground_truth.mesh);
    EXPECT_NEAR(found(own, "the file's own").error.rms, 1.0, 0.001);
    EXPECT_NEAR(found(own, "the file's own").error.max, 1.0, 0.03);
    EXPECT_FALSE(own.command().empty());
}

TEST(AssetNormals, FileNormalsCanBeTheGroundTruth) {
    Mesh mesh = test::sphere(24, 16);
    Report report;
    mesh.normals = vertex_normals(mesh.positions, mesh.triangles, NormalWeight::area, report);
    AssetMeshOptions how;
    how.ground_truth = NormalReference::file;
    const AssetExperiment own = normals_of(mesh, how);
    EXPECT_EQ(found(own, "area").error.max, 0.0);
    EXPECT_GT(found(own, "uniform").error.rms, 0.01);
    EXPECT_EQ(own.command(), "relief-mesh process vase.obj -o OUT.glb --normals area");
    mesh.normals.clear();
    EXPECT_EQ(test::message_of<InvalidInput>([&] { normals_of(mesh, how); }),
              "the mesh has no normals to compare with");
}

/// A prism with caps: smooth around, with two sharp rims, without normals.
Mesh capped_cylinder(int sides, int rings) {
    Mesh mesh;
    const auto at = [&](int ring, int side) {
        return static_cast<std::uint32_t>(ring * sides + side % sides);
    };
    for (int ring = 0; ring <= rings; ++ring) {
        for (int side = 0; side < sides; ++side) {
            const double angle = 2.0 * std::numbers::pi * side / sides;
            mesh.positions.emplace_back(std::cos(angle), 2.0 * ring / rings, std::sin(angle));
        }
    }
    for (int ring = 0; ring < rings; ++ring) {
        for (int side = 0; side < sides; ++side) {
            mesh.triangles.emplace_back(at(ring, side), at(ring + 1, side), at(ring, side + 1));
            mesh.triangles.emplace_back(at(ring, side + 1), at(ring + 1, side),
                                        at(ring + 1, side + 1));
        }
    }
    for (const int ring : {0, rings}) {
        const auto center = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.emplace_back(0.0F, ring == 0 ? 0.0F : 2.0F, 0.0F);
        for (int side = 0; side < sides; ++side) {
            if (ring == 0)
                mesh.triangles.emplace_back(center, at(ring, side), at(ring, side + 1));
            else
                mesh.triangles.emplace_back(center, at(ring, side + 1), at(ring, side));
        }
    }
    return mesh;
}

TEST(AssetNormals, ReportVerticesWithoutGroundTruth) {
    const AssetExperiment smooth = normals_of(capped_cylinder(32, 16));
    EXPECT_THAT(smooth.recommendation.description, HasSubstr("of the vertices are not judged"));
    EXPECT_THAT(smooth.recommendation.description,
                HasSubstr("(if the mesh has hard edges, try --crease 40)"));
    EXPECT_THAT(smooth.experiment.finding, HasSubstr("of the vertices are not judged"));
    AssetMeshOptions how;
    how.crease_angle = glm::radians(40.0);
    EXPECT_THAT(normals_of(capped_cylinder(32, 16), how).recommendation.description,
                Not(HasSubstr("try --crease")));
    const AnalyticMesh whole =
        analytic_mesh(AnalyticSurface::torus, Triangulation::jittered, 48, 1);
    EXPECT_THAT(normals_of(whole.mesh).recommendation.description, Not(HasSubstr("not judged")));
}

TEST(AssetNormals, ListMethodsWithinTheUncertaintyOfTheReference) {
    // On a coarse mesh, the error of the fitted surface exceeds the differences of some methods.
    const AnalyticMesh coarse =
        analytic_mesh(AnalyticSurface::torus, Triangulation::jittered, 12, 1);
    const AssetExperiment own = normals_of(coarse.mesh);
    ASSERT_TRUE(own.recommendation.method.has_value());
    const double reference = own.experiment.reference_error.value();
    EXPECT_GT(reference, 0.0);
    const Measurement& taken = own.experiment.measurements[*own.recommendation.method];
    std::size_t alike = 0;
    for (const Measurement& one : own.experiment.measurements) {
        const bool is_alike =
            one.method != taken.method && std::abs(one.error.rms - taken.error.rms) < reference;
        alike += is_alike ? 1 : 0;
        EXPECT_NEAR(one.expected.value().total(), std::hypot(reference, one.error.rms), 1e-12);
    }
    ASSERT_GT(alike, 0U);
    EXPECT_THAT(own.recommendation.description, HasSubstr("; not told apart from "));
    EXPECT_THAT(own.recommendation.description,
                HasSubstr(" degrees RMS expected (the fitted surface itself "));
}

TEST(AssetNormals, AreThoseThatTheToolComputes) {
    for (const Measurement& one : normals_of(test::sphere(24, 16)).experiment.measurements)
        EXPECT_THAT(one.method, Not(HasSubstr("float"))) << "relief-mesh has no such option";
}

TEST(AssetNormals, RecommendNoMethodWithoutASurface) {
    const AssetExperiment own = normals_of(test::cube());
    EXPECT_EQ(own.recommendation.method, std::nullopt);
    EXPECT_THAT(own.recommendation.description, HasSubstr("too coarse"));
    EXPECT_TRUE(own.command().empty());
}

TEST(CreaseRule, IsTheRequestedOneOrThatOfTheFile) {
    Mesh mesh = test::cube();
    const CreaseRule by_normals = crease_rule(mesh, std::nullopt);
    EXPECT_NEAR(by_normals.edges.crease_angle.value(), glm::radians(45.0), 1e-9);
    EXPECT_EQ(
        by_normals.description,
        "edges sharper than 45 degrees are hard, which agrees with the stored normals at 100% of "
        "the edges");
    EXPECT_EQ(by_normals.option, " --crease 45");
    EXPECT_EQ(crease_rule(mesh, glm::radians(30.0)).option, " --crease 30");
    EXPECT_FALSE(crease_rule(mesh, std::numbers::pi).has_any());
    mesh.smoothing_groups.assign(mesh.triangles.size(), 0);
    EXPECT_TRUE(crease_rule(mesh, std::nullopt).edges.smoothing_groups.empty());  // Not said.
    mesh.smoothing_groups.front() = 1;
    EXPECT_FALSE(crease_rule(mesh, std::nullopt).edges.smoothing_groups.empty());
    EXPECT_EQ(crease_rule(mesh, glm::radians(30.0)).option,
              " --crease 30 --ignore-smoothing-groups");
    mesh = test::sphere(8, 6);
    EXPECT_EQ(crease_rule(mesh, std::nullopt).description, "no edge is hard");
    mesh.normals.clear();
    EXPECT_FALSE(crease_rule(mesh, std::nullopt).has_any());
}

TEST(AssetTangents, AreFromTheImagesOwnDirectionAndFromMikktspace) {
    const TexturedMesh ground_truth = textured_mesh(AnalyticSurface::torus, Triangulation::jittered,
                                                    TextureLayout::upright, 24, 1);
    const std::vector<AssetExperiment> all =
        measure_asset_mesh(ground_truth.mesh, {}, untimed_mesh);
    ASSERT_THAT(all, SizeIs(4));
    EXPECT_EQ(all[1].experiment.id, "own/vase.obj/tangents");
    EXPECT_GT(found(all[1], "mikktspace").error.rms, 0.1);
    EXPECT_LT(found(all[1], "mikktspace").error.rms, 10.0);
    EXPECT_EQ(all[1].command(), "relief-mesh process vase.obj -o OUT.glb --tangents mikktspace");
    EXPECT_EQ(all[2].experiment.id, "own/vase.obj/tangent-basis");
    EXPECT_EQ(found(all[2], "mikktspace").error.max, 0.0);
    EXPECT_GT(found(all[2], "lengyel").error.rms, 0.0);
    EXPECT_EQ(all[3].experiment.id, "own/vase.obj/frames");
    EXPECT_LE(found(all[3], "float32, nearest").error.max, 1e-4);
    EXPECT_GT(found(all[3], "octahedral8, nearest").error.rms, 0.1);
    EXPECT_THAT(all[3].command(), HasSubstr("encode_frames("));
}

TEST(AssetTangents, OnAFlatImageAreAllTheSame) {
    Mesh mesh = test::grid(6);
    mesh.tangents.assign(mesh.positions.size(), glm::vec4(1.0F, 0.0F, 0.0F, 1.0F));
    const std::vector<AssetExperiment> all = measure_asset_mesh(mesh, {}, untimed_mesh);
    for (const Measurement& one : all[1].experiment.measurements)
        EXPECT_LE(one.error.max, 1e-5) << one.method;
    EXPECT_LE(found(all[2], "the file's own").error.max, 1e-5);
    for (glm::vec4& tangent : mesh.tangents)
        tangent = {0.0F, 1.0F, 0.0F, 1.0F};
    EXPECT_NEAR(found(measure_asset_mesh(mesh, {}, untimed_mesh)[1], "the file's own").error.rms,
                90.0, 1e-4);
}

TEST(AssetTangents, LeaveOutTrianglesWithoutADirection) {
    Mesh mesh = test::grid(4);
    mesh.texcoords.assign(mesh.positions.size(), glm::vec2(0.5F));
    const std::vector<AssetExperiment> all = measure_asset_mesh(mesh, {}, untimed_mesh);
    EXPECT_THAT(all[1].experiment.input, HasSubstr("(32 have no texture gradient)"));
    EXPECT_EQ(all[1].recommendation.method, std::nullopt);
}

TEST(AssetMesh, LargeMeshIsMeasuredOnEightRuns) {
    const Mesh mesh = test::grid(32);
    EXPECT_THAT(part_to_measure(mesh, 10000).triangles, SizeIs(2048));
    const Mesh part = part_to_measure(mesh, 160);
    EXPECT_THAT(part.triangles, SizeIs(160));
    EXPECT_EQ(part.positions[part.triangles.back().z], mesh.positions[mesh.triangles.back().z]);
    AssetMeshOptions how;
    how.max_triangles = 160;
    EXPECT_EQ(normals_of(mesh, how).experiment.input,
              "160 triangles, eight ranges of the 2048 of the mesh");
}

TEST(AssetMesh, IsTimedAndRecommendedByTime) {
    AssetOptions options = untimed_mesh;
    options.run.is_timed = true;
    options.run.repeats = {3, 0};
    options.costs = {.one_thread = true, .all_threads = false, .memory = false};
    const AnalyticMesh ground_truth =
        analytic_mesh(AnalyticSurface::torus, Triangulation::jittered, 16, 1);
    options.request.max_error = 1e-6;
    const AssetExperiment own = measure_asset_mesh(ground_truth.mesh, {}, options).front();
    EXPECT_THAT(found(own, "max").cost.one_thread.value().rounds, SizeIs(3));
    EXPECT_EQ(own.recommendation.method, std::nullopt);
    EXPECT_THAT(own.recommendation.description,
                HasSubstr("no method is within 1e-06 degrees (99 %)"));
}

TEST(AssetMesh, CanBeCancelled) {
    Progress progress;
    const ProgressScope scope(progress);
    progress.cancel();
    EXPECT_THROW(measure_asset_mesh(test::grid(4), {}, untimed_mesh), Cancelled);
    EXPECT_THROW(measure_asset_mesh(Mesh{}, {}, untimed_mesh), InvalidInput);
}

}  // namespace
}  // namespace relief
