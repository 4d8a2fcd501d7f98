// SPDX-License-Identifier: Apache-2.0
// Writing .gltf with its buffer beside it, and .glb with all in one.
//
// Images keep their bytes. In .glb all that can be read are put inside; in .gltf those in files
// stay files, copied along to another folder; a file of other content that is in their way is a
// FileError, since another document may need it. Source: glTF 2.0 (ISO/IEC 12113), chapter 4.
// Tests: tests/mesh/io/gltf/gltf_document_test.cpp.
#include "io/gltf/gltf_writer.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <limits>
#include <list>

#include "file_bytes.h"
#include "file_replacement.h"
#include "io/gltf/gltf_layout.h"
#include "io/gltf/gltf_uri.h"
#include "relief/mesh/error.h"

namespace relief {
namespace {

/// Writes pieces one after the other, beside and renamed.
void write_pieces(const std::filesystem::path& file, const std::vector<std::string_view>& pieces) {
    FileReplacement replacement(file);
    std::ofstream stream(replacement.temporary(), std::ios::binary);
    for (const std::string_view piece : pieces) {
        stream.write(piece.data(), static_cast<std::streamsize>(piece.size()));
    }
    stream.close();
    if (!stream) throw FileError(file, fmt::format("cannot be written: {}", std::strerror(errno)));
    replacement.commit();
}

std::string text_of(const Json& root, int indent, const std::filesystem::path& file) {
    try {
        return root.dump(indent, ' ');
    } catch (const Json::exception& error) {
        throw FileError(file, fmt::format("its JSON cannot be written: {}", error.what()));
    }
}

void append_word(std::string& bytes, std::uint32_t word) {
    bytes.append(reinterpret_cast<const char*>(&word), sizeof(word));
}

/// The path of an image that lies in a file; nothing for those inside, missing or out of reach.
std::optional<std::filesystem::path> image_file(const Json& image,
                                                const std::filesystem::path& folder) {
    const std::string uri = text_in(image, "uri");
    if (uri.empty() || is_data_uri(uri)) return std::nullopt;
    const auto path = path_inside(folder, uri);
    std::error_code ignored;
    if (!path || !std::filesystem::is_regular_file(*path, ignored)) return std::nullopt;
    return path;
}

/// A name that leads out of the document's folder would lead elsewhere from another one.
void check_stays(const Json& image, std::size_t number, const GltfContents& contents,
                 const std::filesystem::path& file) {
    const std::string uri = text_in(image, "uri");
    if (uri.empty() || has_scheme(uri) || path_inside(contents.folder, uri)) return;
    if (std::filesystem::absolute(file).parent_path() == contents.folder) return;
    throw FileError(file,
                    fmt::format("images[{}] '{}' lies outside the document's folder, so it is "
                                "neither read nor right from here; write to {}",
                                number, uri, contents.folder.string()));
}

/// Puts images that lie in files or data URIs behind the buffer. `storage` owns what they take.
void embed_images(GltfLayout& layout, const GltfContents& contents,
                  const std::filesystem::path& file, std::list<std::string>& storage) {
    static const std::string zeros(4, '\0');
    if (!layout.root.contains("images")) return;
    Json& images = layout.root["images"];
    for (std::size_t i = 0; i < images.size(); ++i) {
        Json& image = images[i];
        check_stays(image, i, contents, file);
        const std::string uri = text_in(image, "uri");
        std::string media_type = text_in(image, "mimeType");
        if (is_data_uri(uri)) {
            DataUri data = decode_data_uri(uri);
            if (media_type.empty()) media_type = data.media_type;
            storage.push_back(std::move(data.bytes));
        } else if (const auto path = image_file(image, contents.folder)) {
            storage.push_back(read_file(*path));
        } else {
            continue;
        }
        const std::string& bytes = storage.back();
        const std::string actual = image_media_type(bytes);
        if (!actual.empty()) media_type = actual;
        if (media_type.empty()) {
            throw FileError(file, fmt::format("images[{}] is of no kind that glTF knows; PNG and "
                                              "JPEG are",
                                              i));
        }
        const std::size_t padding = (4 - layout.size % 4) % 4;
        layout.pieces.push_back(std::string_view(zeros).substr(0, padding));
        layout.pieces.push_back(bytes);
        Json& views = layout.root["bufferViews"];
        views.push_back(
            {{"buffer", 0}, {"byteOffset", layout.size + padding}, {"byteLength", bytes.size()}});
        layout.size += padding + bytes.size();
        image.erase("uri");
        image["bufferView"] = views.size() - 1;
        image["mimeType"] = media_type;
    }
    if (layout.size == 0) return;
    Json& buffers = layout.root["buffers"];
    if (buffers.empty()) buffers.push_back(Json::object());
    buffers[0]["byteLength"] = layout.size;
}

void write_glb(const std::filesystem::path& file, const GltfContents& contents) {
    GltfLayout layout = layout_of(contents);
    std::list<std::string> storage;
    embed_images(layout, contents, file, storage);
    std::string json = text_of(layout.root, -1, file);
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const std::size_t padding = (4 - layout.size % 4) % 4;
    std::size_t total = 12 + 8 + json.size();
    if (layout.size > 0) total += 8 + layout.size + padding;
    for (const auto& [type, chunk] : contents.extra_chunks)
        total += 8 + chunk.size();
    if (total > std::numeric_limits<std::uint32_t>::max()) {
        throw FileError(
            file, fmt::format("would take {} bytes, but GLB ends at 4 GiB; write .gltf", total));
    }
    std::string head = "glTF";
    append_word(head, 2);
    append_word(head, static_cast<std::uint32_t>(total));
    append_word(head, static_cast<std::uint32_t>(json.size()));
    head += "JSON" + json;
    std::string tail(layout.size > 0 ? padding : 0, '\0');
    if (layout.size > 0) {
        append_word(head, static_cast<std::uint32_t>(layout.size + padding));
        head += std::string("BIN\0", 4);
    }
    for (const auto& [type, chunk] : contents.extra_chunks) {
        append_word(tail, static_cast<std::uint32_t>(chunk.size()));
        append_word(tail, type);
        tail += chunk;
    }
    std::vector<std::string_view> pieces = {head};
    pieces.insert(pieces.end(), layout.pieces.begin(), layout.pieces.end());
    pieces.push_back(tail);
    write_pieces(file, pieces);
}

/// Copies the images that lie in files to the same place below another folder.
void copy_images(const GltfContents& contents, const std::filesystem::path& file) {
    const std::filesystem::path folder = std::filesystem::absolute(file).parent_path();
    const Json& images = array_in(contents.root, "images");
    for (std::size_t i = 0; i < images.size(); ++i) {
        check_stays(images[i], i, contents, file);
        const auto source = image_file(images[i], contents.folder);
        if (!source || folder == contents.folder) continue;
        const std::string bytes = read_file(*source);
        const std::filesystem::path target = folder / source->lexically_relative(contents.folder);
        if (std::filesystem::exists(target)) {
            if (read_file(target) == bytes) continue;
            throw FileError(target, fmt::format("is in the way of images[{}] of {}, which is "
                                                "another image; write .glb, which holds its own",
                                                i, file.string()));
        }
        std::filesystem::create_directories(target.parent_path());
        write_pieces(target, {bytes});
    }
}

void write_json(const std::filesystem::path& file, const GltfContents& contents) {
    GltfLayout layout = layout_of(contents);
    copy_images(contents, file);
    if (layout.size > 0) {
        std::filesystem::path buffer_file = file;
        buffer_file.replace_extension(".bin");
        layout.root["buffers"][0]["uri"] = uri_of(buffer_file.filename().string());
        write_pieces(buffer_file, layout.pieces);
    }
    const std::string json = text_of(layout.root, 2, file) + "\n";
    write_pieces(file, {json});
}

}  // namespace

std::string image_media_type(std::string_view bytes) {
    const auto at = [&](std::size_t offset, std::string_view text) {
        return bytes.size() >= offset + text.size() && bytes.substr(offset, text.size()) == text;
    };
    if (at(0, "\x89PNG\r\n\x1A\n")) return "image/png";
    if (at(0, "\xFF\xD8\xFF")) return "image/jpeg";
    if (at(0, "RIFF") && at(8, "WEBP")) return "image/webp";
    if (at(4, "ftypavif")) return "image/avif";
    if (at(0, "\xABKTX 20\xBB")) return "image/ktx2";
    if (at(0, "DDS ")) return "image/vnd-ms.dds";
    return {};
}

void write_gltf(const std::filesystem::path& file, const GltfContents& contents) {
    const std::string extension = lower_extension(file);
    if (extension == ".glb") {
        write_glb(file, contents);
    } else if (extension == ".gltf") {
        write_json(file, contents);
    } else {
        throw FileError(file, fmt::format("'{}' is no glTF; .gltf and .glb are", extension));
    }
}

}  // namespace relief
