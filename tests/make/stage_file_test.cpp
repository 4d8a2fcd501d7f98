// SPDX-License-Identifier: Apache-2.0
// Files of stages have names and alpha modes for other programs, and the order of their mesh.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "relief/make/stage_file.h"
#include "relief/mesh/gltf_document.h"
#include "support/shapes.h"
#include "tools/workplace.h"

namespace relief::make {
namespace {

using testing::ElementsAre;

/// Two grids, whose triangles alternate, with alpha modes that share vertices.
struct TwoParts {
    Mesh mesh;
    NamedParts parts{{"lid", "base + hinge"}, {}};
    std::vector<AlphaMode> alpha_modes;

    TwoParts() {
        const Mesh grid = test::grid(4);
        std::vector<glm::vec3> positions;
        for (const glm::vec3& position : grid.positions) {
            positions.push_back(position);
            positions.push_back(position + glm::vec3(0.0F, 0.0F, 1.0F));
        }
        std::vector<glm::uvec3> triangles;
        for (std::uint32_t i = 0; i < grid.triangles.size(); ++i) {
            for (std::uint32_t part = 0; part < 2; ++part) {
                triangles.push_back(2U * grid.triangles[i] + part);
                parts.part_of.push_back(part);
                const bool is_blended = part == 1 && i % 3 == 0;
                alpha_modes.push_back(is_blended ? AlphaMode::blend : AlphaMode::opaque);
            }
        }
        mesh = test::mesh_from(positions, triangles);
    }
};

TEST(StageFile, GivesTheSameMeshAgain) {
    const TwoParts two;
    const test::TemporaryDirectory folder;
    const StageLayout layout =
        write_stage_file(folder / "a.glb", "repair", {two.mesh, two.parts, two.alpha_modes},
                         {1.0, 2.0, 3.0}, IgnoredReport());
    const StageContents contents = read_stage_file(folder / "a.glb", layout);
    EXPECT_EQ(contents.mesh.positions, two.mesh.positions);
    EXPECT_EQ(contents.mesh.triangles, two.mesh.triangles);
    EXPECT_EQ(contents.parts.names, two.parts.names);
    EXPECT_EQ(contents.parts.part_of, two.parts.part_of);
    EXPECT_EQ(contents.alpha_modes, two.alpha_modes);
    // Another layout is an error, not another mesh.
    StageLayout other = layout;
    ++other.triangles.front().count;
    EXPECT_THROW(read_stage_file(folder / "a.glb", other), FileError);
    other = layout;
    other.vertices.pop_back();
    EXPECT_THROW(read_stage_file(folder / "a.glb", other), FileError);
    EXPECT_THROW(read_stage_file(folder / "a.glb", {}), FileError);
}

TEST(StageFile, HasANodeForEachPart) {
    const TwoParts two;
    const test::TemporaryDirectory folder;
    write_stage_file(folder / "a.gltf", "repair", {two.mesh, two.parts, two.alpha_modes},
                     {1.0, 2.0, 3.0}, IgnoredReport());
    const GltfDocument document = test::read_document(folder / "a.gltf");
    const GltfView view = document.view();
    ASSERT_EQ(view.nodes.size(), 2U);
    EXPECT_EQ(view.nodes[0].name, "lid");
    EXPECT_EQ(view.nodes[1].name, "base + hinge");
    EXPECT_EQ(view.nodes[1].translation, glm::vec3(1.0F, 2.0F, 3.0F));
    ASSERT_EQ(view.primitives.size(), 3U);
    EXPECT_EQ(document.mesh({1, 1}).triangles.size(), 11U);
    EXPECT_EQ(view.materials.at(*document.mesh({1, 1}).material_ranges.front().material).alpha_mode,
              AlphaMode::blend);
}

TEST(StageFile, HasOneNodeWithoutParts) {
    const TwoParts two;
    const test::TemporaryDirectory folder;
    const StageLayout layout = write_stage_file(folder / "a.glb", "decimate", {two.mesh, {}, {}},
                                                glm::dvec3(0.0), IgnoredReport());
    EXPECT_TRUE(layout.triangles.empty());
    const GltfView view = test::read_document(folder / "a.glb").view();
    ASSERT_EQ(view.nodes.size(), 1U);
    EXPECT_EQ(view.nodes[0].name, "decimate");
    EXPECT_TRUE(view.materials.empty());
    const StageContents contents = read_stage_file(folder / "a.glb", layout);
    EXPECT_EQ(contents.mesh.triangles, two.mesh.triangles);
    EXPECT_TRUE(contents.parts.names.empty());
    EXPECT_TRUE(contents.alpha_modes.empty());
}

}  // namespace
}  // namespace relief::make
