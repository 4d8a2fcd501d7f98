// SPDX-License-Identifier: Apache-2.0
// All real and all broken mesh files: a valid mesh or a FileError that names the file, nothing
// else.
#include "relief/mesh/mesh_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "relief/mesh/error.h"
#include "support/shapes.h"
#include "support/shared_data.h"

namespace relief {
namespace {

using testing::HasSubstr;

std::vector<std::filesystem::path> mesh_files_below(const std::filesystem::path& folder) {
    static const std::set<std::string> extensions = {".obj", ".ply", ".stl", ".STL", ".off"};
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        if (extensions.contains(entry.path().extension().string())) files.push_back(entry.path());
    }
    return files;
}

/// Whether the file was read; fails the test on anything but a valid mesh or a proper FileError.
bool is_read(const std::filesystem::path& file) {
    try {
        Report report;
        const MeshFile contents = read_mesh(file, report);
        EXPECT_NO_THROW(validate(contents.mesh)) << file;
        EXPECT_FALSE(contents.mesh.triangles.empty()) << file;
        for (const MaterialRange& range : contents.mesh.material_ranges) {
            if (!range.material) continue;
            EXPECT_LT(*range.material, contents.materials.size()) << file;
        }
        return true;
    } catch (const FileError& error) {
        EXPECT_THAT(error.what(), HasSubstr(file.string() + ": "));
        return false;
    }
}

TEST(MeshFile, EveryRealModelWithTrianglesIsRead) {
    RELIEF_NEEDS_SHARED(models, "data/models");
    // Without triangles (points or lines only), malformed (3.1+e2; lists where a number is
    // declared), or in UTF-16.
    const std::set<std::string> refused = {"box_UTF16BE.obj",
                                           "number_formats.obj",
                                           "mesh-negative-indices.obj",
                                           "mesh-positions-optional-coordinate.obj",
                                           "mesh-texture-coordinates-normals.obj",
                                           "mesh-texture-coordinates-optional-coordinate.obj",
                                           "line-prim.obj",
                                           "points-prim.obj",
                                           "issue623.ply",
                                           "points.ply",
                                           "points_ascii_with_lists.ply"};
    const auto files = mesh_files_below(models);
    EXPECT_GT(files.size(), 100U);
    for (const auto& file : files) {
        EXPECT_EQ(is_read(file), !refused.contains(file.filename().string())) << file;
    }
}

TEST(MeshFile, EveryBrokenModelIsReadOrRefused) {
    RELIEF_NEEDS_SHARED(broken, "data/broken");
    const std::set<std::string> read = {"degenerate_mesh.obj",
                                        "test_wrong_attribute_mapping.obj",
                                        "invalid-mixed-primitives.obj",
                                        "issue-161-inconsistent-f.obj",
                                        "issue-235-usemtl-then-o.obj",
                                        "issue-295-trianguation-failure.obj",
                                        "test-nan.obj",
                                        "nancolor.obj",
                                        "notenoughindices.obj",
                                        "singlevn.obj",
                                        "origin_inside.STL"};
    std::set<std::string> actually_read;
    for (const auto& file : mesh_files_below(broken)) {
        if (is_read(file)) actually_read.insert(file.filename().string());
    }
    EXPECT_EQ(actually_read, read);
}

TEST(MeshFile, EveryTruncationOfABinaryFileIsRefused) {
    const test::TemporaryDirectory folder;
    write_mesh(folder / "a.ply", {test::cube(), {}});
    for (auto length = std::filesystem::file_size(folder / "a.ply"); length-- > 0;) {
        std::filesystem::resize_file(folder / "a.ply", length);
        EXPECT_FALSE(is_read(folder / "a.ply")) << length;
    }
}

TEST(MeshFile, WhatIsNoMeshFileIsRefusedByName) {
    const test::TemporaryDirectory folder;
    Report report;
    const auto error_of = [&](const std::filesystem::path& file) {
        try {
            read_mesh(file, report);
        } catch (const FileError& error) {
            return std::string(error.what());
        }
        return std::string("no error");
    };
    EXPECT_THAT(error_of(folder / "none.obj"), HasSubstr("none.obj: no such file"));
    EXPECT_THAT(error_of(folder / "a.fbx"), HasSubstr("'.fbx' is no mesh format"));
    std::filesystem::create_directory(folder / "b.ply");
    EXPECT_THAT(error_of(folder / "b.ply"), HasSubstr("is not a file"));
    EXPECT_THROW(write_mesh(folder / "a.stl", {test::cube(), {}}), InvalidInput);
    EXPECT_THROW(write_mesh(folder / "no/such/a.ply", {test::cube(), {}}), FileError);
    MeshFile contents{test::cube(), {}};
    contents.mesh.material_ranges = {{0, 12, 3U}};
    EXPECT_THROW(write_mesh(folder / "a.obj", contents), InvalidInput);
}

}  // namespace
}  // namespace relief
