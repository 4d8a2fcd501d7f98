// SPDX-License-Identifier: Apache-2.0
// Normals and tangents on the caller's memory: interleaved vertices, indices of 16 and 32 bits.
#include "relief/mesh/buffers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "relief/mesh/normals.h"
#include "relief/mesh/tangents.h"
#include "support/hard_meshes.h"
#include "support/message_of.h"
#include "support/shapes.h"

namespace relief {
namespace {

/// A vertex as engines store it, with fields that are not relief's.
struct Vertex {
    std::uint32_t color = 0xff00ff00U;
    glm::vec3 position;
    glm::vec2 texcoord;
    glm::vec3 normal;
    glm::vec4 tangent{};
    float weight = 0.25F;
};

struct VertexBuffer {
    explicit VertexBuffer(const Mesh& mesh) {
        for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
            vertices.push_back({.position = mesh.positions[v],
                                .texcoord = mesh.texcoords[v],
                                .normal = mesh.normals[v]});
        }
        for (const glm::uvec3& triangle : mesh.triangles) {
            for (int i = 0; i < 3; ++i)
                indices.push_back(static_cast<std::uint16_t>(triangle[i]));
        }
    }
    template <typename Value>
    StridedSpan<Value> all(Value Vertex::*field) {
        return {&(vertices.data()->*field), vertices.size(), sizeof(Vertex)};
    }
    [[nodiscard]] TriangleSpan triangles() const {
        return TriangleSpan(std::span<const std::uint16_t>(indices));
    }

    std::vector<Vertex> vertices;
    std::vector<std::uint16_t> indices;
};

template <typename Value>
std::vector<Value> copied(StridedSpan<Value> values) {
    std::vector<Value> copy;
    for (std::size_t i = 0; i < values.size(); ++i)
        copy.push_back(values[i]);
    return copy;
}

std::string text_of(const Report& report) {
    std::string text;
    for (const Finding& finding : report.findings())
        text += finding.kind + " " + std::to_string(finding.count) + "\n";
    return text;
}

TEST(Buffers, InterleavedVerticesAndShortIndicesGiveTheSameBitsAndFindings) {
    for (const auto& [name, mesh] : test::hard_meshes()) {
        SCOPED_TRACE(name);
        ASSERT_LT(mesh.positions.size(), 65536U);
        VertexBuffer buffer(mesh);
        Report report, buffer_report;
        const auto tangents = mikktspace_tangents(mesh.positions, mesh.normals, mesh.texcoords,
                                                  mesh.triangles, report);
        EXPECT_TRUE(test::same_bits(
            tangents,
            mikktspace_tangents(buffer.all(&Vertex::position), buffer.all(&Vertex::normal),
                                buffer.all(&Vertex::texcoord), buffer.triangles(), buffer_report)));
        for (const NormalWeight weight : {NormalWeight::area, NormalWeight::angle}) {
            NormalOptions options;
            options.weight = weight;
            const auto normals = vertex_normals(mesh.positions, mesh.triangles, options, report);
            vertex_normals(buffer.all(&Vertex::position), buffer.triangles(), options,
                           buffer.all(&Vertex::normal), &buffer_report);
            EXPECT_TRUE(test::same_bits(normals, copied(buffer.all(&Vertex::normal))));
        }
        EXPECT_EQ(text_of(buffer_report), text_of(report));
        for (const Vertex& vertex : buffer.vertices) {
            ASSERT_EQ(vertex.color, 0xff00ff00U);
            ASSERT_EQ(vertex.weight, 0.25F);
        }
    }
}

TEST(Buffers, LargeMeshesWithShortIndicesGiveTheSameBits) {
    // Full blocks of triangles take another path than the last ones.
    const Mesh mesh = test::sphere(200, 150);
    ASSERT_LT(mesh.positions.size(), 65536U);
    VertexBuffer buffer(mesh);
    Report report;
    const auto normals = vertex_normals(mesh.positions, mesh.triangles, NormalWeight::max, report);
    NormalOptions options;
    options.weight = NormalWeight::max;
    vertex_normals(buffer.all(&Vertex::position), buffer.triangles(), options,
                   buffer.all(&Vertex::normal));
    EXPECT_TRUE(test::same_bits(normals, copied(buffer.all(&Vertex::normal))));
}

TEST(Buffers, VertexTangentsAreThoseOfTheCorners) {
    const Mesh mesh = test::grid(8);
    VertexBuffer buffer(mesh);
    Report report;
    vertex_tangents(buffer.all(&Vertex::position), buffer.all(&Vertex::normal),
                    buffer.all(&Vertex::texcoord), buffer.triangles(), buffer.all(&Vertex::tangent),
                    &report);
    EXPECT_TRUE(report.empty());
    EXPECT_THAT(copied(buffer.all(&Vertex::tangent)),
                testing::Each(glm::vec4(1.0F, 0.0F, 0.0F, 1.0F)));
}

TEST(Buffers, VertexTangentsReportCornersThatDiffer) {
    // Two triangles with upright texture and one with mirrored texture share vertex 0.
    Mesh mesh = test::mesh_from({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}},
                                {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}});
    mesh.normals.assign(mesh.positions.size(), glm::vec3(0.0F, 0.0F, 1.0F));
    mesh.texcoords.clear();
    for (const glm::vec3& position : mesh.positions)
        mesh.texcoords.emplace_back(position.x, -position.y);
    // The third triangle gets vertices of its own on the rim, with u mirrored.
    for (int i = 1; i < 3; ++i) {
        const std::uint32_t from = mesh.triangles[2][i];
        mesh.triangles[2][i] = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.push_back(mesh.positions[from]);
        mesh.normals.push_back(mesh.normals[from]);
        mesh.texcoords.emplace_back(-mesh.texcoords[from].x, mesh.texcoords[from].y);
    }
    // A vertex without a triangle, beside vertex 4.
    mesh.positions.emplace_back(9.0F);
    mesh.normals.emplace_back(0.0F, 0.0F, 1.0F);
    mesh.texcoords.emplace_back(0.0F);

    std::vector<glm::vec4> tangents(mesh.positions.size());
    Report report;
    vertex_tangents(mesh.positions, mesh.normals, mesh.texcoords, mesh.triangles, tangents,
                    &report);
    EXPECT_EQ(tangents[mesh.triangles[0].x], glm::vec4(1.0F, 0.0F, 0.0F, 1.0F))
        << "two of three corners";
    EXPECT_EQ(tangents[mesh.triangles[2].y], glm::vec4(-1.0F, 0.0F, 0.0F, -1.0F));
    EXPECT_EQ(tangents.back(), glm::vec4(1.0F, 0.0F, 0.0F, -1.0F));
    EXPECT_EQ(text_of(report),
              "vertex whose corners have different tangents 1\nisolated vertex 2\n");
}

TEST(Buffers, RefuseMemoryOfAnotherSizeAndIndicesBeyondTheVertices) {
    const Mesh mesh = test::grid(1);
    std::vector<glm::vec3> normals(mesh.positions.size() - 1);
    std::vector<glm::vec4> tangents(mesh.positions.size() + 1);
    EXPECT_EQ(test::message_of<InvalidInput>([&] {
                  vertex_normals(mesh.positions, mesh.triangles, NormalOptions{}, normals);
              }),
              "there is memory for 3 normals, but there are 4 positions");
    EXPECT_EQ(test::message_of<InvalidInput>([&] {
                  vertex_tangents(mesh.positions, mesh.normals, mesh.texcoords, mesh.triangles,
                                  tangents);
              }),
              "there is memory for 5 tangents, but there are 4 positions");
    const std::vector<std::uint16_t> indices = {0, 1, 2, 2, 1, 4};
    normals.resize(mesh.positions.size());
    EXPECT_EQ(test::message_of<InvalidInput>([&] {
                  vertex_normals(mesh.positions,
                                 TriangleSpan(std::span<const std::uint16_t>(indices)),
                                 NormalOptions{}, normals);
              }),
              "triangle 1 names vertex 4, but there are only 4");
}

TEST(Buffers, IgnoreSurplusIndicesAndAcceptNoTriangles) {
    const std::vector<std::uint32_t> indices = {7, 8, 9, 1};
    const TriangleSpan triangles{std::span<const std::uint32_t>(indices)};
    ASSERT_EQ(triangles.size(), 1U);
    EXPECT_EQ(triangles[0], glm::uvec3(7, 8, 9));
    EXPECT_TRUE(triangles.subspan(1, 0).empty());
    const std::vector<glm::vec3> positions(2);
    std::vector<glm::vec3> normals(2);
    vertex_normals(positions, TriangleSpan(), NormalOptions{}, normals);
    EXPECT_EQ(normals[1], glm::vec3(0.0F, 0.0F, 1.0F));
}

}  // namespace
}  // namespace relief
