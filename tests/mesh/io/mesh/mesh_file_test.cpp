// SPDX-License-Identifier: Apache-2.0
// Mesh files of all formats: extensions, errors, local origins of distant meshes, progress and
// cancellation.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <set>
#include <string>

#include "io/mesh/mesh_formats.h"
#include "mesh/io/mesh/mesh_files.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/local_origin.h"
#include "relief/mesh/mesh_file.h"
#include "relief/mesh/normals.h"
#include "relief/mesh/report.h"
#include "support/invariants.h"
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

/// Returns whether the file was read. The test fails unless the result is a valid mesh or a proper
/// FileError.
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
    // Files without triangles (points or lines only), malformed ones (3.1+e2; lists instead of a
    // declared number), or in UTF-16.
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
            std::filesystem::remove(file);  // ext4 waits for the disk when a file is truncated.
            std::ofstream(file, std::ios::binary) << bytes;
            if (is_read(file)) ++read;
        }
        EXPECT_GT(read, 50) << name;
    }
}

TEST(MeshFile, RefusesOtherExtensions) {
    const test::TemporaryDirectory folder;
    Report report;
    const auto error_of = [&](const std::filesystem::path& file) {
        return test::message_of<FileError>([&] { read_mesh(file, report); });
    };
    EXPECT_THAT(error_of(folder / "none.obj"), HasSubstr("none.obj: no such file"));
    EXPECT_THAT(error_of(folder / "a.fbx"), HasSubstr("'.fbx' is not a mesh format"));
    std::filesystem::create_directory(folder / "b.ply");
    EXPECT_THAT(error_of(folder / "b.ply"), HasSubstr("is not a file"));
    EXPECT_THROW(write_mesh(folder / "a.stl", {test::cube(), {}}), InvalidInput);
    EXPECT_THROW(write_mesh(folder / "no/such/a.ply", {test::cube(), {}}), FileError);
    MeshFile contents{test::cube(), {}};
    contents.mesh.material_ranges = {{0, 12, 3U}};
    EXPECT_THROW(write_mesh(folder / "a.obj", contents), InvalidInput);
}

class FarPositions : public test::MeshTextTest {
  protected:
    FarPositions() : MeshTextTest("a.obj") {}

    MeshFile read_as(const std::string& name, const std::string& bytes) {
        report_ = {};
        return read_mesh(write(name, bytes), report_);
    }
};

/// A roof of 1 by 1 with a ridge of height 0.25, at a distance of `far` from 0 in every coordinate.
const std::vector<glm::dvec3> roof = {{0, 0, 0.001}, {0.5, 0, 0.25}, {0.5, 1, 0.25},
                                      {0, 1, 0.002}, {1, 0, 0.003},  {1, 1, 0.004}};
const std::vector<glm::uvec3> far_faces = {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}};

std::string obj_text(double far, double scale = 1.0) {
    std::string text;
    for (const glm::dvec3& p : roof)
        text +=
            fmt::format("v {} {} {}\n", far + scale * p.x, far + scale * p.y, far + scale * p.z);
    for (const glm::uvec3& f : far_faces)
        text += fmt::format("f {} {} {}\n", f.x + 1, f.y + 1, f.z + 1);
    return text;
}

std::string off_text(double far) {
    std::string text = "OFF\n6 4 0\n";
    for (const glm::dvec3& p : roof)
        text += fmt::format("{} {} {}\n", far + p.x, far + p.y, far + p.z);
    for (const glm::uvec3& f : far_faces)
        text += fmt::format("3 {} {} {}\n", f.x, f.y, f.z);
    return text;
}

std::string ply_text(double far) {
    std::string text =
        "ply\nformat ascii 1.0\nelement vertex 6\nproperty double x\nproperty double y\n"
        "property double z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n";
    for (const glm::dvec3& p : roof)
        text += fmt::format("{} {} {}\n", far + p.x, far + p.y, far + p.z);
    for (const glm::uvec3& f : far_faces)
        text += fmt::format("3 {} {} {}\n", f.x, f.y, f.z);
    return text;
}

std::string stl_text(double far) {
    std::string text = "solid a\n";
    for (const glm::uvec3& f : far_faces) {
        text += "facet normal 0 0 0\nouter loop\n";
        for (int i = 0; i < 3; ++i) {
            const glm::dvec3& p = roof[f[i]];
            text += fmt::format("vertex {} {} {}\n", far + p.x, far + p.y, far + p.z);
        }
        text += "endloop\nendfacet\n";
    }
    return text + "endsolid a\n";
}

std::vector<glm::vec3> normals_of(const Mesh& mesh) {
    Report report;
    return vertex_normals(mesh.positions, mesh.triangles, NormalWeight::angle, report);
}

TEST(LocalOrigin, IsZeroUpTo16TimesTheSize) {
    EXPECT_EQ(local_origin({15.0, 0.0, 0.0}, {16.0, 1.0, 0.5}), glm::dvec3(0.0));
    EXPECT_EQ(local_origin({-16.0, 0.0, 0.0}, {-15.0, 1.0, 0.5}), glm::dvec3(0.0));
}

TEST(LocalOrigin, IsTheMiddleRoundedToAPowerOfTwo) {
    EXPECT_EQ(local_origin({100.0, -1.0, 0.0}, {103.0, 1.0, 0.0}), glm::dvec3(100.0, 0.0, 0.0));
    EXPECT_EQ(local_origin({7.25, 0.0, 0.0}, {7.25, 0.0, 0.0}), glm::dvec3(7.25, 0.0, 0.0));
}

TEST_F(FarPositions, AreReadInDoubleFromEveryTextFormat) {
    const std::vector<glm::vec3> expected = normals_of(read_as("near.obj", obj_text(0.0)).mesh);
    for (const double far : {1e5, 4e6, 1e8}) {
        for (const auto& [name, text] : {std::pair{"a.obj", obj_text(far)},
                                         {"a.off", off_text(far)},
                                         {"a.ply", ply_text(far)}}) {
            const MeshFile file = read_as(name, text);
            EXPECT_EQ(report_.count("far from the origin"), 1U) << name;
            ASSERT_EQ(file.mesh.positions.size(), 6U);
            const std::vector<glm::vec3> normals = normals_of(file.mesh);
            for (std::size_t v = 0; v < 6; ++v) {
                const glm::dvec3 back = glm::dvec3(file.mesh.positions[v]) + file.origin;
                // Doubles near 1e8 are 1.5e-8 apart, floats near 1 are 6e-8 apart.
                EXPECT_LE(glm::distance(back, glm::dvec3(far) + roof[v]), 1e-7)
                    << name << " " << far;
                EXPECT_LE(test::degrees_between(normals[v], expected[v]), 2e-5)
                    << name << " " << far;
            }
        }
        const MeshFile stl = read_as("a.stl", stl_text(far));
        EXPECT_EQ(stl.mesh.positions.size(), 6U) << "corners that floats would have merged";
        EXPECT_EQ(stl.mesh.triangles.size(), 4U);
    }
}

TEST_F(FarPositions, StayDistinctDespiteFloatPrecision) {
    const MeshFile file = read_as("a.obj", obj_text(1e7, 1e-3));
    const std::vector<glm::vec3> expected = normals_of(read_as("near.obj", obj_text(0.0)).mesh);
    const std::vector<glm::vec3> normals = normals_of(file.mesh);
    for (std::size_t v = 0; v < 6; ++v) {
        // Doubles near 1e7 are 1.9e-9 apart: 2e-6 of the size of the roof.
        EXPECT_LE(test::degrees_between(normals[v], expected[v]), 1e-3);
    }
}

TEST_F(FarPositions, StayUnchangedIfFloatsSuffice) {
    std::string text;
    for (const glm::dvec3& p : roof)
        text += fmt::format("v {} {} {}\n", 524288.0 + 2.0 * p.x, 524288.0 + p.y, 0.25);
    text += "f 1 2 5\n";
    const MeshFile whole = read_as("a.obj", text);
    EXPECT_EQ(whole.origin, glm::dvec3(0.0));
    EXPECT_TRUE(report_.empty());
    EXPECT_EQ(whole.mesh.positions[1], glm::vec3(524289.0F, 524288.0F, 0.25F));
    // The limit is a distance of 16 sizes; the farthest corner is 1 beyond the given distance.
    EXPECT_EQ(read_as("b.obj", obj_text(15.0)).origin, glm::dvec3(0.0)) << "not far for its size";
    EXPECT_EQ(read_as("d.obj", obj_text(15.5)).origin, glm::dvec3(16.0)) << "far for its size";
    EXPECT_EQ(read_as("c.obj", "v nan 0 0\nv inf 1 0\nv 0 nan 1\nf 1 2 3\n").origin,
              glm::dvec3(0.0));
}

TEST_F(FarPositions, ComeBackWhenWritten) {
    const MeshFile file = read_as("a.obj", obj_text(4e6));
    for (const char* name : {"b.obj", "b.ply"}) {
        write_mesh(folder_ / name, file);
        const MeshFile again = read_mesh(folder_ / name, report_);
        EXPECT_EQ(again.origin, file.origin) << name;
        EXPECT_EQ(again.mesh.positions, file.mesh.positions) << name;
    }
    GltfDocument::from_mesh(file).write(folder_ / "b.gltf");
    const GltfDocument document = GltfDocument::read(folder_ / "b.gltf", report_);
    EXPECT_EQ(document.mesh({0, 0}).positions, file.mesh.positions);
    EXPECT_EQ(document.view().nodes[0].translation, glm::vec3(file.origin));
}

TEST_F(FarPositions, FindingsAreCountedOnce) {
    const MeshFile file = read_as("a.obj", obj_text(4e6) + "p 1\nl 1 2\n");
    EXPECT_NE(file.origin, glm::dvec3(0.0));
    EXPECT_EQ(report_.count("point"), 1U);
    EXPECT_EQ(report_.count("line"), 1U);
}

constexpr int side = 300;  // A grid of 180 000 triangles, several megabytes of text.

class Cancelling : public testing::TestWithParam<std::string> {
  protected:
    void SetUp() override {
        if (GetParam() == ".obj" || GetParam() == ".off") {
            write_text();
        } else {
            write_binary();
        }
    }
    void write_text() const {
        const bool is_obj = GetParam() == ".obj";
        std::string text =
            is_obj ? "" : fmt::format("OFF\n{} {} 0\n", (side + 1) * (side + 1), 2 * side * side);
        for (int i = 0; i < (side + 1) * (side + 1); ++i)
            text += fmt::format("{}{} {} 0\n", is_obj ? "v " : "", i % (side + 1), i / (side + 1));
        for (int i = 0; i < side * side; ++i) {
            const int a = i / side * (side + 1) + i % side + (is_obj ? 1 : 0);
            const char* begin = is_obj ? "f" : "3";
            text += fmt::format("{} {} {} {}\n{} {} {} {}\n", begin, a, a + 1, a + side + 2, begin,
                                a, a + side + 2, a + side + 1);
        }
        std::ofstream(file_) << text;
    }
    void write_binary() const {
        if (GetParam() == ".stl") {
            std::ofstream stl(file_, std::ios::binary);
            const std::uint32_t count = 2 * side * side;
            stl << std::string(80, ' ');
            stl.write(reinterpret_cast<const char*>(&count), sizeof(count));
            for (std::uint32_t i = 0; i < count; ++i) {
                const auto x = static_cast<float>(i);
                const float facet[12] = {0, 0, 1, x, 0, 0, x + 1, 0, 0, x, 1, 0};
                stl.write(reinterpret_cast<const char*>(facet), sizeof(facet));
                stl.write("\0", 2);
            }
            return;
        }
        MeshFile grid;
        for (int i = 0; i < (side + 1) * (side + 1); ++i)
            grid.mesh.positions.emplace_back(i % (side + 1), i / (side + 1), 0);
        for (int i = 0; i < side * side; ++i) {
            const auto a = static_cast<std::uint32_t>(i / side * (side + 1) + i % side);
            grid.mesh.triangles.emplace_back(a, a + 1, a + side + 2);
            grid.mesh.triangles.emplace_back(a, a + side + 2, a + side + 1);
        }
        write_mesh(file_, grid);
    }
    /// Counts like a viewer.
    std::size_t triangles_read() const {
        Report report;
        MeshFile read = read_mesh(file_, report);
        return with_frames(std::move(read.mesh), FrameOptions(), report).mesh.triangles.size();
    }

    test::TemporaryDirectory folder_;
    std::filesystem::path file_ = folder_ / ("grid" + GetParam());
};

TEST_P(Cancelling, EveryStageIsReportedAndCancelable) {
    std::vector<std::string> stages;
    std::size_t words = 0;
    Progress whole([&](const Progress::State& state) {
        ++words;
        if (stages.empty() || stages.back() != state.stage) stages.push_back(state.stage);
        EXPECT_TRUE(!state.part || (*state.part >= 0.0 && *state.part <= 1.0));
    });
    {
        const ProgressScope scope(whole);
        EXPECT_EQ(triangles_read(), 2U * side * side);
    }
    EXPECT_EQ(stages.front(), "reading");
    EXPECT_EQ(stages.back(), "normals");
    EXPECT_GE(stages.size(), 3U);
    EXPECT_EQ(whole.files().count(file_), 1U);

    // A request at the first report of a stage prevents every other stage.
    for (const std::string& last : std::set<std::string>(stages.begin(), stages.end())) {
        Progress* wishing = nullptr;
        std::string heard;
        Progress progress([&](const Progress::State& state) {
            heard = state.stage;
            if (state.stage == last) wishing->cancel();
        });
        wishing = &progress;
        const ProgressScope scope(progress);
        EXPECT_THROW(triangles_read(), Cancelled) << last;
        EXPECT_EQ(heard, last);
    }
    EXPECT_EQ(triangles_read(), 2U * side * side) << "nothing is left behind";
}

INSTANTIATE_TEST_SUITE_P(Formats, Cancelling, testing::Values(".obj", ".ply", ".stl", ".off"),
                         [](const auto& format) { return format.param.substr(1); });

}  // namespace

}  // namespace relief
