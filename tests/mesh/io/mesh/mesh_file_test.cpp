// SPDX-License-Identifier: Apache-2.0
// All real and all broken mesh files: a valid mesh or a FileError that names the file, nothing
// else.
#include "relief/mesh/mesh_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <random>
#include <set>

#include "relief/mesh/error.h"
#include "support/message_of.h"
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

TEST(MeshFile, FilesWithWrongBytesAreReadOrRefused) {
    const test::TemporaryDirectory folder;
    MeshFile contents{test::cube(), {}};
    contents.mesh.colors.assign(contents.mesh.positions.size(), glm::vec4(0.5F));
    contents.materials.resize(1);
    contents.mesh.material_ranges = {{0, 12, 0U}};
    write_mesh(folder / "a.ply", contents);
    write_mesh(folder / "a.obj", contents);
    std::ofstream(folder / "a.off") << "NOFF\n4 2 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n1 1 0 0 0 1\n"
                                       "0 1 0 0 0 1\n4 0 1 2 3\n3 0 1 2\n";
    std::ofstream(folder / "a.stl") << "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n"
                                       "vertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n";
    std::ofstream(folder / "b.ply")
        << "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
           "property float y\nproperty float z\nelement face 1\n"
           "property list uchar int vertex_indices\nproperty list uchar "
           "float texcoord\nend_header\n0 0 0\n1 0 0\n0 1 0\n"
           "3 0 1 2 6 0 0 1 0 0 1\n";
    std::mt19937 random(5);
    for (const char* name : {"a.ply", "a.obj", "a.off", "a.stl", "b.ply"}) {
        std::ifstream stream(folder / name, std::ios::binary);
        const std::string whole((std::istreambuf_iterator<char>(stream)), {});
        const auto file = folder / (std::string("wrong") + &name[1]);
        int read = 0;
        for (int i = 0; i < 2000; ++i) {
            std::string bytes = whole;
            for (unsigned k = 0; k <= random() % 3; ++k) {
                char& byte = bytes[random() % bytes.size()];
                byte = byte >= '0' && byte <= '9' ? static_cast<char>('0' + random() % 10)
                                                  : static_cast<char>(random());
            }
            std::ofstream(file, std::ios::binary) << bytes;
            if (is_read(file)) ++read;
        }
        EXPECT_GT(read, 50) << name;
    }
}

TEST(MeshFile, WhatIsNoMeshFileIsRefusedByName) {
    const test::TemporaryDirectory folder;
    Report report;
    const auto error_of = [&](const std::filesystem::path& file) {
        return test::message_of<FileError>([&] { read_mesh(file, report); });
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
