// SPDX-License-Identifier: Apache-2.0
// The images of a scene: decoding, which happens here only; the test whether an image is unchanged;
// and the six faces of a cube map in a folder.
#include "relief/shade/scene_file.h"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "progress_stage.h"
#include "relief/mesh/report.h"
#include "scene/image_identity.h"

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

/// A file whose stamp cannot be read counts as missing; reading it reports the reason.
ImageIdentity::File::File(std::filesystem::path name)
    : path(std::move(name)), stamp(stamp_of(path)) {}

decltype(ImageIdentity::identity_) ImageIdentity::identity_of(const ImageSource& source) {
    if (const auto* file = std::get_if<std::filesystem::path>(&source.source)) return File(*file);
    if (const auto* bytes = std::get_if<Shared<std::vector<std::byte>>>(&source.source))
        return bytes->identity();
    return std::get<Shared<Image>>(source.source).identity();
}

ImageIdentity::ImageIdentity(const ImageSource& source) : identity_(identity_of(source)) {}

bool ImageIdentity::is(const ImageSource& source) const {
    if (const auto* file = std::get_if<std::filesystem::path>(&source.source)) {
        const auto* known = std::get_if<File>(&identity_);
        return known != nullptr && *known == File(*file);
    }
    if (const auto* bytes = std::get_if<Shared<std::vector<std::byte>>>(&source.source)) {
        const auto* known = std::get_if<Shared<std::vector<std::byte>>::Identity>(&identity_);
        return known != nullptr && known->is(*bytes);
    }
    const auto* known = std::get_if<Shared<Image>::Identity>(&identity_);
    return known != nullptr && known->is(std::get<Shared<Image>>(source.source));
}

// Files are visited in order of name, so that messages do not depend on the file system.
CubeFaces cube_faces_in(const std::filesystem::path& folder) {
    constexpr std::array<const char*, 6> ends = {"posx", "negx", "posy", "negy", "posz", "negz"};
    std::set<std::filesystem::path> files;
    std::error_code problem;
    for (const auto& entry : std::filesystem::directory_iterator(folder, problem))
        files.insert(entry.path());
    if (problem) throw FileError(folder, "cannot be read as a folder: " + problem.message());
    CubeFaces faces;
    for (std::size_t i = 0; i < ends.size(); ++i) {
        std::optional<std::filesystem::path> found;
        for (const std::filesystem::path& file : files) {
            if (!file.stem().string().ends_with(ends[i])) continue;
            if (found) {
                throw FileError(folder, fmt::format("both {} and {} end in {} (name the six files "
                                                    "instead)",
                                                    found->filename().string(),
                                                    file.filename().string(), ends[i]));
            }
            found = file;
        }
        if (!found) {
            throw FileError(folder, fmt::format("no file whose name ends in {} (name the six files "
                                                "in the order +x -x +y -y +z -z)",
                                                ends[i]));
        }
        faces.faces[i] = {found->string(), *found};
    }
    return faces;
}

}  // namespace relief
