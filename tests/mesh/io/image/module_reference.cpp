// SPDX-License-Identifier: Apache-2.0
#include "mesh/io/image/module_reference.h"

#include <gtest/gtest.h>

#include <fstream>

#include "io/image/image_file_container.h"
#include "io/image/image_module_client.h"
#include "io/png/png_format.h"
#include "relief/mesh/report.h"
#include "support/shared_data.h"

namespace relief::test {
using namespace relief::detail;

namespace {

ImageContainer examined(const std::string& file) {
    return examine_image(std::as_bytes(std::span(file)), "image");
}

}  // namespace

std::string zlib_stream(const std::string& bytes) {
    const std::span all(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    std::vector<std::uint8_t> packed;
    deflate_piece(all, 0, WriteEffort::normal, Repetitions::sought, true, packed);
    std::string stream(zlib_header);
    stream.append(packed.begin(), packed.end());
    append_big32(stream, adler32(std::as_bytes(all)));
    return stream;
}

std::optional<Image> directly(const std::string& file) {
    return read_directly(examined(file), file);
}

std::optional<Image> by_module(const std::string& file) {
    const ImageContainer container = examined(file);
    const ImageModule& module = image_module("image");
    const ImageModuleFailure silent{nullptr, [](void*, const char*) {}};
    const ImageModuleText none{nullptr, [](void*, const char*, const char*) {}};
    ImageModuleHeader header;
    ImageModuleReader* reader = module.open(container.format, container.stripped.data(),
                                            container.stripped.size(), &header, none, silent);
    if (reader == nullptr) return std::nullopt;
    Image image = make_image(static_cast<int>(header.width), static_cast<int>(header.height),
                             static_cast<int>(header.channels), header.bits, ColorSpace::data);
    void* const samples = std::visit([](auto& all) -> void* { return all.data(); }, image.samples);
    const bool read = module.read(reader, 0, header.height, samples, silent);
    module.close(reader);
    if (!read) return std::nullopt;
    return image;
}

void expect_same(const std::optional<Image>& found, const std::optional<Image>& expected,
                 const std::string& what) {
    ASSERT_TRUE(found && expected) << what;
    EXPECT_EQ(found->width, expected->width) << what;
    EXPECT_EQ(found->height, expected->height) << what;
    EXPECT_EQ(found->channels, expected->channels) << what;
    EXPECT_TRUE(found->samples == expected->samples) << what;
}

Comparison compare_all(const std::filesystem::path& folder, const std::string& extension) {
    Comparison comparison;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        if (entry.path().extension() != extension) continue;
        const std::string file = read_bytes(entry.path());
        std::optional<Image> found;
        try {
            found = directly(file);
        } catch (const FileError&) {
            continue;
        }
        found ? ++comparison.direct : ++comparison.left;
        if (found) expect_same(found, by_module(file), entry.path().string());
    }
    return comparison;
}

}  // namespace relief::test
