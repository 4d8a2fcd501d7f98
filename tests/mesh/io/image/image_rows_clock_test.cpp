// SPDX-License-Identifier: Apache-2.0
// Files do not depend on how long they take to write.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "module_reference.h"
#include "relief/mesh/image_rows.h"
#include "support/shared_data.h"

namespace relief {
namespace {

using test::contents_of;
using test::TemporaryDirectory;

struct SlowKind {
    const char* name;
    int bits;
};
constexpr SlowKind slow_kinds[] = {{"16.tif", 16}, {"32.tif", 32}, {"32.exr", 32}};

/// Above the five seconds after which OpenImageIO looks at the clock.
constexpr std::chrono::milliseconds pause(5300);
/// Rows reach the encoder in bands of 8 MB: there is at least one before the pause, one after.
constexpr int map_width = 16384, map_height = 512;

/// Half of the rows of a map that is not the same everywhere.
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
        files.push_back(contents_of(folder / slow_kinds[i].name));
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
