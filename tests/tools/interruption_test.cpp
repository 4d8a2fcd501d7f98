// SPDX-License-Identifier: Apache-2.0
// Tools that are interrupted while they write: no half file, no temporary one, the old one
// unharmed, and the shell is told which signal it was.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <utility>

#include "relief/mesh/image_file.h"
#include "support/labels.h"
#include "tools/workplace.h"

namespace relief::test {
namespace {

FILE_LABELS(not_sanitized);

/// A map of noise: writing its normals takes a while.
void write_noise(const std::filesystem::path& file, int size) {
    Image heights = make_image(size, size, 1, 16, ColorSpace::data);
    std::uint32_t state = 5;
    for (std::uint16_t& sample : heights.as<std::uint16_t>()) {
        state = state * 1664525U + 1013904223U;
        sample = static_cast<std::uint16_t>(state >> 20);
    }
    write_image(file, heights);
}

/// Returns whether something is being written beside.
bool is_writing(const std::filesystem::path& folder) {
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().filename().string().starts_with(".")) return true;
    }
    return false;
}

TEST(Interruption, LeavesOnlyTheOldFileAndDiesByTheSignal) {
    const Workplace place;
    write_noise(place / "heights.png", 2400);
    // Both writers under one signal, and each signal once.
    for (const auto& [name, signal] :
         {std::pair{"out/normals.png", SIGINT}, std::pair{"out/normals.png", SIGTERM},
          std::pair{"out/normals.png", SIGHUP}, std::pair{"out/normals.tif", SIGINT}}) {
        place.write(name, "old");
        const ProgramResult result = run_program_until(
            {"relief-bake", "bump", "heights.png", name, "--kernel", "sobel3"}, place / ".",
            [&] { return is_writing(place / "out"); }, signal);
        EXPECT_EQ(result.exit_code, 128 + signal) << result.error;
        EXPECT_EQ(result.error, "");
        EXPECT_EQ(place.outputs(), std::filesystem::path(name).filename().string());
        EXPECT_EQ(place.read(name), "old");
        std::filesystem::remove(place / name);
    }
}

TEST(Interruption, OfABakeLeavesNoMap) {
    const Workplace place;
    place.write("low.obj",
                "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                "usemtl A\nf 1/1 2/2 3/3 4/4\nusemtl B\nf 1/1 2/2 3/3 4/4\n");
    for (const char* padding : {"16", "border"}) {
        const ProgramResult result = run_program_until(
            {"relief-bake", "mesh", "low.obj", "low.obj", "out/<material>.png", "--size", "2048",
             "--padding", padding},
            place / ".", [&] { return is_writing(place / "out"); }, SIGINT);
        EXPECT_EQ(result.exit_code, 128 + SIGINT) << result.error;
        EXPECT_EQ(place.outputs(), "");
    }
}

/// Writes a rough sheet of cells x cells squares, which takes a while to unwrap.
void write_rough_sheet(const std::filesystem::path& file, int cells) {
    std::ofstream stream(file);
    std::uint32_t state = 7;
    for (int y = 0; y <= cells; ++y) {
        for (int x = 0; x <= cells; ++x) {
            state = state * 1664525U + 1013904223U;
            stream << "v " << x << ' ' << y << ' ' << static_cast<double>(state >> 16) * 3e-5
                   << '\n';
        }
    }
    for (int y = 0; y < cells; ++y) {
        for (int x = 0; x < cells; ++x) {
            const int a = y * (cells + 1) + x + 1;
            stream << "f " << a << ' ' << a + 1 << ' ' << a + cells + 2 << ' ' << a + cells + 1
                   << '\n';
        }
    }
}

TEST(Interruption, OfUnwrappingLeavesTheOldFile) {
    using Clock = std::chrono::steady_clock;
    const Workplace place;
    write_rough_sheet(place / "sheet.obj", 300);
    place.write("out/a.glb", "old");
    // While the sheet is read, divided and packed, roughly.
    for (const int milliseconds : {10, 250, 500}) {
        const Clock::time_point start = Clock::now();
        const ProgramResult result = run_program_until(
            {"relief-mesh", "unwrap", "sheet.obj", "out/a.glb", "--threads", "1"}, place / ".",
            [&] { return Clock::now() - start > std::chrono::milliseconds(milliseconds); }, SIGINT);
        EXPECT_EQ(result.exit_code, 128 + SIGINT) << result.error;
        EXPECT_EQ(result.error, "");
        EXPECT_EQ(place.outputs(), "a.glb");
        EXPECT_EQ(place.read("out/a.glb"), "old");
    }
}

TEST(Interruption, AFileThatGetsTooLargeIsAnErrorLikeAFullDisc) {
    const Workplace place;
    write_noise(place / "heights.png", 500);
    for (const char* name : {"out/normals.png", "out/normals.tif"}) {
        place.write(name, "old");
        const ProgramResult result = place.run(
            "ulimit -f 100; relief-bake bump --kernel sobel3 heights.png " + std::string(name));
        EXPECT_EQ(result.exit_code, 1);
        EXPECT_THAT(result.error, testing::StartsWith("relief-bake: error: " + std::string(name) +
                                                      ": cannot be written: "));
        EXPECT_EQ(place.outputs(), std::filesystem::path(name).filename().string());
        EXPECT_EQ(place.read(name), "old");
        std::filesystem::remove(place / name);
    }
}

TEST(Interruption, AReaderThatWentAwayEndsTheToolQuietly) {
    const Workplace place;
    place.write_square("square.obj");
    // The pipe has no reader when the tool writes to it.
    const ProgramResult result =
        place.run("(sleep 0.2; relief-mesh check square.obj; echo $? > out/code) | true");
    EXPECT_EQ(result.error, "");
    EXPECT_EQ(place.read("out/code"), "1\n");
}

}  // namespace
}  // namespace relief::test
