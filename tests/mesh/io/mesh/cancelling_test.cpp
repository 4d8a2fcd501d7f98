// SPDX-License-Identifier: Apache-2.0
// Readers of meshes say how far they are, and end when that is wished, wherever they are.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include "relief/mesh/frames.h"
#include "relief/mesh/mesh_file.h"
#include "relief/mesh/progress.h"
#include "support/shared_data.h"

namespace relief {
namespace {

constexpr int side = 300;  // Squares of a grid: 180 000 triangles, some megabytes of text.

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
    /// As a viewer does.
    std::size_t triangles_read() const {
        Report report;
        MeshFile read = read_mesh(file_, report);
        return with_frames(std::move(read.mesh), FrameOptions(), report).mesh.triangles.size();
    }

    test::TemporaryDirectory folder_;
    std::filesystem::path file_ = folder_ / ("grid" + GetParam());
};

TEST_P(Cancelling, EveryStageIsToldAndEndsWhereThatIsWished) {
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

    // Wished when a stage is first heard of, it comes to no other.
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
