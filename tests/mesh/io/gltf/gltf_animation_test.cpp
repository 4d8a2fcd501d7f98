// SPDX-License-Identifier: Apache-2.0
// Animation channels as keys, and which of them are left out.
#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "gltf_semantics.h"
#include "relief/mesh/gltf_document.h"
#include "support/shared_data.h"

namespace relief {
namespace {

using nlohmann::json;

/// Arrays of floats in one buffer, each an accessor.
class Animated : public testing::Test {
  protected:
    std::size_t add(const std::vector<float>& values, const char* type, std::size_t components) {
        root_["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", values.size() * 4}});
        root_["accessors"].push_back({{"bufferView", root_["bufferViews"].size() - 1},
                                      {"componentType", 5126},
                                      {"count", values.size() / components},
                                      {"type", type}});
        bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * 4);
        return root_["accessors"].size() - 1;
    }
    std::size_t times(const std::vector<float>& values) { return add(values, "SCALAR", 1); }

    /// One more channel on its own sampler.
    void channel(const json& target, std::size_t input, std::size_t output,
                 const char* interpolation = "LINEAR") {
        json& animation = root_["animations"][0];
        animation["samplers"].push_back(
            {{"input", input}, {"output", output}, {"interpolation", interpolation}});
        animation["channels"].push_back(
            {{"sampler", animation["samplers"].size() - 1}, {"target", target}});
    }

    std::vector<GltfAnimation> read() {
        root_["buffers"] = {{{"byteLength", bytes_.size()}}};
        test::write_gltf_file(folder_ / "a.glb", root_, bytes_);
        return GltfDocument::read(folder_ / "a.glb", report_).animations(report_);
    }

    test::TemporaryDirectory folder_;
    Report report_;
    json root_ = {{"asset", {{"version", "2.0"}}},
                  {"nodes", {{{"name", "a"}}, {{"matrix", std::vector<float>(16, 1.0F)}}}},
                  {"animations",
                   {{{"name", "move"}, {"samplers", json::array()}, {"channels", json::array()}}}}};
    std::string bytes_;
};

TEST_F(Animated, ChannelsAreKeysOfNodes) {
    const std::size_t two = times({0.5F, 2.0F});
    channel({{"node", 0}, {"path", "translation"}}, two, add({1, 2, 3, 4, 5, 6}, "VEC3", 3));
    channel({{"node", 0}, {"path", "rotation"}}, two, add({0, 0, 0, 1, 1, 0, 0, 0}, "VEC4", 4),
            "STEP");
    channel({{"node", 0}, {"path", "scale"}}, two,
            add({0, 0, 0, 1, 1, 1, 0, 0, 0, 9, 9, 9, 2, 2, 2, 9, 9, 9}, "VEC3", 3), "CUBICSPLINE");
    const std::vector<GltfAnimation> animations = read();
    ASSERT_EQ(animations.size(), 1U);
    EXPECT_EQ(animations[0].name, "move");
    ASSERT_EQ(animations[0].channels.size(), 3U);
    const GltfChannel& translation = animations[0].channels[0];
    EXPECT_EQ(translation.times, (std::vector<float>{0.5F, 2.0F}));
    EXPECT_EQ(translation.values, (std::vector<glm::vec4>{{1, 2, 3, 0}, {4, 5, 6, 0}}));
    EXPECT_EQ(translation.interpolation, GltfChannel::Interpolation::linear);
    const GltfChannel& rotation = animations[0].channels[1];
    EXPECT_EQ(rotation.values[1], glm::vec4(1, 0, 0, 0));
    EXPECT_EQ(rotation.interpolation, GltfChannel::Interpolation::step);
    EXPECT_EQ(animations[0].channels[2].values.size(), 6U);
    EXPECT_TRUE(report_.empty());
}

TEST_F(Animated, WhatCannotBeUsedIsLeftOutAndCounted) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::size_t two = times({0, 1});
    const std::size_t good = add({1, 2, 3, 4, 5, 6}, "VEC3", 3);
    const json place = {{"node", 0}, {"path", "translation"}};
    channel({{"node", 0}, {"path", "weights"}}, two, good);      // 0
    channel({{"path", "pointer"}}, two, good);                   // 1
    channel({{"path", "translation"}}, two, good);               // 2: nobody's
    channel({{"node", 1}, {"path", "translation"}}, two, good);  // 3: has a matrix
    channel(place, times({1, 1}), good);                         // 4: not ascending
    channel(place, times({1, nan}), good);                       // 5
    channel(place, times({-1, 1}), good);                        // 6: before all time
    channel(place, times({0, 1, 2}), good);                      // 7: too few values
    channel(place, two, good, "CUBICSPLINE");                    // 8: likewise
    channel(place, two, add({1, 2, 3, 4, nan, 6}, "VEC3", 3));   // 9
    channel(place, two, two);                                    // 10: scalars
    channel({{"node", 0}, {"path", "rotation"}}, two,
            add({0, 0, 0, 1, 0, 0, 0, 0}, "VEC4", 4));  // 11: no rotation
    channel(place, two, good);
    const std::vector<GltfAnimation> animations = read();
    EXPECT_EQ(animations[0].channels.size(), 1U);
    EXPECT_EQ(report_.count("animated morph weights"), 1U);
    EXPECT_EQ(report_.count("animation of an extension"), 1U);
    EXPECT_EQ(report_.count("animated node with a matrix"), 1U);
    EXPECT_EQ(report_.count("animation channel with unusable keys"), 8U);
    EXPECT_EQ(report_.findings()[3].first, (std::vector<std::size_t>{4, 5, 6, 7, 8, 9, 10, 11}));
}

TEST_F(Animated, NodesKnowTheirParentsAndPlaces) {
    root_["nodes"] = json::parse(R"([{"name": "root", "children": [2], "scale": [2, 2, 2]},
        {"matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 4,5,6,1]}, {"rotation": [0, 1, 0, 0], "skin": 0}])");
    root_["skins"] = json::parse(R"([{"joints": [0]}])");
    root_.erase("animations");
    test::write_gltf_file(folder_ / "a.glb", root_, bytes_);
    const GltfView view = GltfDocument::read(folder_ / "a.glb", report_).view();
    ASSERT_EQ(view.nodes.size(), 3U);
    EXPECT_EQ(view.nodes[0].scale, glm::vec3(2.0F));
    EXPECT_FALSE(view.nodes[0].parent || view.nodes[0].matrix || view.nodes[0].has_skin);
    EXPECT_EQ(view.nodes[1].matrix.value()[3], glm::vec4(4, 5, 6, 1));
    EXPECT_EQ(view.nodes[2].parent, 0U);
    EXPECT_EQ(view.nodes[2].rotation, glm::vec4(0, 1, 0, 0));
    EXPECT_TRUE(view.nodes[2].has_skin);
}

TEST(GltfAnimations, OfRealModelsAreReadWhole) {
    RELIEF_NEEDS_SHARED(models, "data/models/gltf");
    Report report;
    const auto channels = [&](const char* file) {
        std::size_t count = 0;
        for (const auto& animation : GltfDocument::read(models / file, report).animations(report))
            count += animation.channels.size();
        return count;
    };
    EXPECT_EQ(channels("InterpolationTest/glTF-Binary/InterpolationTest.glb"), 9U);
    EXPECT_EQ(channels("BoxAnimated/glTF-Binary/BoxAnimated.glb"), 2U);
    EXPECT_TRUE(report.empty());
}

}  // namespace
}  // namespace relief
