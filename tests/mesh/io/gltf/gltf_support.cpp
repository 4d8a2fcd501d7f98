// SPDX-License-Identifier: Apache-2.0
#include "mesh/io/gltf/gltf_support.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>

#include "files.h"
#include "io/gltf/gltf_accessor.h"
#include "io/gltf/gltf_contents.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/report.h"

namespace relief::test {
using namespace relief::detail;

namespace {

Json view_meaning(const GltfContents& contents, std::size_t number) {
    const Json& view = contents.root["bufferViews"][number];
    return {{"bytes", std::string(contents.buffers[size_in(view, "buffer")].bytes().substr(
                          size_in(view, "byteOffset"), size_in(view, "byteLength")))}};
}

Json accessor_meaning(const GltfContents& contents, std::size_t number) {
    Json accessor = contents.root["accessors"][number];
    accessor["elements"] = raw_elements(contents, number);
    for (const char* key : {"bufferView", "byteOffset", "sparse"})
        accessor.erase(key);
    return accessor;
}

void resolve_images(const GltfContents& contents, Json& root) {
    if (!root.contains("images")) return;
    for (std::size_t i = 0; i < root["images"].size(); ++i) {
        Json& image = root["images"][i];
        const std::string uri = text_in(contents.root["images"][i], "uri");
        if (is_data_uri(uri)) {
            image["bytes"] = decode_data_uri(uri).bytes;
        } else if (const auto path = path_inside(contents.folder(), uri);
                   path && std::filesystem::exists(*path)) {
            image["bytes"] = read_file(*path);
        } else if (uri.empty()) {
            image["bytes"] = image["bufferView"]["bytes"];
        } else {
            continue;  // The image is missing, so only its name remains.
        }
        for (const char* key : {"uri", "bufferView", "mimeType"})
            image.erase(key);
    }
}

}  // namespace

Json meaning_of(const std::filesystem::path& file) {
    Report report;
    const GltfContents contents = read_gltf(file, report);
    Json root = contents.root;
    Json accessors = Json::array();
    for (std::size_t i = 0; i < array_in(root, "accessors").size(); ++i) {
        accessors.push_back(accessor_meaning(contents, i));
    }
    visit_references(root, [&](std::string_view target, Json& index) {
        const auto number = index.get<std::size_t>();
        if (target == "accessors") index = accessors[number];
        if (target == "bufferViews") index = view_meaning(contents, number);
    });
    root.erase("accessors");
    if (!accessors.empty()) root["accessors"] = accessors;
    resolve_images(contents, root);
    root.erase("bufferViews");
    root.erase("buffers");
    return root;
}

Json meaning_beside_meshes(const std::filesystem::path& file) {
    Json root = meaning_of(file);
    root.erase("accessors");
    if (!root.contains("meshes")) return root;
    for (Json& mesh : root["meshes"]) {
        for (Json& primitive : mesh["primitives"]) {
            for (const char* key : {"attributes", "indices", "mode", "targets"}) {
                primitive.erase(key);
            }
        }
    }
    return root;
}

std::size_t unreferenced_bytes(const std::filesystem::path& file) {
    Report report;
    const GltfContents contents = read_gltf(file, report);
    std::vector<std::vector<bool>> is_used;
    for (const GltfBuffer& buffer : contents.buffers)
        is_used.emplace_back(buffer.size, false);
    std::vector<bool> has_accessors(array_in(contents.root, "bufferViews").size(), false);
    const auto use = [&](const Json& view, std::size_t offset, std::size_t length) {
        auto begin = is_used[size_in(view, "buffer")].begin() +
                     static_cast<std::ptrdiff_t>(size_in(view, "byteOffset") + offset);
        std::fill(begin, begin + static_cast<std::ptrdiff_t>(length), true);
    };
    for (const Json& accessor : array_in(contents.root, "accessors")) {
        if (!accessor.contains("bufferView") || accessor["count"] == 0) continue;
        const std::size_t number = accessor["bufferView"];
        const Json& view = contents.root["bufferViews"][number];
        const std::size_t size = element_layout(accessor).size;
        const std::size_t stride = size_in(view, "byteStride", size);
        for (std::size_t i = 0; i < accessor["count"].get<std::size_t>(); ++i) {
            use(view, size_in(accessor, "byteOffset") + i * stride, size);
        }
        has_accessors[number] = true;
    }
    for (std::size_t i = 0; i < has_accessors.size(); ++i) {
        const Json& view = contents.root["bufferViews"][i];
        if (!has_accessors[i]) use(view, 0, size_in(view, "byteLength"));
    }
    std::size_t unused = 0;
    for (const auto& buffer : is_used) {
        unused += static_cast<std::size_t>(std::count(buffer.begin(), buffer.end(), false));
    }
    return unused;
}

std::vector<std::filesystem::path> gltf_files_below(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        const std::string extension = lower_extension(entry.path());
        if (entry.is_regular_file() && (extension == ".gltf" || extension == ".glb")) {
            files.push_back(entry.path());
        }
    }
    std::sort(files.begin(), files.end());
    return files;
}

void write_gltf_file(const std::filesystem::path& file, const Json& json,
                     const std::string& buffer) {
    std::ofstream stream(file, std::ios::binary);
    if (file.extension() == ".gltf") {
        stream << json.dump();
        return;
    }
    const auto word = [](std::size_t value) {
        const auto narrow = static_cast<std::uint32_t>(value);
        return std::string(reinterpret_cast<const char*>(&narrow), 4);
    };
    std::string text = json.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string padded = buffer;
    padded.resize((buffer.size() + 3) / 4 * 4, '\0');
    const std::string chunk =
        padded.empty() ? "" : word(padded.size()) + std::string("BIN\0", 4) + padded;
    stream << "glTF" << word(2) << word(20 + text.size() + chunk.size()) << word(text.size())
           << "JSON" << text << chunk;
}

void write_damaged_copy(const std::filesystem::path& file, const std::filesystem::path& copy,
                        std::mt19937& random) {
    std::string bytes = read_file(file);
    std::uint32_t json_size = 0;
    std::memcpy(&json_size, bytes.data() + 12, sizeof(json_size));
    const std::size_t first = 28 + std::size_t{json_size};
    for (unsigned k = 0; k <= random() % 4; ++k)
        bytes[first + random() % (bytes.size() - first)] = static_cast<char>(random());
    std::filesystem::remove(copy);  // ext4 waits for the disk when a file is truncated.
    std::ofstream(copy, std::ios::binary) << bytes;
}

bool is_refused(const std::filesystem::path& file) {
    try {
        Report report;
        const GltfDocument document = GltfDocument::read(file, report);
        for (const GltfPrimitiveId id : document.triangle_primitives()) {
            try {
                validate(document.mesh(id));
            } catch (const InvalidInput&) {
                continue;  // An invalid reference, for example an index out of range.
            }
        }
        std::filesystem::path written = file;
        document.write(written.replace_filename("written.glb"));
        return false;
    } catch (const FileError&) {
        return true;
    }
}

}  // namespace relief::test
