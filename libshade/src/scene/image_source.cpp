// SPDX-License-Identifier: Apache-2.0
// The one place where a scene's images are decoded. Bad files throw as read_image does.
// Tests: tests/shade/scene/image_source_test.cpp.
#include "relief/shade/image_source.h"

#include <span>

#include "progress_stage.h"
#include "relief/mesh/error.h"

namespace relief {

namespace {

struct Decoder {
    const std::string& name;
    ImageUse use;

    Image operator()(const std::filesystem::path& file) const { return read_image(file, use); }
    Image operator()(const std::vector<std::byte>& bytes) const {
        return read_image(std::span(bytes), name, use);
    }
    Image operator()(const Image& image) const {
        Image copy = image;
        if (use == ImageUse::data) copy.color_space = ColorSpace::data;
        return copy;
    }
};

}  // namespace

Image decode(const ImageSource& source, ImageUse use) {
    if (!source.fault.empty()) throw FileError(source.origin, source.fault);
    return std::visit(Decoder{source.name, use}, source.source);
}

std::string with_origin(const ImageSource& source, const std::string& error) {
    const bool has_origin = source.origin.empty() || error.starts_with(source.origin);
    return has_origin ? error : source.origin + ": " + error;
}

void note_image_file(const ImageSource& source) {
    if (const auto* file = std::get_if<std::filesystem::path>(&source.source)) note_file(*file);
}

FlatCode detected_flat_code(const ImageSource& source, const Image& image) {
    if (const auto* file = std::get_if<std::filesystem::path>(&source.source))
        return detect_flat_code(image, read_image_info(*file).metadata);
    if (const auto* bytes = std::get_if<Shared<std::vector<std::byte>>>(&source.source))
        return detect_flat_code(image, read_image_info(std::span(**bytes), source.name).metadata);
    return detect_flat_code(image);
}

}  // namespace relief
