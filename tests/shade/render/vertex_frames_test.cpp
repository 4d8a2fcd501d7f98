// SPDX-License-Identifier: Apache-2.0
// Frames as lines, by hand: where they begin and end, scaled, mirrored and far away.
#include "render/overlays.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace relief {
namespace {

Mesh one_vertex() {
    Mesh mesh;
    mesh.positions = {{1, 2, 3}};
    mesh.normals = {{0, 0, 1}};
    mesh.tangents = {{1, 0, 0, 1}};
    return mesh;
}

VertexFrameLines lines_of(const Mesh& mesh, const glm::mat4& place, const glm::dvec3& center = {}) {
    VertexFrameLines lines;
    add_vertex_frames(mesh, place, center, 0.5, lines);
    return lines;
}

using Line = std::vector<glm::vec3>;

TEST(VertexFrames, StartAtTheVertexAndHaveTheLength) {
    const VertexFrameLines lines = lines_of(one_vertex(), glm::mat4(1.0F), {1, 1, 1});
    EXPECT_EQ(lines.tangents, (Line{{0, 1, 2}, {0.5F, 1, 2}}));
    EXPECT_EQ(lines.bitangents, (Line{{0, 1, 2}, {0, 1.5F, 2}}));
    EXPECT_EQ(lines.normals, (Line{{0, 1, 2}, {0, 1, 2.5F}}));
}

TEST(VertexFrames, KeepTheirLengthUnderScaleAndTurnRoundUnderMirrors) {
    glm::mat4 place(1.0F);
    place[0][0] = -4.0F;
    const VertexFrameLines lines = lines_of(one_vertex(), place);
    EXPECT_EQ(lines.tangents, (Line{{-4, 2, 3}, {-4.5F, 2, 3}}));
    EXPECT_EQ(lines.bitangents, (Line{{-4, 2, 3}, {-4, 2.5F, 3}})) << "still up in the image";
    EXPECT_EQ(lines.normals, (Line{{-4, 2, 3}, {-4, 2, 3.5F}}));
}

TEST(VertexFrames, StayPreciseFarFromTheOrigin) {
    Mesh mesh = one_vertex();
    mesh.positions = {{0.125F, 0, 0}};
    glm::mat4 place(1.0F);
    place[3] = {1e8F, 0, 0, 1};
    const VertexFrameLines lines = lines_of(mesh, place, {1e8, 0, 0});
    EXPECT_EQ(lines.tangents, (Line{{0.125F, 0, 0}, {0.625F, 0, 0}}));
}

TEST(VertexFrames, LeaveOutWhatIsNowhereOrHasNoDirection) {
    Mesh mesh = one_vertex();
    mesh.positions.push_back({std::numeric_limits<float>::quiet_NaN(), 0, 0});
    mesh.normals.push_back({0, 0, 1});
    mesh.tangents.push_back({1, 0, 0, 1});
    mesh.positions.push_back({0, 0, 0});
    mesh.normals.push_back({0, 0, 0});
    mesh.tangents.push_back({1, 0, 0, 1});
    const VertexFrameLines lines = lines_of(mesh, glm::mat4(1.0F));
    EXPECT_EQ(lines.normals.size(), 2U);
    EXPECT_EQ(lines.tangents.size(), 4U);
    EXPECT_EQ(lines.bitangents.size(), 2U);
    mesh.tangents.clear();
    EXPECT_TRUE(lines_of(mesh, glm::mat4(1.0F)).tangents.empty());
}

}  // namespace
}  // namespace relief
