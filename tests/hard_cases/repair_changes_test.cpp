// SPDX-License-Identifier: Apache-2.0
// Repair of the hard meshes: every result is manifold, a second repair changes nothing, and changes
// of a mesh (mesh_changes.h) do not change its repair.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "hard_cases/mesh_changes.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/repair.h"
#include "support/manifold.h"

namespace relief::test {
namespace {

/// The position, normal and texture coordinate at each corner of a triangle.
using RepairedValues = std::array<std::array<std::uint32_t, 8>, 3>;

/// Returns the values of all triangles without their order and first corners.
std::vector<RepairedValues> repaired_values(const Mesh& mesh, const MeshVariant& variant) {
    std::vector<RepairedValues> all;
    for (const glm::uvec3& triangle : mesh.triangles) {
        RepairedValues values{};
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t v = triangle[static_cast<int>(k)];
            auto to = values[k].begin();
            const auto append = [&to](const auto& vector) {
                for (int i = 0; i < vector.length(); ++i)
                    *to++ = std::bit_cast<std::uint32_t>(vector[i] + 0.0F);
            };
            append(mesh.positions[v] / variant.scale);
            append(mesh.normals[v]);
            append(mesh.texcoords[v] / variant.texture_scale);
        }
        RepairedValues least = values;
        for (int turn = 0; turn < 2; ++turn) {
            std::rotate(values.begin(), values.begin() + 1, values.end());
            least = std::min(least, values);
        }
        all.push_back(least);
    }
    std::sort(all.begin(), all.end());
    return all;
}

TEST(RepairedHardMeshes, AreManifoldAndAreNotChangedAgain) {
    for (const NamedMesh& named : metamorphic_meshes()) {
        const Mesh once = repaired(named.mesh).mesh;
        ASSERT_NO_THROW(validate(once)) << named.name;
        const ManifoldFaults faults = manifold_faults(once);
        EXPECT_TRUE(faults.is_manifold())
            << named.name << ": " << faults.crowded_edges << " crowded, " << faults.twisted_edges
            << " twisted, " << faults.fans << " fans, " << faults.collapsed << " collapsed";
        const Mesh twice = repaired(once).mesh;
        const MeshVariant unchanged(once);
        EXPECT_EQ(repaired_values(once, unchanged), repaired_values(twice, unchanged))
            << named.name;
        EXPECT_EQ(once.positions.size(), twice.positions.size()) << named.name;
    }
}

TEST(RepairedHardMeshes, HaveFrontsThatAreManifoldIfSidesStayTogether) {
    const RepairOptions together{.two_sided = TwoSided::together};
    for (const NamedMesh& named : metamorphic_meshes()) {
        const Mesh once = repaired(named.mesh, together).mesh;
        EXPECT_TRUE(
            manifold_faults(repaired(once, {.two_sided = TwoSided::single}).mesh).is_manifold())
            << named.name;
        const Mesh twice = repaired(once, together).mesh;
        const MeshVariant unchanged(once);
        EXPECT_EQ(repaired_values(once, unchanged), repaired_values(twice, unchanged))
            << named.name;
    }
}

class RepairChanges : public testing::TestWithParam<MeshChange> {};

TEST_P(RepairChanges, LeaveTheResultAlone) {
    std::uint32_t seed = 0;
    for (const NamedMesh& named : metamorphic_meshes()) {
        Dice dice(++seed);
        MeshVariant variant(named.mesh);
        GetParam().apply(variant, dice);
        const MeshVariant original(named.mesh);
        for (const TwoSided two_sided : {TwoSided::keep, TwoSided::together}) {
            const RepairOptions options{.two_sided = two_sided};
            EXPECT_EQ(repaired_values(repaired(named.mesh, options).mesh, original),
                      repaired_values(repaired(variant.mesh, options).mesh, variant))
                << named.name << ", two sides: " << enum_name(two_sided);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Metamorphic, RepairChanges, testing::ValuesIn(mesh_changes),
                         name_of_change);

}  // namespace
}  // namespace relief::test
