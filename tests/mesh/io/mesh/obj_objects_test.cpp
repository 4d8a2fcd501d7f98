// SPDX-License-Identifier: Apache-2.0
// Which object the triangles of an OBJ file belong to: by o, else by g, whatever their materials.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "relief/mesh/mesh_file.h"
#include "support/shared_data.h"

namespace relief {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// The faces of a file are triangles over the same three vertices.
MeshFile read(const std::string& statements) {
    const test::TemporaryDirectory folder;
    const std::filesystem::path file = folder / "some.obj";
    std::ofstream(file) << "v 0 0 0\nv 1 0 0\nv 0 1 0\n" << statements;
    Report report;
    return read_mesh(file, report);
}

TEST(ObjObjects, AreThoseOfOWhereThereIsOne) {
    const MeshFile file = read(
        "f 1 2 3\no bolt high\ng left\nf 1 2 3\nf 2 3 1\no none\no nut\nf 1 2 3\n"
        "o bolt high\nf 3 2 1\n");
    EXPECT_THAT(file.objects, ElementsAre("", "bolt high", "nut"));
    EXPECT_THAT(file.object_of, ElementsAre(0, 1, 1, 2, 1));
}

TEST(ObjObjects, AreGroupsElse) {
    const MeshFile file = read("g a b\nf 1 2 3\ng c\nf 1 2 3\n");
    EXPECT_THAT(file.objects, ElementsAre("a b", "c"));
    EXPECT_THAT(file.object_of, ElementsAre(0, 1));
    EXPECT_THAT(read("f 1 2 3\n").objects, IsEmpty());
    const MeshFile one = read("o only\ng a\nf 1 2 3\ng b\nf 1 2 3\n");
    EXPECT_THAT(one.objects, ElementsAre("only"));
    EXPECT_THAT(one.object_of, IsEmpty());
}

TEST(ObjObjects, GoWithTheirTrianglesWhenTheseAreGroupedByMaterialAndCut) {
    const MeshFile file = read(
        "v 1 1 0\no a\nusemtl red\nf 1 2 4 3\nusemtl blue\nf 1 2 3\no b\nusemtl red\nf 1 2 3\n");
    EXPECT_THAT(file.object_of, ElementsAre(0, 0, 1, 0));
}

}  // namespace
}  // namespace relief
