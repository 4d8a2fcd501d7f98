// SPDX-License-Identifier: Apache-2.0
// Frames of morph targets: a target of weight 1 has exactly the frames of its displaced shape, even
// if vertices were split.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

#include "io/gltf/gltf_accessor.h"
#include "io/gltf/gltf_contents.h"
#include "mesh/io/gltf/gltf_support.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/report.h"
#include "support/invariants.h"
#include "support/shapes.h"
#include "support/shared_data.h"

namespace relief {
using namespace relief::detail;

namespace {

using nlohmann::json;
using test::write_gltf_file;
using testing::ElementsAre;
using testing::HasSubstr;

/// Repeated sums and differences of unit vectors in float.
constexpr double rounding = 1e-6;

class GltfMorph : public testing::Test {
  protected:
    GltfMorph() {
        root_ = json::parse(R"({"asset": {"version": "2.0"}, "nodes": [{"mesh": 0}],
                                "scenes": [{"nodes": [0]}], "scene": 0, "bufferViews": [],
                                "accessors": []})");
        // A flat unit square of two triangles, (0 1 2) and (0 2 3), and a target that lifts the
        // last corner.
        json& primitive = root_["meshes"][0]["primitives"][0];
        primitive["attributes"]["POSITION"] =
            accessor<glm::vec3>({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
        primitive["attributes"]["TEXCOORD_0"] =
            accessor<glm::vec2>({{0, 0}, {1, 0}, {1, 1}, {0, 1}});
        primitive["indices"] = accessor<std::uint8_t>({0, 1, 2, 0, 2, 3});
        primitive["targets"][0]["POSITION"] =
            accessor<glm::vec3>({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 1}});
    }
    json& primitive() { return root_["meshes"][0]["primitives"][0]; }
    json& target() { return primitive()["targets"][0]; }

    /// Adds an accessor over values and returns its number.
    template <typename Value>
    std::size_t accessor(const std::vector<Value>& values) {
        buffer_.resize((buffer_.size() + 3) / 4 * 4, '\0');
        root_["bufferViews"].push_back({{"buffer", 0},
                                        {"byteOffset", buffer_.size()},
                                        {"byteLength", values.size() * sizeof(Value)}});
        buffer_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value));
        const char* type = sizeof(Value) == 1    ? "SCALAR"
                           : sizeof(Value) == 8  ? "VEC2"
                           : sizeof(Value) == 12 ? "VEC3"
                                                 : "VEC4";
        root_["accessors"].push_back({{"bufferView", root_["bufferViews"].size() - 1},
                                      {"componentType", sizeof(Value) == 1 ? 5121 : 5126},
                                      {"count", values.size()},
                                      {"type", type}});
        if constexpr (sizeof(Value) == 12) set_bounds(root_["accessors"].back(), values);
        return root_["accessors"].size() - 1;
    }
    /// Processes the primitive of the document and reads the written file.
    GltfContents processed(NormalMode normals, TangentMethod tangents) {
        root_["buffers"] = {{{"byteLength", buffer_.size()}}};
        write_gltf_file(in_, root_, buffer_);
        process(in_, normals, tangents);
        return read_gltf(out_, report_);
    }
    void process(const std::filesystem::path& file, NormalMode normals, TangentMethod tangents) {
        GltfDocument document = GltfDocument::read(file, report_);
        for (const GltfPrimitiveId id : document.triangle_primitives()) {
            FrameOptions options{normals, NormalMode::flat, tangents};
            const Mesh mesh = document.mesh(id);
            if (mesh.texcoords.empty()) options.tangents = TangentMethod::none;
            const FramedMesh framed = with_frames(mesh, options, report_);
            vertices_ = document.set_frames(id, framed, options, report_);
        }
        document.write(out_);
    }

    test::TemporaryDirectory folder_;
    std::filesystem::path in_ = folder_ / "in.glb";
    std::filesystem::path out_ = folder_ / "out.glb";
    json root_;
    std::string buffer_;
    Report report_;
    std::size_t vertices_ = 0;
};

std::vector<glm::vec3> vectors(const GltfContents& contents, const json& accessor) {
    return float_elements<glm::vec3>(contents, accessor.get<std::size_t>());
}

TEST_F(GltfMorph, FlatNormalsOfTargetsSplitFlatRegions) {
    const GltfContents written = processed(NormalMode::flat, TangentMethod::none);
    // At rest, both triangles share all normals. In the displaced shape, the second one is tilted.
    EXPECT_EQ(vertices_, 6U);
    const Json& made = written.root["meshes"][0]["primitives"][0];
    const auto rest = vectors(written, made["attributes"]["NORMAL"]);
    const auto moved = vectors(written, made["targets"][0]["NORMAL"]);
    const auto indices = index_elements(written, made["indices"]);
    const glm::vec3 leaning = glm::normalize(glm::vec3(1, -1, 1));
    for (std::size_t corner = 0; corner < 6; ++corner) {
        const std::uint32_t v = indices[corner];
        EXPECT_EQ(rest[v], glm::vec3(0, 0, 1));
        EXPECT_LT(glm::length(rest[v] + moved[v] - (corner < 3 ? glm::vec3(0, 0, 1) : leaning)),
                  rounding);
    }
    // The displacement of positions was copied to the split vertices.
    const auto lifted = vectors(written, made["targets"][0]["POSITION"]);
    EXPECT_EQ(lifted.size(), 6U);
    EXPECT_EQ(lifted[indices[5]], glm::vec3(0, 0, 1));
    EXPECT_TRUE(report_.empty());
}

TEST_F(GltfMorph, AveragedNormalsOfADisplacedShapeNeedNoSplit) {
    const GltfContents written = processed(NormalWeight::area, TangentMethod::none);
    EXPECT_EQ(vertices_, 4U);
    const Json& made = written.root["meshes"][0]["primitives"][0];
    const auto moved = vectors(written, made["targets"][0]["NORMAL"]);
    // Areas 1/2 and sqrt(3)/2 at the shared corners; one triangle alone at the others.
    const glm::vec3 sum = glm::normalize(glm::vec3(0, 0, 1) + glm::vec3(1, -1, 1));
    EXPECT_LT(glm::length(moved[0] + glm::vec3(0, 0, 1) - sum), rounding);
    EXPECT_LT(glm::length(moved[2] + glm::vec3(0, 0, 1) - sum), rounding);
    EXPECT_EQ(moved[1], glm::vec3(0.0F));
    EXPECT_LT(glm::length(moved[3] + glm::vec3(0, 0, 1) - glm::normalize(glm::vec3(1, -1, 1))),
              rounding);
}

TEST_F(GltfMorph, TargetWithoutNormalsGetsNone) {
    // The author keeps the normals.
    primitive()["attributes"]["NORMAL"] = accessor(std::vector<glm::vec3>(4, glm::vec3(0, 1, 0)));
    GltfContents written = processed(NormalWeight::area, TangentMethod::mikktspace);
    json after = written.root["meshes"][0]["primitives"][0]["targets"][0];
    EXPECT_FALSE(after.contains("NORMAL"));
    EXPECT_TRUE(after.contains("TANGENT"));  // The input has none.
    // If the target has displacements of normals, they are recomputed.
    target()["NORMAL"] = accessor(std::vector<glm::vec3>(4, glm::vec3(7, 7, 7)));
    written = processed(NormalWeight::area, TangentMethod::none);
    after = written.root["meshes"][0]["primitives"][0]["targets"][0];
    EXPECT_EQ(vectors(written, after["NORMAL"])[1], glm::vec3(0.0F));
    EXPECT_FALSE(after.contains("TANGENT"));
}

TEST_F(GltfMorph, KeptFramesAreKeptInTargets) {
    primitive()["attributes"]["NORMAL"] = accessor(std::vector<glm::vec3>(4, glm::vec3(0, 0, 1)));
    target()["NORMAL"] = accessor(std::vector<glm::vec3>(4, glm::vec3(0.5F, 0, 0)));
    GltfContents written = processed(NormalMode::keep, TangentMethod::keep);
    EXPECT_EQ(written.root, read_gltf(in_, report_).root);
    // With new tangents only, normals stay, and the tangents of the target belong to its displaced
    // normals.
    written = processed(NormalMode::keep, TangentMethod::mikktspace);
    const Json& made = written.root["meshes"][0]["primitives"][0];
    EXPECT_EQ(vectors(written, made["targets"][0]["NORMAL"])[2], glm::vec3(0.5F, 0, 0));
    const auto rest =
        float_elements<glm::vec4>(written, made["attributes"]["TANGENT"].get<std::size_t>());
    const auto moved = vectors(written, made["targets"][0]["TANGENT"]);
    const glm::vec3 normal = glm::normalize(glm::vec3(0.5F, 0, 1));
    for (std::size_t v = 0; v < rest.size(); ++v) {
        EXPECT_EQ(rest[v], glm::vec4(1, 0, 0, -1));
        const glm::vec3 tangent = glm::vec3(rest[v]) + moved[v];
        EXPECT_NEAR(glm::length(tangent), 1.0F, 1e-6F);
        EXPECT_NEAR(glm::dot(tangent, normal), 0.0F, 1e-6F);
    }
}

TEST_F(GltfMorph, ReportsProblemsOfTargets) {
    // The last corner moves onto the diagonal, so the second triangle has no area.
    target()["POSITION"] = accessor<glm::vec3>({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0.5F, -0.5F, 0}});
    processed(NormalMode::flat, TangentMethod::none);
    ASSERT_EQ(report_.findings().size(), 1U);
    EXPECT_EQ(report_.findings()[0].kind, "degenerate triangle, in a morph target");
    EXPECT_EQ(report_.findings()[0].element, "morph target");
    EXPECT_THAT(report_.findings()[0].first, ElementsAre(0U));
}

TEST_F(GltfMorph, HandednessThatATargetCannotTurnIsReported) {
    // The second triangle has no texture gradient and takes the frame of the first one, whose
    // texture is mirrored (w = 1), across an edge of equal vertices. The target moves the first one
    // away: alone, the second one has w = -1.
    primitive()["attributes"]["POSITION"] =
        accessor<glm::vec3>({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    primitive()["attributes"]["TEXCOORD_0"] =
        accessor<glm::vec2>({{0, 0}, {1, 0}, {1, -1}, {0, 0}, {1, -1}, {0.5F, -0.5F}});
    primitive()["indices"] = accessor<std::uint8_t>({0, 1, 2, 3, 4, 5});
    target()["POSITION"] =
        accessor<glm::vec3>({{9, 0, 0}, {9, 0, 0}, {9, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}});
    const GltfContents written = processed(NormalWeight::area, TangentMethod::mikktspace);
    EXPECT_EQ(report_.count("tangents of other handedness in a morph target"), 1U);
    const Json& attributes = written.root["meshes"][0]["primitives"][0]["attributes"];
    EXPECT_EQ(float_elements<glm::vec4>(written, attributes["TANGENT"])[3].w, 1.0F);
}

/// Returns the primitive with a target of weight 1.
Mesh displaced(const GltfContents& contents, const Json& primitive, std::size_t target, Mesh mesh) {
    const Json& made = primitive["targets"][target];
    if (!made.contains("POSITION")) return mesh;
    const auto moved = vectors(contents, made["POSITION"]);
    for (std::size_t v = 0; v < moved.size(); ++v)
        mesh.positions[v] += moved[v];
    return mesh;
}

TEST_F(GltfMorph, RealTargetsHaveTheFramesOfTheirShapesAtEveryCorner) {
    RELIEF_NEEDS_SHARED(models, "data/models/gltf");
    std::size_t compared = 0;
    for (const char* name :
         {"AnimatedMorphCube", "MorphPrimitivesTest", "MorphStressTest", "AnimatedMorphSphere"}) {
        const auto file = models / name / "glTF-Binary" / (std::string(name) + ".glb");
        if (!std::filesystem::exists(file)) continue;
        for (const NormalMode normals : {NormalMode::flat, NormalMode(NormalWeight::angle)}) {
            SCOPED_TRACE(file);
            process(file, normals, TangentMethod::none);
            const GltfContents written = read_gltf(out_, report_);
            const GltfDocument document = GltfDocument::read(out_, report_);
            for (const GltfPrimitiveId id : document.triangle_primitives()) {
                const Json& made = written.root["meshes"][id.mesh]["primitives"][id.primitive];
                const Mesh rest = document.mesh(id);
                for (std::size_t i = 0; i < array_in(made, "targets").size(); ++i) {
                    if (!made["targets"][i].contains("NORMAL")) continue;
                    const auto moved = vectors(written, made["targets"][i]["NORMAL"]);
                    Report ignored;
                    const Mesh shape = with_frames(displaced(written, made, i, rest),
                                                   {normals, normals, TangentMethod::none}, ignored)
                                           .mesh;
                    for (std::size_t t = 0; t < rest.triangles.size(); ++t) {
                        for (int k = 0; k < 3; ++k) {
                            const std::uint32_t v = rest.triangles[t][k];
                            const glm::vec3 wanted = shape.normals[shape.triangles[t][k]];
                            ASSERT_LT(glm::length(rest.normals[v] + moved[v] - wanted), rounding)
                                << i << ' ' << t;
                            ++compared;
                        }
                    }
                }
            }
        }
    }
    EXPECT_GT(compared, 1000U);
}

}  // namespace

}  // namespace relief
