// SPDX-License-Identifier: Apache-2.0
// Meshes far from 0: every format keeps the digits that it is written with, and gives them back.
#include "io/mesh/far_positions.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "mesh_text_test.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/normals.h"
#include "support/angle.h"

namespace relief {
namespace {

class FarPositions : public test::MeshTextTest {
  protected:
    FarPositions() : MeshTextTest("a.obj") {}

    MeshFile read_as(const std::string& name, const std::string& bytes) {
        report_ = {};
        return read_mesh(write(name, bytes), report_);
    }
};

/// A roof of 1 by 1, its ridge 0.25 high, as far from 0 as `far` in every coordinate.
const std::vector<glm::dvec3> roof = {{0, 0, 0.001}, {0.5, 0, 0.25}, {0.5, 1, 0.25},
                                      {0, 1, 0.002}, {1, 0, 0.003},  {1, 1, 0.004}};
const std::vector<glm::uvec3> far_faces = {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}};

std::string obj_text(double far, double scale = 1.0) {
    std::string text;
    for (const glm::dvec3& p : roof)
        text +=
            fmt::format("v {} {} {}\n", far + scale * p.x, far + scale * p.y, far + scale * p.z);
    for (const glm::uvec3& f : far_faces)
        text += fmt::format("f {} {} {}\n", f.x + 1, f.y + 1, f.z + 1);
    return text;
}

std::string off_text(double far) {
    std::string text = "OFF\n6 4 0\n";
    for (const glm::dvec3& p : roof)
        text += fmt::format("{} {} {}\n", far + p.x, far + p.y, far + p.z);
    for (const glm::uvec3& f : far_faces)
        text += fmt::format("3 {} {} {}\n", f.x, f.y, f.z);
    return text;
}

std::string ply_text(double far) {
    std::string text =
        "ply\nformat ascii 1.0\nelement vertex 6\nproperty double x\nproperty double y\n"
        "property double z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n";
    for (const glm::dvec3& p : roof)
        text += fmt::format("{} {} {}\n", far + p.x, far + p.y, far + p.z);
    for (const glm::uvec3& f : far_faces)
        text += fmt::format("3 {} {} {}\n", f.x, f.y, f.z);
    return text;
}

std::string stl_text(double far) {
    std::string text = "solid a\n";
    for (const glm::uvec3& f : far_faces) {
        text += "facet normal 0 0 0\nouter loop\n";
        for (int i = 0; i < 3; ++i) {
            const glm::dvec3& p = roof[f[i]];
            text += fmt::format("vertex {} {} {}\n", far + p.x, far + p.y, far + p.z);
        }
        text += "endloop\nendfacet\n";
    }
    return text + "endsolid a\n";
}

std::vector<glm::vec3> normals_of(const Mesh& mesh) {
    Report report;
    return vertex_normals(mesh.positions, mesh.triangles, NormalWeight::angle, report);
}

TEST_F(FarPositions, AreReadInDoubleFromEveryTextFormat) {
    const std::vector<glm::vec3> expected = normals_of(read_as("near.obj", obj_text(0.0)).mesh);
    for (const double far : {1e5, 4e6, 1e8}) {
        for (const auto& [name, text] : {std::pair{"a.obj", obj_text(far)},
                                         {"a.off", off_text(far)},
                                         {"a.ply", ply_text(far)}}) {
            const MeshFile file = read_as(name, text);
            EXPECT_EQ(report_.count("far from the origin"), 1U) << name;
            ASSERT_EQ(file.mesh.positions.size(), 6U);
            const std::vector<glm::vec3> normals = normals_of(file.mesh);
            for (std::size_t v = 0; v < 6; ++v) {
                const glm::dvec3 back = glm::dvec3(file.mesh.positions[v]) + file.origin;
                // Doubles of 1e8 are 1.5e-8 apart, floats of 1 are 6e-8.
                EXPECT_LE(glm::distance(back, glm::dvec3(far) + roof[v]), 1e-7)
                    << name << " " << far;
                EXPECT_LE(test::degrees_between(normals[v], expected[v]), 2e-5)
                    << name << " " << far;
            }
        }
        const MeshFile stl = read_as("a.stl", stl_text(far));
        EXPECT_EQ(stl.mesh.positions.size(), 6U) << "corners that floats would have merged";
        EXPECT_EQ(stl.mesh.triangles.size(), 4U);
    }
}

TEST_F(FarPositions, OfAMeshThatFloatsPutIntoOnePlaceAreToldApart) {
    const MeshFile file = read_as("a.obj", obj_text(1e7, 1e-3));
    const std::vector<glm::vec3> expected = normals_of(read_as("near.obj", obj_text(0.0)).mesh);
    const std::vector<glm::vec3> normals = normals_of(file.mesh);
    for (std::size_t v = 0; v < 6; ++v) {
        // Doubles of 1e7 are 1.9e-9 apart: 2e-6 of the roof's size.
        EXPECT_LE(test::degrees_between(normals[v], expected[v]), 1e-3);
    }
}

TEST_F(FarPositions, StayAsTheyAreWhereFloatsHoldThem) {
    std::string text;
    for (const glm::dvec3& p : roof)
        text += fmt::format("v {} {} {}\n", 524288.0 + 2.0 * p.x, 524288.0 + p.y, 0.25);
    text += "f 1 2 5\n";
    const MeshFile whole = read_as("a.obj", text);
    EXPECT_EQ(whole.origin, glm::dvec3(0.0));
    EXPECT_TRUE(report_.empty());
    EXPECT_EQ(whole.mesh.positions[1], glm::vec3(524289.0F, 524288.0F, 0.25F));
    EXPECT_EQ(read_as("b.obj", obj_text(10.0)).origin, glm::dvec3(0.0)) << "not far for its size";
    EXPECT_EQ(read_as("c.obj", "v nan 0 0\nv inf 1 0\nv 0 nan 1\nf 1 2 3\n").origin,
              glm::dvec3(0.0));
}

TEST_F(FarPositions, ComeBackWhenWritten) {
    const MeshFile file = read_as("a.obj", obj_text(4e6));
    for (const char* name : {"b.obj", "b.ply"}) {
        write_mesh(folder_ / name, file);
        const MeshFile again = read_mesh(folder_ / name, report_);
        EXPECT_EQ(again.origin, file.origin) << name;
        EXPECT_EQ(again.mesh.positions, file.mesh.positions) << name;
    }
    GltfDocument::from_mesh(file).write(folder_ / "b.gltf");
    const GltfDocument document = GltfDocument::read(folder_ / "b.gltf", report_);
    EXPECT_EQ(document.mesh({0, 0}).positions, file.mesh.positions);
    EXPECT_EQ(document.view().nodes[0].translation, glm::vec3(file.origin));
}

TEST_F(FarPositions, FindingsAreCountedOnce) {
    const MeshFile file = read_as("a.obj", obj_text(4e6) + "p 1\nl 1 2\n");
    EXPECT_NE(file.origin, glm::dvec3(0.0));
    EXPECT_EQ(report_.count("point"), 1U);
    EXPECT_EQ(report_.count("line"), 1U);
}

}  // namespace
}  // namespace relief
