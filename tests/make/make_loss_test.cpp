// SPDX-License-Identifier: Apache-2.0
// The loss of an asset is measured after each stage, and faults of an asset raise it.
#include "make_loss.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "make_loss_meter.h"
#include "make_pictures.h"
#include "relief/mesh/mesh_file.h"
#include "support/labels.h"
#include "support/shapes.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using shade::Fidelity;
using shade::FidelityLight;
using test::Workplace;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr int map_size = 128;
constexpr auto base_color = static_cast<std::size_t>(FidelityLight::base_color);

shade::FidelityOptions small_pictures() {
    return {.size = 64, .samples = 4, .views = 6};
}

/// A ball with ripples.
Mesh rippled_ball() {
    Mesh mesh = test::sphere(96, 48);
    for (glm::vec3& position : mesh.positions) {
        const float ripple = std::sin(9.0F * position.x) * std::sin(9.0F * position.y);
        position *= 1.0F + 0.04F * ripple;
    }
    return test::mesh_from(mesh.positions, mesh.triangles);
}

/// A source file, and an asset of it.
class MakeLossTest : public testing::Test {
  protected:
    [[nodiscard]] DenseModel ball() const {
        return {.files = {workplace / "ball.ply"}, .crease_angle = 1.0};
    }
    void SetUp() override {
        Mesh ball = rippled_ball();
        // Colors vary with the height.
        for (const glm::vec3& position : ball.positions)
            ball.colors.emplace_back(glm::vec3(0.5F + 0.3F * position.y), 1.0F);
        MeshFile contents;
        contents.mesh = ball;
        write_mesh(workplace / "ball.ply", contents);
        make::AssetSource source;
        source.name = "ball";
        source.mesh = ball;
        make::AssetOptions options;
        options.triangles = 1500;
        options.size = glm::ivec2(map_size);
        options.padding = 2;
        options.occlusion = false;
        options.keep_baked_normals = true;
        good = make::make_asset(source, options);
    }

    [[nodiscard]] std::filesystem::path file() const { return workplace / "asset.glb"; }

    Fidelity loss_of(LossMeter& meter, const make::Asset& asset) const {
        write_asset(file(), asset, 0);
        Report report;
        return meter.measure(file(), report).fidelity;
    }

    Workplace workplace;
    make::Asset good;
};

struct AssetFault {
    const char* name;
    std::function<void(make::Asset&)> plant;
    /// The figure that it raises, and that figure's floor.
    std::function<std::pair<double, double>(const Fidelity&)> figure;
};

std::pair<double, double> mean_degrees(const Fidelity& loss) {
    return {loss.normals.mean, loss.normals.floor};
}

std::pair<double, double> worst_degrees(const Fidelity& loss) {
    return {loss.normals.worst.value, loss.normals.floor};
}

std::pair<double, double> worst_color(const Fidelity& loss) {
    return {loss.pictures[base_color].worst.value, loss.pictures[base_color].floor};
}

/// Makes a square of texels black, which is (-1, -1, -1) in a normal map.
void blacken(Image& map, const glm::vec2& texcoord, int radius) {
    const glm::ivec2 middle(texcoord * static_cast<float>(map_size));
    const MutableImageView texels(map);
    for (int y = std::max(middle.y - radius, 0); y <= std::min(middle.y + radius, map_size - 1);
         ++y) {
        for (int x = std::max(middle.x - radius, 0); x <= std::min(middle.x + radius, map_size - 1);
             ++x)
            std::fill_n(texels.row<std::uint8_t>(y) + 3 * x, 3, std::uint8_t{0});
    }
}

glm::vec2 texcoord_in_chart(const make::Asset& asset) {
    const glm::uvec3& triangle = asset.mesh.triangles.front();
    return (asset.mesh.texcoords[triangle.x] + asset.mesh.texcoords[triangle.y] +
            asset.mesh.texcoords[triangle.z]) /
           3.0F;
}

std::vector<AssetFault> asset_faults() {
    return {
        {"inverted green",
         [](make::Asset& asset) {
             const std::span<std::uint8_t> samples = asset.normal_map.as<std::uint8_t>();
             for (std::size_t i = 1; i < samples.size(); i += 3)
                 samples[i] = static_cast<std::uint8_t>(255 - samples[i]);
         },
         mean_degrees},
        {"map shifted by a texel",
         [](make::Asset& asset) {
             const std::span<std::uint8_t> samples = asset.normal_map.as<std::uint8_t>();
             std::rotate(samples.begin(), samples.begin() + 3, samples.end());
         },
         mean_degrees},
        {"mirrored charts",
         [](make::Asset& asset) {
             for (std::size_t i = 0; i < asset.mesh.tangents.size(); ++i) {
                 if (asset.mesh.positions[i].x > 0.0F) asset.mesh.tangents[i].w *= -1.0F;
             }
         },
         mean_degrees},
        {"map of an eighth of the size",
         [](make::Asset& asset) { asset.normal_map = reduced(asset.normal_map, map_size / 8); },
         mean_degrees},
        {"missing side",
         [](make::Asset& asset) {
             std::erase_if(asset.mesh.triangles, [&](const glm::uvec3& triangle) {
                 return asset.mesh.positions[triangle.x].x > 0.5F;
             });
         },
         [](const Fidelity& loss) {
             return std::pair(loss.silhouettes.width, loss.silhouettes.floor);
         }},
        {"texels without color",
         [](make::Asset& asset) { blacken(*asset.color_map, texcoord_in_chart(asset), 6); },
         worst_color},
        {"texels without a normal",
         [](make::Asset& asset) { blacken(asset.normal_map, texcoord_in_chart(asset), 6); },
         worst_degrees},
        {"broken seams",
         [](make::Asset& asset) {
             const Mesh& mesh = asset.mesh;
             for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
                 if (std::ranges::count(mesh.positions, mesh.positions[i]) > 1)
                     blacken(asset.normal_map, mesh.texcoords[i], 1);
             }
         },
         worst_degrees},
    };
}

TEST_LABELS(not_sanitized);
TEST_F(MakeLossTest, IsRaisedByFaultsOfTheAsset) {
    LossMeter measuring(ball(), file(), small_pictures());
    const Fidelity expected = loss_of(measuring, good);
    for (const AssetFault& fault : asset_faults()) {
        make::Asset faulty = good;
        fault.plant(faulty);
        const auto [value, floor] = fault.figure(loss_of(measuring, faulty));
        EXPECT_GT(value, fault.figure(expected).first + 3.0 * floor) << fault.name;
        RecordProperty(fault.name, std::to_string(value) + " floor " + std::to_string(floor));
    }
}

TEST_LABELS(not_sanitized);
TEST_F(MakeLossTest, IsMeasuredAfterEachStage) {
    LossMeter measuring(ball(), file(), small_pictures());
    write_asset(file(), good, 2);
    Report report;
    AssetLoss loss = measuring.measure(file(), report);
    EXPECT_TRUE(loss.stages.empty());
    loss.stages = measuring.measure_stages(file(), good, loss);
    std::vector<std::string> names;
    for (const LossStage& stage : loss.stages)
        names.push_back(stage.name);
    ASSERT_THAT(names, ElementsAre("decimated", "baked", "coded", "LOD1", "LOD2"));
    const auto degrees = [&](std::size_t stage) { return loss.stages[stage].loss.normals.mean; };
    EXPECT_GT(degrees(0), 1.5 * degrees(1)) << "maps have the detail";
    EXPECT_LE(degrees(1), degrees(2)) << "codes lose something";
    EXPECT_GT(degrees(4), degrees(2));
    EXPECT_EQ(loss.stages[2].loss.flip, loss.fidelity.sampled.flip) << "it is the asset";
    // Maps do not move the surface, and coarser levels are farther from the source.
    EXPECT_EQ(loss.stages[0].distance.from_a.mean, loss.stages[2].distance.from_a.mean);
    EXPECT_GT(loss.stages[4].distance.from_a.mean, loss.stages[2].distance.from_a.mean);
    EXPECT_GT(loss.stages[3].triangles, loss.stages[4].triangles);
    for (const LossStage& stage : loss.stages) {
        EXPECT_LE(stage.distance.from_b.mean, stage.distance.from_b.p95);
        EXPECT_LE(stage.distance.from_b.p95, stage.distance.from_b.max);
    }
    EXPECT_EQ(distance_rows(loss).size(), 6U);
    EXPECT_NEAR(loss.diagonal, 2.0 * std::sqrt(3.0), 0.3);
    EXPECT_EQ(loss_json(loss)["stages"].size(), 5U);
    // The measurement with the normals before they were coded is that of the stage.
    EXPECT_EQ(measuring.measure_with_normals(file(), *good.baked_normals).normals.p99,
              loss.stages[1].loss.normals.p99);
}

TEST_LABELS(not_sanitized);
TEST_F(MakeLossTest, IsThatOfAllMaterialsOfAnAsset) {
    LossMeter measuring(ball(), file(), small_pictures());
    const double before = loss_of(measuring, good).normals.mean;
    make::Asset divided = good;
    divided.draw_modes = {{}, {AlphaMode::mask}};
    const auto count = static_cast<std::uint32_t>(divided.mesh.triangles.size());
    divided.mesh.material_ranges = {{0, count / 3, 1U}, {count / 3, count - count / 3, 0U}};
    const std::vector<make::AssetLevel> levels = write_asset(file(), divided, 1);
    Report report;
    AssetLoss loss = measuring.measure(file(), report);
    EXPECT_NEAR(loss.fidelity.normals.mean, before, 1e-3 * before);
    loss.stages = measuring.measure_stages(file(), divided, loss);
    ASSERT_EQ(loss.stages.size(), 4U);
    EXPECT_NEAR(loss.stages[1].loss.normals.mean, loss.fidelity.sampled.normals.mean, 0.3);
    EXPECT_EQ(loss.stages[3].name, "LOD1");
    EXPECT_EQ(loss.stages[3].triangles, levels.front().triangles);
    EXPECT_LT(loss.stages[3].loss.silhouette_pixels, 1.0) << "no triangle is missing";
}

TEST(LossTable, HasTheStatisticOfTheLimit) {
    AssetLoss loss;
    loss.fidelity.views.resize(12);
    loss.fidelity.normals.mean = 1.0;
    loss.fidelity.normals.rms = 1.25;
    loss.fidelity.normals.p99 = 2.0625;
    loss.fidelity.normals.max = 3.5;
    const LossRow row = loss_rows(loss.fidelity, ErrorKind::p99)[3];
    EXPECT_EQ(row.p99, 2.0625);
    EXPECT_EQ(row.max, 3.5);
    EXPECT_FALSE(row.rms);
    EXPECT_EQ(loss_rows(loss.fidelity, ErrorKind::rms)[3].rms, 1.25);
    const std::vector<std::string> lines = loss_lines(loss, ErrorKind::rms);
    EXPECT_THAT(lines[0], HasSubstr("rms     95 %     99 %   largest"));
    EXPECT_THAT(lines[4], HasSubstr("1.0000   1.2500   0.0000   2.0625    3.5000"));
    EXPECT_EQ(sampled_views_text(loss.fidelity), "views 0, 4, 8");
}

}  // namespace
}  // namespace relief::tools
