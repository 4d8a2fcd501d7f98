// SPDX-License-Identifier: Apache-2.0
// Decoding in another process: crashes, endless loops and excessive memory are errors that name the
// file, one process serves many images, and the kernel confines it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "relief/mesh/image_file.h"
#include "relief/mesh/report.h"
#include "support/invariants.h"
#include "support/labels.h"
#include "support/shared_data.h"

namespace relief {
namespace {

FILE_LABELS(alone, not_sanitized);

using test::message_of;
using test::TemporaryDirectory;
using testing::HasSubstr;
using testing::StartsWith;

/// Returns the value of a key in /proc/ID/status.
std::string status_of(const std::filesystem::path& process, const std::string& key) {
    std::ifstream file(process / "status");
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with(key + ":\t")) return line.substr(key.size() + 2);
    }
    return "";
}

/// Returns the decoder processes of this program.
std::vector<std::filesystem::path> decoders() {
    std::vector<std::filesystem::path> found;
    for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
        if (status_of(entry.path(), "PPid") == std::to_string(::getpid()) &&
            status_of(entry.path(), "Name").starts_with("relief-image-d"))
            found.push_back(entry.path());
    }
    return found;
}

/// A TGA of one gray texel.
std::filesystem::path tga_with_texel(const TemporaryDirectory& folder, int value) {
    std::string bytes(19, '\0');
    bytes[2] = 3;
    bytes[12] = bytes[14] = 1;
    bytes[16] = 8;
    bytes[18] = static_cast<char>(value);
    std::filesystem::path file = folder / (std::to_string(value) + ".tga");
    std::ofstream(file, std::ios::binary) << bytes;
    return file;
}

int texel_of(const std::filesystem::path& file) {
    return std::get<std::vector<std::uint8_t>>(read_image(file, ImageUse::data).samples).at(0);
}

TEST(ImageDecoder, OneProcessServesManyImages) {
    const TemporaryDirectory folder;
    EXPECT_EQ(texel_of(tga_with_texel(folder, 7)), 7);
    const std::vector<std::filesystem::path> first = decoders();
    ASSERT_EQ(first.size(), 1);
    for (int value = 8; value < 40; ++value)
        ASSERT_EQ(texel_of(tga_with_texel(folder, value)), value);
    EXPECT_EQ(decoders(), first);
}

/// Returns the limit of processor time of a process in seconds.
int processor_limit(const std::filesystem::path& process) {
    std::ifstream file(process / "limits");
    const std::string key = "Max cpu time";
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with(key)) return std::stoi(line.substr(key.size()));
    }
    return 0;
}

TEST(ImageDecoder, ClosingAnImageHasTimeToo) {
    const TemporaryDirectory folder;
    texel_of(tga_with_texel(folder, 7));
    ASSERT_FALSE(decoders().empty());
    EXPECT_GE(processor_limit(decoders().front()), 6) << "5 s more than it has used";
}

TEST(ImageDecoder, TheKernelConfinesTheProcess) {
    const TemporaryDirectory folder;
    texel_of(tga_with_texel(folder, 7));
    ASSERT_FALSE(decoders().empty());
    const std::filesystem::path process = decoders().front();
    EXPECT_EQ(status_of(process, "NoNewPrivs"), "1");
    EXPECT_EQ(status_of(process, "Seccomp"), "2") << "2 is a filter";
    // Standard input is the socket; no descriptor of this program is inherited.
    std::size_t descriptors = 0;
    for (const auto& entry : std::filesystem::directory_iterator(process / "fd"))
        descriptors += std::filesystem::exists(entry.symlink_status()) ? 1 : 0;
    EXPECT_LE(descriptors, 5U);
}

/// Reads a hostile file, expects its error, and reads a good file after it.
void expect_error(const std::string& name, const std::string& reason) {
    RELIEF_NEEDS_SHARED(file, "data/hostile/" + name);
    const std::string message = message_of<FileError>([&] { read_image(file, ImageUse::data); });
    EXPECT_THAT(message, StartsWith(file.string() + ": "));
    EXPECT_THAT(message, HasSubstr(reason));
    const TemporaryDirectory folder;
    EXPECT_EQ(texel_of(tga_with_texel(folder, 9)), 9);
}

TEST(ImageDecoder, ACrashIsAnErrorOfTheFile) {
    expect_error("psd-sigsegv.psd", "its decoder crashed (Segmentation fault)");
}

TEST(ImageDecoder, AnEndlessLoopEndsAfterSecondsOfProcessorTime) {
    expect_error("dds-zero-blue-mask-endless.dds", "decoding it takes too long");
}

TEST(ImageDecoder, TheMemoryOfASmallFileIsLimited) {
    // The file announces 2 GiB.
    expect_error("psd-colormap-length-2GB.psd", "takes more memory than is permitted");
}

TEST(ImageDecoder, ARowThatAPngCannotHoldIsRefusedBeforeDecoding) {
    RELIEF_NEEDS_SHARED(file, "data/hostile/png-2147483647x1.png");
    EXPECT_THAT(message_of<FileError>([&] { read_image(file, ImageUse::data); }),
                HasSubstr("announces 2147483647 x 1 texels, which its 74 bytes cannot hold"));
    EXPECT_THAT(message_of<FileError>([&] { ImageRowReader reader(file); }),
                HasSubstr("announces 2147483647 x 1 texels"));
}

}  // namespace
}  // namespace relief
