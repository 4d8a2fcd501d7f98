// SPDX-License-Identifier: Apache-2.0
// The image module: it is loaded by the first image that needs it, from the configured folder, and
// its files do not depend on the clock. Fresh processes are tested by running this program again
// with other folders and variables.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "mesh/io/image/module_reference.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/report.h"
#include "support/shared_data.h"

namespace relief {
namespace {

using test::read_bytes;
using test::TemporaryDirectory;
using testing::HasSubstr;
using testing::Not;

bool module_is_mapped() {
    std::ifstream maps("/proc/self/maps");
    const std::string all{std::istreambuf_iterator<char>(maps), {}};
    return all.find("libOpenImageIO") != std::string::npos;
}

const Image one_texel = make_image(1, 1, 1, 8, ColorSpace::data);

// Only the tests below run it, in a separate process.
TEST(ImageModuleChild, WritesReadsAndReportsResults) {
    const char* file = std::getenv("RELIEF_TEST_IMAGE");
    if (file == nullptr) GTEST_SKIP() << "is started by other tests";
    std::printf("mapped at start: %d\n", module_is_mapped());
    try {
        read_image(std::as_bytes(std::span("no image")), "none", ImageUse::data);
    } catch (const FileError&) {
        std::printf("mapped after a text file: %d\n", module_is_mapped());
    }
    try {
        const std::filesystem::path png = std::filesystem::path(file).replace_extension(".png");
        write_image(png, one_texel);
        read_image(png, ImageUse::data);
        std::printf("mapped after a PNG: %d\n", module_is_mapped());
        write_image(file, one_texel);
        std::printf("mapped after a TIFF: %d\n", module_is_mapped());
        std::printf("width %d\n", read_image(file, ImageUse::data).width);
    } catch (const FileError& error) {
        std::printf("failed: %s\n", error.what());
    }
}

/// Returns the output of the child when this program runs as `program`.
std::string child_output(const std::filesystem::path& program, const std::string& module_folder,
                         const std::filesystem::path& image) {
    const std::string command = "RELIEF_MODULE_DIR='" + module_folder + "' RELIEF_TEST_IMAGE='" +
                                image.string() + "' '" + program.string() +
                                "' --gtest_filter='ImageModuleChild.*' 2>&1";
    std::FILE* pipe = ::popen(command.c_str(), "r");
    std::string output;
    std::array<char, 4096> buffer{};
    while (std::fgets(buffer.data(), buffer.size(), pipe) != nullptr)
        output += buffer.data();
    EXPECT_EQ(::pclose(pipe), 0) << output;
    return output;
}

std::filesystem::path this_program() {
    return std::filesystem::read_symlink("/proc/self/exe");
}

/// Returns a copy of this program in a separate tree without a module.
std::filesystem::path program_elsewhere(const TemporaryDirectory& folder) {
    std::filesystem::create_directory(folder / "bin");
    std::filesystem::copy_file(this_program(), folder / "bin/program");
    return folder / "bin/program";
}

TEST(ImageModule, IsNotLoadedBeforeTheFirstImageNeedsIt) {
    const TemporaryDirectory folder;
    const std::string output = child_output(this_program(), "", folder / "a.tif");
    EXPECT_THAT(output, HasSubstr("mapped at start: 0"));
    EXPECT_THAT(output, HasSubstr("mapped after a text file: 0"));
    EXPECT_THAT(output, HasSubstr("mapped after a PNG: 0"));
    EXPECT_THAT(output, HasSubstr("mapped after a TIFF: 1"));
    EXPECT_THAT(output, HasSubstr("width 1"));
}

TEST(ImageModule, MissingModuleErrorListsTheSearchedFolders) {
    const TemporaryDirectory folder;
    const std::string output =
        child_output(program_elsewhere(folder), "/nowhere/modules", folder / "a.tif");
    EXPECT_THAT(output, HasSubstr("failed: " + (folder / "a.tif").string() +
                                  ": relief's image module relief_image.so was not found"));
    EXPECT_THAT(output, HasSubstr("not at /nowhere/modules/relief_image.so"));
    EXPECT_THAT(output, HasSubstr("not at " + (folder / "lib/relief/relief_image.so").string()));
    EXPECT_FALSE(std::filesystem::exists(folder / "a.tif"));
}

TEST(ImageModule, WithoutTheDecoderNoFileIsDecodedInThisProcess) {
    const TemporaryDirectory folder;
    const std::filesystem::path program = program_elsewhere(folder);
    std::filesystem::create_directories(folder / "lib/relief");
    std::filesystem::copy_file(
        this_program().parent_path().parent_path() / "lib/relief/relief_image.so",
        folder / "lib/relief/relief_image.so");
    const std::string output = child_output(program, "", folder / "a.tif");
    EXPECT_THAT(output, HasSubstr("mapped after a TIFF: 1"));
    EXPECT_THAT(output, HasSubstr("failed: " + (folder / "a.tif").string() +
                                  ": relief's image decoder relief-image-decoder was not found"));
    EXPECT_THAT(output,
                HasSubstr("not at " + (folder / "lib/relief/relief-image-decoder").string()));
}

TEST(ImageModule, TheVariableIsLookedAtFirst) {
    const TemporaryDirectory folder;
    const std::filesystem::path modules = this_program().parent_path().parent_path() / "lib/relief";
    const std::string output =
        child_output(program_elsewhere(folder), modules.string(), folder / "a.tif");
    EXPECT_THAT(output, HasSubstr("width 1"));
}

TEST(ImageModule, ABrokenModuleIsNamedWithTheLoadersOwnWords) {
    const TemporaryDirectory folder;
    std::filesystem::create_directories(folder / "lib/relief");
    std::ofstream(folder / "lib/relief/relief_image.so") << "no library";
    const std::string output = child_output(program_elsewhere(folder), "", folder / "a.tif");
    EXPECT_THAT(output, HasSubstr("does not load: "));
    EXPECT_THAT(output, HasSubstr("too short"));
    EXPECT_THAT(output, Not(HasSubstr("width")));
}

struct SlowKind {
    const char* name;
    int bits;
};
constexpr SlowKind slow_kinds[] = {{"16.tif", 16}, {"32.tif", 32}, {"32.exr", 32}};

/// The pause exceeds the five seconds after which OpenImageIO reads the clock.
constexpr std::chrono::milliseconds pause(5300);
/// Rows reach the encoder in bands of 8 MB: at least one before the pause and one after it.
constexpr int map_width = 16384, map_height = 512;

/// Returns half of the rows of a nonuniform map.
std::vector<std::byte> half_of(const SlowKind& kind, int part) {
    const std::size_t count = std::size_t{map_width} * map_height / 2;
    std::vector<std::byte> bytes(count * static_cast<std::size_t>(kind.bits / 8));
    for (std::size_t i = 0; i < count; ++i) {
        const auto code = static_cast<std::uint16_t>((i / 7 + i / map_width * 3) % 251 +
                                                     static_cast<std::size_t>(part));
        const auto value = static_cast<float>(code) / 256.0F;
        std::byte* at = &bytes[i * static_cast<std::size_t>(kind.bits / 8)];
        if (kind.bits == 32)
            std::memcpy(at, &value, sizeof value);
        else
            std::memcpy(at, &code, static_cast<std::size_t>(kind.bits / 8));
    }
    return bytes;
}

std::vector<std::string> written(std::chrono::milliseconds between_halves) {
    const TemporaryDirectory folder;
    std::vector<std::unique_ptr<ImageRowWriter>> writers;
    for (const SlowKind& kind : slow_kinds) {
        const ImageShape shape{map_width, map_height, 1, kind.bits, ColorSpace::data};
        writers.push_back(std::make_unique<ImageRowWriter>(folder / kind.name, shape));
    }
    for (int part = 0; part < 2; ++part) {
        for (std::size_t i = 0; i < writers.size(); ++i)
            writers[i]->write(half_of(slow_kinds[i], part));
        if (part == 0) std::this_thread::sleep_for(between_halves);
    }
    std::vector<std::string> files;
    for (std::size_t i = 0; i < writers.size(); ++i) {
        writers[i]->finish();
        files.push_back(read_bytes(folder / slow_kinds[i].name));
    }
    return files;
}

TEST(ImageRowsClock, TheSameRowsGiveTheSameFileHoweverLongTheyTake) {
    const std::vector<std::string> at_once = written(std::chrono::milliseconds(0));
    const std::vector<std::string> slowly = written(pause);
    for (std::size_t i = 0; i < at_once.size(); ++i)
        EXPECT_TRUE(at_once[i] == slowly[i]) << slow_kinds[i].name << " " << at_once[i].size()
                                             << " and " << slowly[i].size() << " bytes";
}

}  // namespace

}  // namespace relief
