// SPDX-License-Identifier: Apache-2.0
/// \file
/// A glTF document in memory: its JSON, unchanged, and its buffers; its validation; additions to it
/// and removal of extensions; and its URIs. One table in gltf_check.cpp states the type of each
/// property and which properties are indices. It serves for checking a document and for renumbering
/// its references. Source of URIs: RFC 2397, RFC 3986, RFC 4648.
///
/// relief does not use tinygltf 2.7 here, because it loses data: large integers in extras change,
/// nulls, empty objects, unknown properties, minVersion and animation channels without a node
/// disappear, and an array that becomes empty is written as null. The tests use it as an
/// independent reader.
#pragma once

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "memory_budget.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/report.h"

namespace relief::detail {

/// Keys are sorted; their order has no meaning in JSON.
using Json = nlohmann::json;

/// \throws InvalidInput always, with the formatted text
template <typename... Values>
[[noreturn]] void fail_gltf(fmt::format_string<Values...> format, Values&&... values) {
    throw InvalidInput(fmt::format(format, std::forward<Values>(values)...));
}

/// A property, or null if it is absent.
inline const Json* find(const Json& object, const char* key) {
    const auto it = object.find(key);
    return it == object.end() ? nullptr : &*it;
}

/// Returns the value at a path of keys, or null.
template <typename... Keys>
const Json* find(const Json& object, const char* key, const char* next, Keys... rest) {
    const Json* inner = find(object, key);
    return inner == nullptr || !inner->is_object() ? nullptr : find(*inner, next, rest...);
}

/// Returns the value at a path as SceneField::gltf has it, or null:
/// "extensions/KHR_materials_ior/ior".
const Json* find_path(const Json& object, std::string_view path);

/// True if fields of MetallicRoughness are in this extension of materials.
bool has_factors(std::string_view extension);

/// Returns an array of the document; empty if it is absent.
inline const Json& array_in(const Json& object, const char* key) {
    static const Json empty = Json::array();
    const Json* array = find(object, key);
    return array == nullptr ? empty : *array;
}

inline std::optional<std::size_t> index_in(const Json& object, const char* key) {
    const Json* value = find(object, key);
    return value == nullptr ? std::nullopt : std::optional(value->get<std::size_t>());
}

inline std::size_t size_in(const Json& object, const char* key, std::size_t absent = 0) {
    return index_in(object, key).value_or(absent);
}

inline float float_in(const Json& object, const char* key, float absent) {
    const Json* value = find(object, key);
    return value == nullptr ? absent : value->get<float>();
}

inline bool bool_in(const Json& object, const char* key) {
    const Json* value = find(object, key);
    return value != nullptr && value->get<bool>();
}

inline std::string text_in(const Json& object, const char* key) {
    const Json* value = find(object, key);
    return value == nullptr ? std::string() : value->get<std::string>();
}

/// A glm vector, or `absent` if there is no such property.
template <typename Vector>
Vector vector_in(const Json& object, const char* key, Vector absent) {
    const Json* value = find(object, key);
    if (value == nullptr) return absent;
    Vector result;
    for (int i = 0; i < Vector::length(); ++i) {
        result[i] = value->at(static_cast<std::size_t>(i)).template get<float>();
    }
    return result;
}

/// Bytes of a buffer. They may be the tail of a file that was read as a whole.
struct GltfBuffer {
    std::string storage;
    std::string_view borrowed;  ///< In place of `storage`: bytes of another owner.
    std::size_t begin = 0;
    std::size_t size = 0;
    bool is_placeholder = false;  ///< It has no bytes: all its views are compressed.

    [[nodiscard]] std::string_view bytes() const {
        return (borrowed.empty() ? std::string_view(storage) : borrowed).substr(begin, size);
    }
};

/// The bytes [begin, end) of a buffer.
struct GltfExtent {
    std::size_t buffer = 0;
    std::size_t begin = 0;
    std::size_t end = 0;
};

struct GltfContents {
    Json root;                        ///< Has passed check_gltf().
    std::filesystem::path file;       ///< Absolute; empty if the document was not read.
    std::vector<GltfBuffer> buffers;  ///< One for each entry of "buffers".
    /// Chunks of a GLB other than JSON and the buffer. They are kept unchanged.
    std::vector<std::pair<std::uint32_t, std::string>> extra_chunks;

    /// Replaced accessors and buffer views. The writer leaves them out if nothing refers to them.
    std::set<std::size_t> retired_accessors;
    std::set<std::size_t> retired_views;
    std::set<std::size_t> retired_images;   ///< Likewise.
    std::vector<GltfExtent> retired_bytes;  ///< Compressed data that has been decoded.
    /// The entries of image files that were added, by canonical path.
    std::map<std::pair<std::filesystem::path, GltfImageStorage>, std::size_t> stored_images;
    /// The files of added external images, by URI. They need not be in the document's folder.
    std::map<std::string, std::filesystem::path> image_files;
    /// Number of decoded buffer views or primitives, by extension.
    std::map<std::string, std::size_t> unpacked;
    /// Index of the buffer for added data; -1 until data is added.
    std::size_t added_buffer = static_cast<std::size_t>(-1);
    /// Accessors that were added for primitives with shared accessors, by a hash of their elements.
    std::multimap<std::size_t, std::size_t> shared_accessors;
    /// The memory that the contents may take. Unlimited if the document was not read.
    MemoryBudget budget;
    /// Number of primitives that use an accessor as POSITION, counted after reading. The set of
    /// sharing primitives must not change while primitives are processed one by one.
    std::vector<std::uint32_t> position_uses;

    /// The base of relative URIs.
    [[nodiscard]] std::filesystem::path folder() const { return file.parent_path(); }
};

}  // namespace relief::detail

namespace relief {
struct GltfDocument::Contents {
    detail::GltfContents data;
};
}  // namespace relief

namespace relief::detail {

/// Reads and checks a file with its buffers, see GltfDocument::read(). Images are not opened; only
/// their existence is checked.
GltfContents read_gltf(const std::filesystem::path& file, Report& report);

/// Names of the extension that compresses a buffer view.
inline constexpr std::array meshopt_extensions = {"EXT_meshopt_compression",
                                                  "KHR_meshopt_compression"};

/// Name of the extension that compresses a primitive.
inline constexpr const char* draco_extension = "KHR_draco_mesh_compression";

// Validation, and the schema that it uses

/// Checks the type of each property in the table and the range of each index.
///
/// \throws InvalidInput with the location: "meshes[0].primitives[1].indices is 7, but there are
///         only 3 accessors"
void check_schema(const Json& root);

/// Calls `visit` for each index into an array of the document, "accessors" for example; it may
/// change the index. The document must have passed check_schema().
void visit_references(Json& root,
                      const std::function<void(std::string_view target, Json& index)>& visit);

/// Calls `visit` for each object of a type that the table names, and for each extension of one, in
/// the document's order: "node", "material+KHR_materials_ior". It may erase and change properties.
void visit_objects(Json& root,
                   const std::function<void(std::string_view type, Json& object)>& visit);

/// Returns true if any object carries the extension.
bool has_extension(const Json& root, std::string_view name);

/// Returns true if any object carries an extension that the table does not know. Such an extension
/// may hold indices that visit_references() does not see.
bool has_unknown_extension(const Json& root);

/// Checks a whole document. Afterwards every index, offset, length and count in it is valid.
///
/// \throws InvalidInput with the location, value and limit, or the name of a required extension
///         that relief does not support
void check_gltf(const Json& root);

/// Draws from the budget what the document takes as plain arrays and when it is drawn: accessors
/// without data, each material, primitive, instance, skin and animation channel, and the bytes of
/// embedded images. Accessors and buffer views that several of them share count for each.
///
/// \throws InvalidInput naming the first that exceeds the budget
void take_contents(GltfContents& contents);

/// Reports values that have no meaning: colors and weights that are not finite or out of range,
/// joints that a skin does not have, rotations without unit length, and integer positions and
/// directions without KHR_mesh_quantization. Replaces wrong bounds of positions.
void check_values(GltfContents& contents, Report& report);

// The rule of validity for all documents that are written

/// Repairs what the document inherits from its file: faults that relief reads over but that glTF
/// forbids. Each repair keeps the picture as relief and most renderers draw it.
///
/// \param report  counts each kind of repair
void repair_document(GltfContents& contents, Report& report);

/// The part of repair_document() for accessors: their layout in buffer views, their bounds, and the
/// values of vertices, animations and skins.
void repair_accessors(GltfContents& contents, Report& report);

/// Checks that the document can be read again, that all indices of its triangles name vertices, and
/// that its vertices have finite values.
///
/// \throws InvalidInput with the location and the remedy
void require_valid(const GltfContents& contents);

/// Replaces values of a primitive that glTF forbids. The corners of triangles with a non-finite
/// position become one vertex, so that the triangle has no area and draws nothing. Non-finite and
/// zero normals become (0,0,1), non-finite tangents (1,0,0,1), other non-finite components of
/// attributes 0, and those of colors 1.
///
/// \param report  counts the triangles and the attributes
void repair_values(GltfContents& contents, GltfPrimitiveId id, Report& report);

// Additions (bytes, buffer views, accessors) and removal of extensions

/// Reserves capacity for bytes that will be appended.
void reserve_bytes(GltfContents& contents, std::size_t count);

/// Appends bytes to the buffer of added data, at a multiple of 4. \return their offset
std::size_t append_bytes(GltfContents& contents, std::string_view bytes);

/// Appends bytes as a new buffer view. \return its index
std::size_t add_view(GltfContents& contents, std::string_view bytes);

/// Adds bytes that outlive the contents as a buffer and a buffer view. \return the view's index
std::size_t add_borrowed_view(GltfContents& contents, std::string_view bytes);

/// Appends packed elements of `size` bytes as a new buffer view, with the alignment that `target`
/// requires.
/// \return the view's index
std::size_t add_elements(GltfContents& contents, std::size_t size, const std::string& elements,
                         int target);

/// Adds an accessor with its own buffer view. `accessor` has all properties except location and
/// count.
/// \return its index
std::size_t add_accessor(GltfContents& contents, Json accessor, const std::string& elements,
                         int target);

/// Like add_accessor(), but reuses an equal accessor that was added by this function. Primitives
/// that shared an accessor thus share its replacement.
std::size_t add_shared_accessor(GltfContents& contents, Json accessor, const std::string& elements,
                                int target);

/// Updates min and max, if the accessor has them. If elements are not finite, the old bounds stay,
/// because JSON cannot hold them.
void update_bounds(Json& accessor, std::string_view elements);

/// Sets the bounds that glTF requires for positions: those of the finite coordinates, or 0 if there
/// are none.
void set_bounds(Json& accessor, std::span<const glm::vec3> positions);

/// Removes an extension from an object that may have it.
void erase_extension(Json& holder, const char* extension);

/// Removes an extension from extensionsUsed and extensionsRequired if no object has it.
void remove_unused_extension(Json& root, std::string_view extension);

// URIs (data URIs, and names of files beside the document) and media types of images

/// The contents of a data URI.
struct DataUri {
    std::string media_type;  ///< "image/png"; empty if the URI has none.
    std::string bytes;
};

bool is_data_uri(std::string_view uri);

/// \throws InvalidInput if it is not a data URI or its base64 is malformed
DataUri decode_data_uri(std::string_view uri);

/// Returns true if a URI has a scheme ("https:", "file:"), so that it does not depend on a folder.
bool has_scheme(std::string_view uri);

/// Returns the path of a relative URI below a folder; nullopt if it leads out of the folder
/// (absolute path,
/// "..", scheme) or has a zero byte.
std::optional<std::filesystem::path> path_inside(const std::filesystem::path& folder,
                                                 std::string_view uri);

/// The same for a file that is read: if the limits of the process permit it (relief/mesh/limits.h),
/// the path may lead out of the folder.
std::optional<std::filesystem::path> readable_path(const std::filesystem::path& folder,
                                                   std::string_view uri);

/// Encodes a file name as a URI: all bytes except letters, digits and -._~ are percent-encoded.
std::string uri_of(const std::string& file_name);

/// Returns the media type of an encoded image, from its first bytes: PNG, JPEG, WebP, AVIF, KTX2 or
/// DDS; empty for any other format.
std::string image_media_type(std::string_view bytes);

}  // namespace relief::detail
