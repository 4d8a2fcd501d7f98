// SPDX-License-Identifier: Apache-2.0
// Joint weights and morph targets of a primitive as a few numbers per vertex.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "mesh/io/gltf/gltf_support.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"
#include "support/shared_data.h"

namespace relief::test {
namespace {

using nlohmann::json;

/// A primitive of two triangles with joints, weights and morph targets.
class DeformedPrimitive {
  public:
    DeformedPrimitive() {
        root_ = json::parse(R"({"asset": {"version": "2.0"}, "nodes": [{"mesh": 0}],
                                "scenes": [{"nodes": [0]}], "scene": 0,
                                "meshes": [{"primitives": [{"attributes": {}}]}]})");
        add("POSITION", std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 2, 0, 0, 2, 1, 0},
            5126, "VEC3");
    }

    template <typename Value>
    void add(const char* name, const std::vector<Value>& values, int type, const char* shape) {
        primitive()["attributes"][name] = accessor(values, type, shape);
    }
    void add_target(const std::vector<float>& displacements) {
        primitive()["targets"].push_back({{"POSITION", accessor(displacements, 5126, "VEC3")}});
    }
    [[nodiscard]] Deformation deformation() const {
        const TemporaryDirectory folder;
        json root = root_;
        root["buffers"] = {{{"byteLength", bytes_.size()}}};
        write_gltf_file(folder / "a.glb", root, bytes_);
        Report report;
        return GltfDocument::read(folder / "a.glb", report).deformation_sums({0, 0});
    }

  private:
    json& primitive() { return root_["meshes"][0]["primitives"][0]; }
    template <typename Value>
    std::size_t accessor(const std::vector<Value>& values, int type, const char* shape) {
        const std::size_t size = values.size() * sizeof(Value);
        root_["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", size}});
        bytes_.append(reinterpret_cast<const char*>(values.data()), size);
        root_["accessors"].push_back({{"bufferView", root_["bufferViews"].size() - 1},
                                      {"componentType", type},
                                      {"count", 6},
                                      {"type", shape}});
        return root_["accessors"].size() - 1;
    }

    json root_;
    std::string bytes_;
};

TEST(GltfDeformation, IsEmptyWithoutJointsAndTargets) {
    const Deformation none = DeformedPrimitive().deformation();
    EXPECT_TRUE(none.joints.empty());
    for (const auto& displacements : none.displacements)
        EXPECT_TRUE(displacements.empty());
}

TEST(GltfDeformation, JointsAreLinearInTheirWeightsInAnyOrder) {
    DeformedPrimitive primitive;
    primitive.add("JOINTS_0", std::vector<std::uint8_t>{3, 0, 0, 0, 4,   0, 0, 0, 3, 4, 0, 0,
                                                        0, 4, 9, 3, 200, 0, 0, 0, 3, 3, 4, 4},
                  5121, "VEC4");
    primitive.add("WEIGHTS_0",
                  std::vector<float>{1, 0,     0, 0,     1, 0, 0, 0, 0.25F,  0.75F,  0,    0,
                                     0, 0.75F, 0, 0.25F, 1, 0, 0, 0, 0.125F, 0.125F, 0.5F, 0.25F},
                  5126, "VEC4");
    const std::vector<glm::vec4> joints = primitive.deformation().joints;
    ASSERT_EQ(joints.size(), 6U);
    EXPECT_EQ(joints[2], joints[3]) << "the order of joints and joints of weight 0 do not count";
    EXPECT_EQ(joints[2], joints[5]) << "repeated joints are added";
    EXPECT_LT(glm::length(joints[2] - 0.25F * joints[0] - 0.75F * joints[1]), 1e-6F);
    // Vertices of different joints differ about as much as if each joint had a number of its own.
    EXPECT_GT(glm::length(joints[0] - joints[1]), 0.7F);
    EXPECT_GT(glm::length(joints[0] - joints[4]), 0.5F);
    EXPECT_LT(glm::length(joints[0] - joints[4]), 2.0F);
}

TEST(GltfDeformation, JointsOfCloseNumbersDiffer) {
    for (std::uint16_t first = 0; first < 300; first += 6) {
        DeformedPrimitive primitive;
        std::vector<std::uint16_t> joints(24, 0);
        std::vector<float> weights(24, 0.0F);
        for (std::uint16_t v = 0; v < 6; ++v) {
            joints[4 * v] = static_cast<std::uint16_t>(first + v);
            weights[4 * v] = 1.0F;
        }
        primitive.add("JOINTS_0", joints, 5123, "VEC4");
        primitive.add("WEIGHTS_0", weights, 5126, "VEC4");
        const std::vector<glm::vec4> result = primitive.deformation().joints;
        for (std::size_t a = 0; a < 6; ++a) {
            for (std::size_t b = 0; b < a; ++b)
                EXPECT_GT(glm::length(result[a] - result[b]), 0.4F) << first;
        }
    }
}

TEST(GltfDeformation, UpToThreeTargetsAreTheirDisplacements) {
    DeformedPrimitive primitive;
    const std::vector<float> up = {0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0, 4, 0, 0, 5, 0, 0, 6};
    primitive.add_target(up);
    primitive.add_target(std::vector<float>(18, 0.5F));
    const Deformation deformation = primitive.deformation();
    ASSERT_EQ(deformation.displacements[0].size(), 6U);
    EXPECT_EQ(deformation.displacements[0][3], glm::vec3(0, 0, 4));
    EXPECT_EQ(deformation.displacements[1][3], glm::vec3(0.5F));
    EXPECT_TRUE(deformation.displacements[2].empty());
}

TEST(GltfDeformation, TheSizeOfADisplacementByOneOfManyTargetsIsKept) {
    // Target t moves only vertex t.
    DeformedPrimitive primitive;
    for (std::size_t target = 0; target < 6; ++target) {
        std::vector<float> displacements(18, 0.0F);
        displacements[3 * target] = 3.0F;
        displacements[3 * target + 2] = 4.0F;
        primitive.add_target(displacements);
    }
    const Deformation deformation = primitive.deformation();
    for (std::size_t v = 0; v < 6; ++v) {
        double squared = 0.0;
        for (const auto& displacements : deformation.displacements)
            squared += double(glm::dot(displacements[v], displacements[v]));
        EXPECT_NEAR(squared, 25.0, 1e-4);
    }
}

}  // namespace
}  // namespace relief::test
