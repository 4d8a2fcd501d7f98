// SPDX-License-Identifier: Apache-2.0
// The names of a dense mesh's triangles in maps of ids.
#include "asset_ids.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "relief/make/asset.h"
#include "support/shapes.h"

namespace relief::make {
namespace {

using testing::ElementsAre;
using Names = std::vector<NamedTriangles>;

TEST(AssetIds, AreMaterialsAndThePartsWithoutOne) {
    Mesh mesh;
    mesh.positions.resize(3);
    mesh.triangles.resize(8, {0, 1, 2});
    mesh.material_ranges = {{0, 2, 0U}, {2, 4, std::nullopt}, {6, 2, 1U}};
    const NamedParts parts = {{"lid", "base"}, {0, 1, 0, 0, 1, 1, 0, 1}};
    const std::vector<std::string> materials = {"gold", "base"};
    EXPECT_EQ(detail::asset_ids(mesh, parts, materials),
              (Names{{0, "gold"}, {2, "lid"}, {4, "base (part)"}, {6, "base"}}));
    EXPECT_EQ(detail::asset_ids(mesh, {}, materials),
              (Names{{0, "gold"}, {2, "no-material"}, {6, "base"}}));
    mesh.material_ranges.clear();
    EXPECT_EQ(detail::asset_ids(mesh, parts, {}),
              (Names{{0, "lid"}, {1, "base"}, {2, "lid"}, {4, "base"}, {6, "lid"}, {7, "base"}}));
}

TEST(AssetIds, AreDividedWithTheMesh) {
    const Names ids = {{0, "a"}, {2, "b"}, {5, "c"}};
    const std::vector<std::uint32_t> keys = {0, 1, 0, 1, 1, 1};
    const std::vector<Names> divided = detail::divided(ids, keys, 3);
    EXPECT_THAT(divided, ElementsAre(Names{{0, "a"}, {1, "b"}}, Names{{0, "a"}, {1, "b"}, {3, "c"}},
                                     Names{}));
}

/// Parts without a material that do not touch have their names, also if rays keep them apart.
TEST(AssetIds, AreInTheLayerOfAnAsset) {
    const Mesh grid = test::grid(4);
    std::vector<glm::vec3> positions = grid.positions;
    std::vector<glm::uvec3> triangles = grid.triangles;
    const auto first = static_cast<std::uint32_t>(positions.size());
    for (const glm::vec3& position : grid.positions)
        positions.push_back(position + glm::vec3(2.0F, 0.0F, 0.0F));
    for (const glm::uvec3& triangle : grid.triangles)
        triangles.push_back(triangle + first);
    AssetSource source;
    source.name = "two";
    source.mesh = test::mesh_from(positions, triangles);
    source.parts.names = {"lid", "base"};
    source.parts.part_of.assign(triangles.size(), 1);
    std::fill_n(source.parts.part_of.begin(), grid.triangles.size(), 0);
    AssetOptions options;
    options.size = {32, 32};
    options.occlusion = false;
    options.remesh = Remeshing::never;
    options.layers = {LayerKind::id};
    for (const PartMatching match : {PartMatching::automatic, PartMatching::all}) {
        options.match = match;
        const Asset asset = make_asset(source, options);
        std::vector<std::string> names;
        for (const SurfaceId& id : asset.layers.front().coding.ids)
            names.push_back(id.name);
        EXPECT_THAT(names, ElementsAre("base", "lid"));
    }
}

}  // namespace
}  // namespace relief::make
