// SPDX-License-Identifier: Apache-2.0
// Walks the chunks of a PNG file up to its pixels [ISO/IEC 15948], reading nothing but their heads
// and a gamma. A file that is cut short has no tag beyond that point.
// Tests: tests/mesh/io/image/image_tags_test.cpp.
#include "relief/mesh/image_tags.h"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <fstream>
#include <string_view>

#include "relief/mesh/error.h"

namespace relief {
namespace {

constexpr std::string_view png_signature = "\x89PNG\r\n\x1a\n";

std::uint32_t big32(const char* bytes) {
    std::uint32_t value = 0;
    for (int i = 0; i < 4; ++i)
        value = value << 8 | static_cast<unsigned char>(bytes[i]);
    return value;
}

/// What a chunk says; empty for most.
std::string tag_of(std::string_view type, std::istream& file) {
    if (type == "sRGB") return "sRGB";
    if (type == "iCCP") return "ICC profile";
    if (type == "cICP") return "coding-independent code points";
    if (type != "gAMA") return "";
    std::array<char, 4> stored{};
    if (!file.read(stored.data(), stored.size())) return "";
    const std::uint32_t gamma = big32(stored.data());
    return gamma == 100000 ? "" : fmt::format("gamma {:g}", gamma / 100000.0);
}

}  // namespace

std::string color_tag(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw FileError(file, "cannot be opened");
    std::array<char, 8> head{};
    if (!stream.read(head.data(), head.size()) ||
        std::string_view(head.data(), head.size()) != png_signature)
        return "";
    std::streamoff next = 8;
    while (stream.seekg(next) && stream.read(head.data(), head.size())) {
        const std::string_view type(head.data() + 4, 4);
        if (type == "IDAT" || type == "IEND") return "";
        const std::string tag = tag_of(type, stream);
        if (!tag.empty()) return tag;
        next += 12 + static_cast<std::streamoff>(big32(head.data()));
    }
    return "";
}

}  // namespace relief
