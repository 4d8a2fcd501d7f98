// SPDX-License-Identifier: Apache-2.0
// Some triangles of a mesh: vertices in order, attributes, materials and groups along.
#include "relief/mesh/mesh_part.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "relief/mesh/error.h"
#include "relief/mesh/shapes.h"
#include "support/message_of.h"

namespace relief {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(MeshPart, HasTheVerticesThatItsTrianglesUseInTheirOrder) {
    Mesh mesh = make_quad();
    mesh.name = "quad";
    mesh.triangles = {{0, 1, 2}, {2, 3, 0}, {3, 2, 1}};
    mesh.smoothing_groups = {1, 2, 3};
    mesh.material_ranges = {{0, 1, 7U}, {1, 2, std::nullopt}};
    mesh.colors.assign(4, glm::vec4(0.5F));
    mesh.colors[3] = glm::vec4(1.0F);
    const std::vector<std::uint32_t> chosen = {2, 1};
    const Mesh part = part_of(mesh, chosen);
    EXPECT_NO_THROW(validate(part));
    EXPECT_EQ(part.name, "quad");
    EXPECT_EQ(part.positions, mesh.positions);
    EXPECT_THAT(part.triangles, ElementsAre(glm::uvec3(3, 2, 1), glm::uvec3(2, 3, 0)));
    EXPECT_THAT(part.smoothing_groups, ElementsAre(3, 2));
    EXPECT_THAT(part.material_ranges, ElementsAre(MaterialRange{0, 2, std::nullopt}));
    const std::vector<std::uint32_t> last = {2, 0, 2};
    mesh.triangles[0] = {3, 2, 1};
    const Mesh three = part_of(mesh, last);
    EXPECT_EQ(three.positions.size(), 3U);
    EXPECT_EQ(three.positions[0], mesh.positions[1]);
    EXPECT_EQ(three.colors[2], glm::vec4(1.0F));
    EXPECT_THAT(three.triangles,
                ElementsAre(glm::uvec3(2, 1, 0), glm::uvec3(2, 1, 0), glm::uvec3(2, 1, 0)));
    EXPECT_THAT(three.material_ranges,
                ElementsAre(MaterialRange{0, 1, std::nullopt}, MaterialRange{1, 1, 7U},
                            MaterialRange{2, 1, std::nullopt}));
}

TEST(MeshPart, OfNothingIsEmptyAndOfWhatIsNotThereRefused) {
    EXPECT_THAT(part_of(make_quad(), {}).positions, IsEmpty());
    const std::vector<std::uint32_t> beyond = {2};
    EXPECT_EQ(test::message_of<InvalidInput>([&] { part_of(make_quad(), beyond); }),
              "there is no triangle 2");
}

}  // namespace
}  // namespace relief
