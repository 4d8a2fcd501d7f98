// SPDX-License-Identifier: Apache-2.0
// Reads .gltf and .glb files: container, JSON, checks, buffers, decompression, in this order; and
// summarizes a document: texture coordinate sets and the one of the tangents, compression, and
// contents that other formats cannot hold; and URIs, whose paths are checked as text, before any
// file is accessed.
//
// The content decides, not the name: a file that begins with "glTF" is a GLB. Every length is
// checked before it is used; a wrong one is a FileError. Source: glTF 2.0 (ISO/IEC 12113), chapters
// 3 and 4.
#include "relief/mesh/gltf_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <new>
#include <string_view>

#include "file_replacement.h"
#include "files.h"
#include "io/gltf/gltf_accessor.h"
#include "io/gltf/gltf_compression.h"
#include "io/gltf/gltf_contents.h"
#include "json_cursor.h"
#include "progress_stage.h"
#include "relief/mesh/limits.h"
#include "relief/mesh/report.h"

namespace relief {
using namespace relief::detail;

namespace {

constexpr std::uint32_t json_chunk = 0x4E4F534A;
constexpr std::uint32_t binary_chunk = 0x004E4942;
constexpr std::size_t deepest_json = 256;

/// The parts of a file. A .gltf has only the JSON.
struct Container {
    std::string bytes;  ///< The whole file.
    std::size_t json_begin = 0;
    std::size_t json_size = 0;
    std::size_t binary_begin = 0;
    std::size_t binary_size = 0;
    bool has_binary = false;
    std::vector<std::pair<std::uint32_t, std::string>> extra_chunks;
};

std::uint32_t word_at(std::string_view bytes, std::size_t offset) {
    std::uint32_t word = 0;
    std::memcpy(&word, bytes.data() + offset, sizeof(word));
    return word;
}

/// Parses the chunks of a GLB.
void parse_chunks(Container& container, std::size_t end, const std::filesystem::path& file) {
    std::size_t at = 12;
    for (std::size_t number = 0; at < end; ++number) {
        if (end - at < 8) throw FileError(file, fmt::format("ends inside chunk {}", number));
        const std::uint32_t size = word_at(container.bytes, at);
        const std::uint32_t type = word_at(container.bytes, at + 4);
        at += 8;
        if (size > end - at) {
            throw FileError(file, fmt::format("chunk {} claims {} bytes, but only {} are left",
                                              number, size, end - at));
        }
        if ((number == 0) != (type == json_chunk)) {
            throw FileError(
                file, fmt::format("chunk {} is {}JSON", number, number == 0 ? "not " : "another "));
        }
        if (number == 0) {
            container.json_begin = at;
            container.json_size = size;
        } else if (type == binary_chunk) {
            if (number != 1) throw FileError(file, "the binary chunk is not the second");
            container.binary_begin = at;
            container.binary_size = size;
            container.has_binary = true;
        } else {
            container.extra_chunks.emplace_back(type, container.bytes.substr(at, size));
        }
        at += size;
    }
}

Container parse_container(std::string bytes, const std::filesystem::path& file, Report& report) {
    if (bytes.empty()) throw FileError(file, "is empty");
    Container container;
    container.bytes = std::move(bytes);
    if (!container.bytes.starts_with("glTF")) {
        container.json_size = container.bytes.size();
        return container;
    }
    const std::size_t size = container.bytes.size();
    if (size < 20) throw FileError(file, fmt::format("ends after {} bytes of its header", size));
    const std::uint32_t version = word_at(container.bytes, 4);
    if (version != 2) throw FileError(file, fmt::format("is GLB version {}, not 2", version));
    const std::uint32_t length = word_at(container.bytes, 8);
    if (length > size) {
        throw FileError(file, fmt::format("claims {} bytes, but has only {}", length, size));
    }
    if (length < size) report.add("bytes behind the GLB", "byte", length, "left out");
    parse_chunks(container, length, file);
    return container;
}

Json parse_json(std::string_view text, const std::filesystem::path& file) {
    // GLB pads its JSON with blanks, and some writers with zeros.
    while (text.ends_with('\0'))
        text.remove_suffix(1);
    require_json_depth(text, deepest_json);
    try {
        return Json::parse(text);
    } catch (const Json::exception& error) {
        throw FileError(file, fmt::format("its JSON is malformed: {}", json_problem(error)));
    }
}

GltfBuffer read_buffer(const Json& buffer, std::size_t index, const GltfContents& contents,
                       Container& container, const std::filesystem::path& file) {
    const auto name = [&] { return fmt::format("buffers[{}]", index); };
    const std::size_t size = size_in(buffer, "byteLength");
    GltfBuffer result;
    const Json* uri = find(buffer, "uri");
    if (uri == nullptr) {
        const bool is_chunk = index == 0 && container.has_binary;
        if (!is_chunk) throw FileError(file, name() + " has no data");
        result.begin = container.binary_begin;
        result.size = container.binary_size;
        result.storage = std::move(container.bytes);
    } else if (is_data_uri(uri->get_ref<const std::string&>())) {
        try {
            result.storage = decode_data_uri(uri->get_ref<const std::string&>()).bytes;
        } catch (const InvalidInput& error) {
            throw FileError(file, fmt::format("{}.uri: {}", name(), error.what()));
        }
        result.size = result.storage.size();
    } else {
        const auto path = readable_path(contents.folder(), uri->get_ref<const std::string&>());
        if (!path) {
            throw FileError(file, fmt::format("{}.uri '{}' lies outside the document's folder",
                                              name(), uri->get<std::string>()));
        }
        try {
            result.storage = read_file(*path);
        } catch (const FileError& error) {
            throw FileError(file, fmt::format("{}: {}", name(), error.what()));
        }
        result.size = result.storage.size();
    }
    if (result.size < size) {
        throw FileError(
            file, fmt::format("{} claims {} bytes, but has only {}", name(), size, result.size));
    }
    result.size = size;
    return result;
}

/// Returns whether the bytes of a buffer are in another file than its document.
bool is_other_file(const Json& buffer) {
    const Json* uri = find(buffer, "uri");
    return uri != nullptr && !is_data_uri(uri->get_ref<const std::string&>());
}

/// Adds the keys of the textures below `json` that show an image: "baseColorTexture", and those of
/// material extensions.
/// \param shows  for each texture, whether it shows the image
void add_texture_keys(const Json& json, const std::vector<bool>& shows,
                      std::vector<std::string>& keys) {
    if (!json.is_object()) return;
    for (const auto& [key, value] : json.items()) {
        const bool is_texture = value.is_object() && key.ends_with("exture");
        const Json* const index = is_texture ? find(value, "index") : nullptr;
        if (index != nullptr && index->is_number_unsigned()) {
            const auto texture = index->get<std::size_t>();
            if (texture < shows.size() && shows[texture]) keys.push_back(key);
        }
        add_texture_keys(value, shows, keys);
    }
}

/// Returns the uses of an image: ", baseColorTexture of material 'wall'"; "" if there is none.
std::string image_uses(const Json& root, std::size_t image) {
    const auto names_image = [&](const Json& object) {
        const Json* const source = object.is_object() ? find(object, "source") : nullptr;
        return source != nullptr && *source == image;
    };
    const auto shows_image = [&](const Json& texture) {
        const Json* const extensions = find(texture, "extensions");
        return names_image(texture) ||
               (extensions != nullptr &&
                std::any_of(extensions->begin(), extensions->end(), names_image));
    };
    std::vector<bool> shows;
    for (const Json& texture : array_in(root, "textures"))
        shows.push_back(shows_image(texture));
    std::string uses;
    const Json& materials = array_in(root, "materials");
    for (std::size_t i = 0; i < materials.size(); ++i) {
        std::vector<std::string> keys;
        add_texture_keys(materials[i], shows, keys);
        const std::string name = text_in(materials[i], "name");
        if (keys.empty()) continue;
        uses += fmt::format(", {} of material {}", fmt::join(keys, ", "),
                            name.empty() ? fmt::format("{}", i) : "'" + name + "'");
    }
    return uses;
}

/// Reports images whose file is missing or outside the folder. Images are not decoded.
void check_images(const GltfContents& contents, Report& report) {
    const Json& images = array_in(contents.root, "images");
    for (std::size_t i = 0; i < images.size(); ++i) {
        if (!images[i].contains("uri")) continue;
        const std::string uri = text_in(images[i], "uri");
        if (is_data_uri(uri)) {
            try {
                decode_data_uri(uri);
            } catch (const InvalidInput& error) {
                throw InvalidInput(fmt::format("images[{}].uri: {}", i, error.what()));
            }
            continue;
        }
        const auto path = readable_path(contents.folder(), uri);
        std::error_code ignored;
        if (!path && !uri.empty()) {
            report.add("image outside the document's folder", "image", i, "kept by name, not read");
        } else if (!path || !std::filesystem::is_regular_file(staged_file(*path), ignored)) {
            report.add(fmt::format("missing image '{}'{}", uri, image_uses(contents.root, i)),
                       "image", i, "kept by name");
        }
    }
}

void count_position_uses(GltfContents& contents) {
    contents.position_uses.assign(array_in(contents.root, "accessors").size(), 0);
    for (const Json& mesh : array_in(contents.root, "meshes")) {
        for (const Json& primitive : mesh["primitives"]) {
            const auto position = index_in(primitive["attributes"], "POSITION");
            if (position) ++contents.position_uses[*position];
        }
    }
}

}  // namespace

GltfContents detail::read_gltf(const std::filesystem::path& file, Report& report) {
    try {
        Container container = parse_container(read_file(file), file, report);
        const ProgressStage stage("parsing");
        GltfContents contents;
        contents.root = parse_json(
            std::string_view(container.bytes).substr(container.json_begin, container.json_size),
            file);
        contents.file = std::filesystem::absolute(file);
        check_gltf(contents.root);
        contents.extra_chunks = std::move(container.extra_chunks);
        std::uint64_t file_bytes = container.bytes.size();
        const Json& buffers = array_in(contents.root, "buffers");
        const auto placeholders = meshopt_placeholders(contents.root, container.has_binary);
        for (std::size_t i = 0; i < buffers.size(); ++i) {
            if (placeholders[i]) {
                contents.buffers.emplace_back().is_placeholder = true;
            } else {
                contents.buffers.push_back(read_buffer(buffers[i], i, contents, container, file));
                if (is_other_file(buffers[i])) file_bytes += contents.buffers.back().size;
            }
        }
        contents.budget = MemoryBudget(file_bytes);
        unpack_meshopt(contents);
        unpack_draco(contents, report);
        take_contents(contents);
        check_values(contents, report);
        check_images(contents, report);
        count_position_uses(contents);
        return contents;
    } catch (const InvalidInput& error) {
        throw FileError(file, error.what());
    } catch (const std::bad_alloc&) {
        throw FileError(file, "needs more memory than is available");
    }
}

GltfDocument GltfDocument::read(const std::filesystem::path& file, Report& report) {
    return GltfDocument(std::make_unique<Contents>(Contents{read_gltf(file, report)}));
}

namespace {

/// A texture of a material that is sampled in tangent space.
struct TangentTexture {
    const char* name = "";
    const Json* info = nullptr;
};

/// Returns the first such texture of a material, in the order in which glTF derives tangents from
/// them.
TangentTexture tangent_texture(const Json& material) {
    const TangentTexture candidates[] = {
        {"normalTexture", find(material, "normalTexture")},
        {"clearcoatNormalTexture",
         find(material, "extensions", "KHR_materials_clearcoat", "clearcoatNormalTexture")},
        {"anisotropyTexture",
         find(material, "extensions", "KHR_materials_anisotropy", "anisotropyTexture")}};
    for (const TangentTexture& candidate : candidates) {
        if (candidate.info != nullptr && candidate.info->is_object()) return candidate;
    }
    return {};
}

/// Returns true if the transform rotates or mirrors texture coordinates. Positive scales, as used
/// for tiles and atlases, keep both directions.
bool rotates_or_mirrors(const Json& transform) {
    const auto rotation = static_cast<double>(float_in(transform, "rotation", 0.0F));
    const glm::vec2 scale = vector_in(transform, "scale", glm::vec2(1.0F));
    constexpr double rounding = 1e-6;  // Relative error of an angle in float.
    const bool is_rotated = std::abs(std::sin(rotation)) > rounding || !(std::cos(rotation) > 0.0);
    return is_rotated || scale.x < 0.0F || scale.y < 0.0F;
}

}  // namespace

std::vector<int> GltfDocument::texcoord_sets(GltfPrimitiveId id) const {
    const GltfContents& contents = contents_->data;
    constexpr std::string_view prefix = "TEXCOORD_";
    std::vector<int> sets;
    for (const auto& [name, accessor] : primitive_json(contents, id)["attributes"].items()) {
        if (!name.starts_with(prefix)) continue;
        int set = 0;
        const char* end = name.data() + name.size();
        const auto parsed = std::from_chars(name.data() + prefix.size(), end, set);
        if (parsed.ec == std::errc() && parsed.ptr == end && set >= 0) sets.push_back(set);
    }
    std::sort(sets.begin(), sets.end());
    return sets;
}

GltfTangentTexcoords GltfDocument::tangent_texcoords(GltfPrimitiveId id) const {
    const GltfContents& contents = contents_->data;
    GltfTangentTexcoords result;
    const std::vector<int> sets = texcoord_sets(id);
    const int first = sets.empty() ? 0 : sets.front();
    result.set = first;
    const auto material = index_in(primitive_json(contents, id), "material");
    if (!material) return result;
    const TangentTexture texture = tangent_texture(contents.root["materials"][*material]);
    if (texture.info == nullptr) return result;
    result.texture = texture.name;
    result.set = static_cast<int>(size_in(*texture.info, "texCoord"));
    if (const Json* transform = find(*texture.info, "extensions", "KHR_texture_transform")) {
        result.set =
            static_cast<int>(size_in(*transform, "texCoord", static_cast<std::size_t>(result.set)));
        result.is_rotated = rotates_or_mirrors(*transform);
    }
    if (!std::binary_search(sets.begin(), sets.end(), result.set)) {
        result.missing = result.set;
        result.set = first;
    }
    return result;
}

namespace {

void add_count(std::vector<std::string>& lines, std::size_t count, const char* thing) {
    if (count > 0) lines.push_back(fmt::format("{} {}{}", count, thing, count == 1 ? "" : "s"));
}

/// Totals over all primitives.
struct PrimitiveCounts {
    std::size_t morph_targets = 0;
    std::size_t points_and_lines = 0;
    std::size_t more_attributes = 0;  ///< Attributes that Mesh does not have.
};

PrimitiveCounts count_primitives(const Json& root) {
    PrimitiveCounts counts;
    for (const Json& mesh : array_in(root, "meshes")) {
        for (const Json& primitive : mesh["primitives"]) {
            counts.morph_targets += array_in(primitive, "targets").size();
            if (size_in(primitive, "mode", 4) < 4) ++counts.points_and_lines;
            for (const auto& [name, accessor] : primitive["attributes"].items()) {
                if (name != "POSITION" && name != "NORMAL" && name != "TANGENT" &&
                    name != "TEXCOORD_0" && name != "COLOR_0") {
                    ++counts.more_attributes;
                }
            }
        }
    }
    return counts;
}

/// Returns the number of buffer views with a compressed copy by an extension.
std::size_t packed_views(const Json& root, const char* extension) {
    const Json& views = array_in(root, "bufferViews");
    return static_cast<std::size_t>(std::count_if(
        views.begin(), views.end(),
        [&](const Json& view) { return find(view, "extensions", extension) != nullptr; }));
}

/// Returns the number of primitives with a compressed copy.
std::size_t packed_primitives(const Json& root) {
    std::size_t count = 0;
    for (const Json& mesh : array_in(root, "meshes")) {
        for (const Json& primitive : mesh["primitives"])
            count += find(primitive, "extensions", draco_extension) != nullptr ? 1 : 0;
    }
    return count;
}

}  // namespace

GltfDocument::GltfDocument(std::unique_ptr<Contents> contents) : contents_(std::move(contents)) {}
GltfDocument::GltfDocument(GltfDocument&&) noexcept = default;
GltfDocument& GltfDocument::operator=(GltfDocument&&) noexcept = default;
GltfDocument::~GltfDocument() = default;

std::vector<GltfCompression> GltfDocument::compression() const {
    const GltfContents& contents = contents_->data;
    std::vector<GltfCompression> result;
    const auto add = [&](const char* extension, const char* element, std::size_t copies) {
        const auto decoded = contents.unpacked.find(extension);
        const std::size_t count = decoded == contents.unpacked.end() ? 0 : decoded->second;
        if (count + copies > 0) result.push_back({extension, element, count, copies});
    };
    add(draco_extension, "primitive", packed_primitives(contents.root));
    for (const char* extension : meshopt_extensions)
        add(extension, "buffer view", packed_views(contents.root, extension));
    return result;
}

std::vector<std::string> GltfDocument::unsupported_contents() const {
    const Json& root = contents_->data.root;
    const PrimitiveCounts counts = count_primitives(root);
    std::vector<std::string> lines;
    add_count(lines, array_in(root, "animations").size(), "animation");
    add_count(lines, array_in(root, "skins").size(), "skin");
    add_count(lines, counts.morph_targets, "morph target");
    add_count(lines, array_in(root, "cameras").size(), "camera");
    if (const Json* lights = find(root, "extensions", "KHR_lights_punctual")) {
        add_count(lines, array_in(*lights, "lights").size(), "light");
    }
    add_count(lines, counts.more_attributes, "further vertex attribute");
    if (counts.points_and_lines > 0) {
        lines.push_back(fmt::format("{} primitive{} of points or lines", counts.points_and_lines,
                                    counts.points_and_lines == 1 ? "" : "s"));
    }
    return lines;
}

namespace {

bool is_letter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

int hexadecimal(char c) {
    if (is_digit(c)) return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

/// Decodes percent-encoded bytes; other percent signs stay.
std::string percent_decoded(std::string_view text) {
    std::string result;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const int high = i + 2 < text.size() ? hexadecimal(text[i + 1]) : -1;
        const int low = i + 2 < text.size() ? hexadecimal(text[i + 2]) : -1;
        if (text[i] == '%' && high >= 0 && low >= 0) {
            result += static_cast<char>(high * 16 + low);
            i += 2;
        } else {
            result += text[i];
        }
    }
    return result;
}

constexpr std::string_view base64_alphabet =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

std::string base64_decoded(std::string_view text) {
    static const auto values = [] {
        std::array<std::int8_t, 256> result{};
        result.fill(-1);
        for (std::size_t i = 0; i < base64_alphabet.size(); ++i) {
            result[static_cast<unsigned char>(base64_alphabet[i])] = static_cast<std::int8_t>(i);
        }
        return result;
    }();
    while (text.ends_with('='))
        text.remove_suffix(1);
    if (text.size() % 4 == 1) throw InvalidInput("base64 data ends in the middle of a byte");
    std::string result;
    result.reserve(text.size() * 3 / 4);
    std::uint32_t bits = 0;
    int bit_count = 0;
    for (const char c : text) {
        const std::int8_t value = values[static_cast<unsigned char>(c)];
        if (value < 0) throw InvalidInput(fmt::format("byte {} is not base64", int{c}));
        bits = bits << 6U | static_cast<std::uint32_t>(value);
        bit_count += 6;
        if (bit_count < 8) continue;
        bit_count -= 8;
        result += static_cast<char>(bits >> static_cast<unsigned>(bit_count) & 0xFFU);
    }
    return result;
}

}  // namespace

bool detail::is_data_uri(std::string_view uri) {
    return uri.starts_with("data:");
}

DataUri detail::decode_data_uri(std::string_view uri) {
    const std::size_t comma = uri.find(',');
    if (!is_data_uri(uri) || comma == uri.npos) throw InvalidInput("is not a data URI");
    std::string_view head = uri.substr(5, comma - 5);
    const std::string_view body = uri.substr(comma + 1);
    const bool is_base64 = head.ends_with(";base64");
    head = head.substr(0, head.find(';'));
    return {std::string(head), is_base64 ? base64_decoded(body) : percent_decoded(body)};
}

bool detail::has_scheme(std::string_view uri) {
    if (uri.empty() || !is_letter(uri.front())) return false;
    std::size_t i = 0;
    while (i < uri.size() && (is_letter(uri[i]) || is_digit(uri[i]) || uri[i] == '+' ||
                              uri[i] == '-' || uri[i] == '.')) {
        ++i;
    }
    return i < uri.size() && uri[i] == ':';
}

std::optional<std::filesystem::path> detail::path_inside(const std::filesystem::path& folder,
                                                         std::string_view uri) {
    const std::string name = percent_decoded(uri);
    if (name.empty() || has_scheme(uri) || name.find('\0') != name.npos) return std::nullopt;
    const std::filesystem::path relative = std::filesystem::path(name).lexically_normal();
    if (relative.is_absolute() || *relative.begin() == "..") return std::nullopt;
    const std::filesystem::path path = folder / relative;
    // Some writers do not encode percent signs.
    std::error_code ignored;
    const std::filesystem::path as_written = folder / std::filesystem::path(uri);
    if (!std::filesystem::exists(path, ignored) && name != uri && uri.find("..") == uri.npos &&
        uri.front() != '/' && std::filesystem::exists(as_written, ignored)) {
        return as_written;
    }
    return path;
}

std::optional<std::filesystem::path> detail::readable_path(const std::filesystem::path& folder,
                                                           std::string_view uri) {
    if (auto path = path_inside(folder, uri)) return path;
    const std::string name = percent_decoded(uri);
    if (!input_limits().outside_files || name.empty() || has_scheme(uri) ||
        name.find('\0') != name.npos) {
        return std::nullopt;
    }
    return (folder / name).lexically_normal();
}

std::string detail::uri_of(const std::string& file_name) {
    std::string result;
    for (const char c : file_name) {
        if (is_letter(c) || is_digit(c) || c == '-' || c == '.' || c == '_' || c == '~') {
            result += c;
        } else {
            result += fmt::format("%{:02X}", static_cast<unsigned char>(c));
        }
    }
    return result;
}

std::string detail::image_media_type(std::string_view bytes) {
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

}  // namespace relief
