// SPDX-License-Identifier: Apache-2.0
// Writes a document as .gltf with its buffer beside it, or as .glb with everything in one file.
//
// The layout leaves out retired accessors, buffer views and their bytes, and joins all buffers.
// Bytes are cut out of a buffer if a retired accessor or view covers them and nothing else does.
// Cuts are multiples of the alignment, so that the alignment of the bytes behind them does not
// change.
//
// The bytes of images are kept. A .glb embeds all readable images. Beside a .gltf, image files stay
// files and are copied if the folder changes; a different file in their place is a FileError,
// because another document may need it. Source: glTF 2.0 (ISO/IEC 12113), chapter 4.
#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <limits>
#include <list>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string_view>
#include <vector>

#include "file_replacement.h"
#include "files.h"
#include "io/gltf/gltf_accessor.h"
#include "io/gltf/gltf_contents.h"
#include "io/gltf/gltf_writer.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/report.h"

namespace relief {
using namespace relief::detail;

namespace {

/// A document with a single buffer, and the pieces of this buffer in order.
struct GltfLayout {
    Json root;
    std::vector<std::string_view> pieces;  ///< Views of the contents, which must outlive them.
    std::size_t size = 0;                  ///< Total bytes of the pieces.
};

/// The bytes [begin, end) of one buffer.
struct Extent {
    std::size_t begin = 0;
    std::size_t end = 0;
};

constexpr std::size_t dropped = std::numeric_limits<std::size_t>::max();

/// Returns the compressed copy of a view, or null.
const Json* packed_copy(const Json& view) {
    for (const char* extension : meshopt_extensions) {
        if (const Json* packed = find(view, "extensions", extension)) return packed;
    }
    return nullptr;
}

/// Returns the number of references to each entry of an array.
std::vector<std::size_t> reference_counts(Json& root, std::string_view target, const char* key) {
    std::vector<std::size_t> counts(array_in(root, key).size(), 0);
    visit_references(root, [&](std::string_view refers_to, Json& index) {
        if (refers_to == target) ++counts[index.get<std::size_t>()];
    });
    return counts;
}

/// Erases entries of an array and renumbers the references to it.
void erase_entries(Json& root, const char* key, const std::set<std::size_t>& entries) {
    if (entries.empty()) return;
    Json& array = root[key];
    std::vector<std::size_t> new_numbers(array.size(), dropped);
    Json kept = Json::array();
    for (std::size_t i = 0; i < array.size(); ++i) {
        if (entries.contains(i)) continue;
        new_numbers[i] = kept.size();
        kept.push_back(std::move(array[i]));
    }
    array = std::move(kept);
    if (array.empty()) root.erase(key);
    visit_references(root, [&](std::string_view target, Json& index) {
        if (target == key) index = new_numbers[index.get<std::size_t>()];
    });
}

Extent extent_of_view(const Json& view) {
    const std::size_t begin = size_in(view, "byteOffset");
    return {begin, begin + size_in(view, "byteLength")};
}

/// Returns the bytes from the first to the last element of an accessor, gaps included.
Extent extent_of_elements(const Json& root, const Json& accessor) {
    const Json& view = root["bufferViews"][size_in(accessor, "bufferView")];
    const std::size_t size = element_layout(accessor).size;
    const std::size_t stride = size_in(view, "byteStride", size);
    const std::size_t count = size_in(accessor, "count");
    const std::size_t begin = size_in(view, "byteOffset") + size_in(accessor, "byteOffset");
    return {begin, count == 0 ? begin : begin + (count - 1) * stride + size};
}

/// Finds unused entries, and the bytes of each buffer that used and unused entries cover.
class UnusedData {
  public:
    UnusedData(Json& root, const GltfContents& contents)
        : root_(root), unused_(contents.buffers.size()), used_(contents.buffers.size()) {
        for (const GltfBuffer& buffer : contents.buffers)
            sizes_.push_back(buffer.size);
        drop_images(contents);
        drop_accessors(contents);
        drop_views(contents);
        for (const GltfExtent& extent : contents.retired_bytes)
            unused_[extent.buffer].push_back({extent.begin, extent.end});
        const auto is_empty = [](const std::vector<Extent>& extents) { return extents.empty(); };
        if (!std::all_of(unused_.begin(), unused_.end(), is_empty)) collect_used();
    }

    /// Erases the unused entries. \return the unused bytes of each buffer, in multiples of
    /// `alignment`
    std::vector<std::vector<Extent>> clear(std::size_t alignment);

  private:
    void drop_images(const GltfContents& contents);
    void drop_accessors(const GltfContents& contents);
    void drop_views(const GltfContents& contents);
    void collect_used();
    void add(std::vector<std::vector<Extent>>& to, const Json& view, Extent extent) {
        to[size_in(view, "buffer")].push_back(extent);
    }
    void add_view(std::vector<std::vector<Extent>>& to, const Json& view) {
        add(to, view, extent_of_view(view));
        if (const Json* packed = packed_copy(view)) {
            add(to, *packed, extent_of_view(*packed));
        }
    }

    Json& root_;
    std::set<std::size_t> dropped_images_, dropped_accessors_, dropped_views_;
    std::set<std::size_t> touched_views_;  ///< Views that lost an accessor or an image.
    std::vector<std::vector<Extent>> unused_, used_;
    std::vector<std::size_t> sizes_;  ///< Sizes of the buffers.
};

void UnusedData::drop_images(const GltfContents& contents) {
    const auto counts = reference_counts(root_, "images", "images");
    for (const std::size_t i : contents.retired_images) {
        if (counts[i] > 0) continue;
        dropped_images_.insert(i);
        const auto view = index_in(root_["images"][i], "bufferView");
        if (view) touched_views_.insert(*view);
    }
}

void UnusedData::drop_accessors(const GltfContents& contents) {
    const auto counts = reference_counts(root_, "accessors", "accessors");
    for (const std::size_t i : contents.retired_accessors) {
        if (counts[i] > 0) continue;
        dropped_accessors_.insert(i);
        const Json& accessor = root_["accessors"][i];
        if (const auto view = index_in(accessor, "bufferView")) {
            touched_views_.insert(*view);
            add(unused_, root_["bufferViews"][*view], extent_of_elements(root_, accessor));
        }
        for (const char* part : {"indices", "values"}) {
            const Json* sparse = find(accessor, "sparse", part);
            if (sparse != nullptr) touched_views_.insert(size_in(*sparse, "bufferView"));
        }
    }
}

void UnusedData::drop_views(const GltfContents& contents) {
    auto counts = reference_counts(root_, "bufferViews", "bufferViews");
    // References from dropped images and accessors do not count.
    for (const std::size_t i : dropped_images_) {
        const auto view = index_in(root_["images"][i], "bufferView");
        if (view) --counts[*view];
    }
    for (const std::size_t i : dropped_accessors_) {
        const Json& accessor = root_["accessors"][i];
        if (const auto view = index_in(accessor, "bufferView")) --counts[*view];
        for (const char* part : {"indices", "values"}) {
            const Json* sparse = find(accessor, "sparse", part);
            if (sparse != nullptr) --counts[size_in(*sparse, "bufferView")];
        }
    }
    std::set<std::size_t> candidates = touched_views_;
    candidates.insert(contents.retired_views.begin(), contents.retired_views.end());
    for (const std::size_t i : candidates) {
        if (counts[i] > 0) continue;
        dropped_views_.insert(i);
        add_view(unused_, root_["bufferViews"][i]);
    }
}

/// If a view lost an accessor and only accessors refer to it, just the bytes of the remaining
/// accessors are used. All bytes of any other view are used.
void UnusedData::collect_used() {
    std::map<std::size_t, std::size_t> accessor_counts;
    const Json& accessors = array_in(root_, "accessors");
    for (std::size_t i = 0; i < accessors.size(); ++i) {
        const auto view = index_in(accessors[i], "bufferView");
        if (view) ++accessor_counts[*view];
    }
    const auto counts = reference_counts(root_, "bufferViews", "bufferViews");
    const auto is_partly_used = [&](std::size_t view) {
        return touched_views_.contains(view) && accessor_counts[view] == counts[view] &&
               packed_copy(root_["bufferViews"][view]) == nullptr;
    };
    for (std::size_t i = 0; i < accessors.size(); ++i) {
        const auto view = index_in(accessors[i], "bufferView");
        if (!view || dropped_accessors_.contains(i) || !is_partly_used(*view)) continue;
        add(used_, root_["bufferViews"][*view], extent_of_elements(root_, accessors[i]));
    }
    const Json& views = array_in(root_, "bufferViews");
    for (std::size_t i = 0; i < views.size(); ++i) {
        if (!dropped_views_.contains(i) && !is_partly_used(i)) add_view(used_, views[i]);
    }
}

/// The parts of `unused` that `used` does not cover, ascending.
std::vector<Extent> uncovered(std::vector<Extent> unused, std::vector<Extent> used) {
    const auto by_begin = [](const Extent& a, const Extent& b) { return a.begin < b.begin; };
    std::sort(unused.begin(), unused.end(), by_begin);
    std::sort(used.begin(), used.end(), by_begin);
    std::vector<Extent> result;
    std::size_t done = 0;  // Everything before this offset is decided.
    auto next = used.begin();
    for (const Extent& extent : unused) {
        std::size_t at = std::max(extent.begin, done);
        while (at < extent.end) {
            while (next != used.end() && next->end <= at)
                ++next;
            // Used extents may overlap: the next one may begin much earlier.
            const std::size_t free_until =
                next == used.end() ? extent.end : std::min(extent.end, next->begin);
            if (free_until > at) {
                if (!result.empty() && result.back().end == at) {
                    result.back().end = free_until;
                } else {
                    result.push_back({at, free_until});
                }
                at = free_until;
            } else {
                at = next->end;
            }
        }
        done = std::max(done, extent.end);
    }
    return result;
}

std::vector<std::vector<Extent>> UnusedData::clear(std::size_t alignment) {
    std::vector<std::vector<Extent>> cuts(unused_.size());
    for (std::size_t buffer = 0; buffer < unused_.size(); ++buffer) {
        // Padding goes with the bytes before it.
        for (Extent& extent : unused_[buffer]) {
            extent.end = std::min((extent.end + 3) / 4 * 4, sizes_[buffer]);
        }
        for (Extent extent : uncovered(unused_[buffer], used_[buffer])) {
            // The alignment of the following bytes must not change. Nothing follows the end of a
            // buffer.
            const bool is_last = extent.end == sizes_[buffer];
            if (!is_last) extent.end -= (extent.end - extent.begin) % alignment;
            if (extent.end > extent.begin) cuts[buffer].push_back(extent);
        }
    }
    erase_entries(root_, "images", dropped_images_);
    erase_entries(root_, "accessors", dropped_accessors_);
    erase_entries(root_, "bufferViews", dropped_views_);
    return cuts;
}

/// Maps the bytes of all buffers to the joined buffer.
class Relocation {
  public:
    Relocation(const GltfContents& contents, const std::vector<std::vector<Extent>>& cuts,
               std::size_t alignment) {
        static const std::string zeros(64, '\0');
        for (std::size_t i = 0; i < contents.buffers.size(); ++i) {
            const std::string_view bytes = contents.buffers[i].bytes();
            if (size % alignment != 0) {
                add(std::string_view(zeros).substr(0, alignment - size % alignment));
            }
            std::vector<Move>& moves = moves_.emplace_back();
            std::size_t at = 0;
            for (const Extent& cut : cuts[i]) {
                moves.push_back({at, size});
                add(bytes.substr(at, cut.begin - at));
                at = cut.end;
            }
            moves.push_back({at, size});
            add(bytes.substr(at));
        }
    }

    /// Returns the new offset of a byte. A byte that is cut out maps to the first byte behind the
    /// cut.
    [[nodiscard]] std::size_t moved_offset(std::size_t buffer, std::size_t offset) const {
        const std::vector<Move>& moves = moves_[buffer];
        auto next = std::upper_bound(moves.begin(), moves.end(), offset,
                                     [](std::size_t o, const Move& move) { return o < move.from; });
        const Move& move = *std::prev(next);
        const std::size_t place = move.to + (offset - move.from);
        return next == moves.end() ? place : std::min(place, next->to);
    }

    std::vector<std::string_view> pieces;
    std::size_t size = 0;

  private:
    /// Bytes from `from` up to the next move go to `to` and the following offsets.
    struct Move {
        std::size_t from = 0;
        std::size_t to = 0;
    };
    void add(std::string_view piece) {
        if (!piece.empty()) pieces.push_back(piece);
        size += piece.size();
    }

    std::vector<std::vector<Move>> moves_;
};

void set_offset(Json& holder, std::size_t offset) {
    if (offset != 0 || holder.contains("byteOffset")) holder["byteOffset"] = offset;
}

/// Moves a view, or its compressed copy.
void move_view(Json& view, const Relocation& relocation) {
    const std::size_t buffer = size_in(view, "buffer");
    const Extent extent = extent_of_view(view);
    const std::size_t begin = relocation.moved_offset(buffer, extent.begin);
    view["byteLength"] = relocation.moved_offset(buffer, extent.end) - begin;
    view["buffer"] = 0;
    set_offset(view, begin);
}

/// Rewrites all offsets and lengths. Accessors come first because they are relative to their views.
void relocate(Json& root, const Relocation& relocation) {
    const auto move_in_view = [&](Json& holder) {
        const Json& view = root["bufferViews"][size_in(holder, "bufferView")];
        const std::size_t buffer = size_in(view, "buffer");
        const std::size_t view_begin = size_in(view, "byteOffset");
        set_offset(holder,
                   relocation.moved_offset(buffer, view_begin + size_in(holder, "byteOffset")) -
                       relocation.moved_offset(buffer, view_begin));
    };
    if (root.contains("accessors")) {
        for (Json& accessor : root["accessors"]) {
            if (accessor.contains("bufferView")) move_in_view(accessor);
            if (!accessor.contains("sparse")) continue;
            move_in_view(accessor["sparse"]["indices"]);
            move_in_view(accessor["sparse"]["values"]);
        }
    }
    if (!root.contains("bufferViews")) return;
    for (Json& view : root["bufferViews"]) {
        move_view(view, relocation);
        for (const char* extension : meshopt_extensions) {
            if (find(view, "extensions", extension) == nullptr) continue;
            move_view(view["extensions"][extension], relocation);
        }
    }
}

/// Reduces the array of buffers to the joined one.
void join_buffers(Json& root, std::size_t size) {
    if (size == 0) {
        root.erase("buffers");
        return;
    }
    Json buffer = root["buffers"][0];
    buffer.erase("uri");
    // The joined buffer has data, so it is not a placeholder for meshopt any more.
    for (const char* extension : meshopt_extensions) {
        if (find(buffer, "extensions", extension) == nullptr) continue;
        buffer["extensions"].erase(extension);
        if (buffer["extensions"].empty()) buffer.erase("extensions");
    }
    buffer["byteLength"] = size;
    root["buffers"] = Json::array({buffer});
}

/// Lays a document out for writing.
///
/// Retired accessors and buffer views without references are left out with their bytes, and the
/// following entries are renumbered. If an unknown extension is present, everything stays, because
/// it may hold references. Everything else, used or not, keeps its bytes, order and alignment. The
/// joined buffer has the name, extras and extensions of the first one.
GltfLayout layout_of(const GltfContents& contents) {
    GltfLayout layout;
    layout.root = contents.root;
    const bool has_metadata =
        find(layout.root, "extensions", "EXT_structural_metadata", "propertyTables") != nullptr;
    const std::size_t alignment = has_metadata ? 8 : 4;
    std::vector<std::vector<Extent>> cuts(contents.buffers.size());
    const bool has_retired = !contents.retired_images.empty() ||
                             !contents.retired_accessors.empty() ||
                             !contents.retired_views.empty() || !contents.retired_bytes.empty();
    if (has_retired && !has_unknown_extension(layout.root)) {
        cuts = UnusedData(layout.root, contents).clear(alignment);
    }
    Relocation relocation(contents, cuts, alignment);
    relocate(layout.root, relocation);
    join_buffers(layout.root, relocation.size);
    layout.pieces = std::move(relocation.pieces);
    layout.size = relocation.size;
    return layout;
}

/// Writes the pieces to a temporary file.
void write_pieces(const FileReplacement& replacement, const std::vector<std::string_view>& pieces) {
    std::ofstream stream(replacement.written_path(), std::ios::binary);
    for (const std::string_view piece : pieces) {
        stream.write(piece.data(), static_cast<std::streamsize>(piece.size()));
    }
    stream.close();
    if (!stream) {
        throw FileError(replacement.file(),
                        fmt::format("cannot be written: {}", std::strerror(errno)));
    }
}

std::string dump(const Json& root, int indent, const std::filesystem::path& file) {
    try {
        return root.dump(indent, ' ');
    } catch (const Json::exception&) {
        throw FileError(file, "cannot be written: the document has a name that is not UTF-8");
    }
}

void append_word(std::string& bytes, std::uint32_t word) {
    bytes.append(reinterpret_cast<const char*>(&word), sizeof(word));
}

/// The path of an image that is a readable file; otherwise nullopt.
/// \param path_of  path_inside() or readable_path()
template <typename PathOf>
std::optional<std::filesystem::path> image_file(const Json& image, const GltfContents& contents,
                                                const PathOf& path_of) {
    const std::string uri = text_in(image, "uri");
    if (uri.empty() || is_data_uri(uri)) return std::nullopt;
    const auto added = contents.image_files.find(uri);
    if (added != contents.image_files.end()) return added->second;
    const auto path = path_of(contents.folder(), uri);
    std::error_code ignored;
    if (!path || !std::filesystem::is_regular_file(staged_file(*path), ignored))
        return std::nullopt;
    return path;
}

/// Throws if the file moves to another folder while the image is outside the old one.
void check_inside_folder(const Json& image, std::size_t number, const GltfContents& contents,
                         const std::filesystem::path& file) {
    const std::string uri = text_in(image, "uri");
    if (uri.empty() || has_scheme(uri) || path_inside(contents.folder(), uri)) return;
    if (std::filesystem::absolute(file).parent_path() == contents.folder()) return;
    throw FileError(file,
                    fmt::format("images[{}] '{}' is outside the document's folder: it is not read, "
                                "and its path is wrong from another folder; write to {}",
                                number, uri, contents.folder().string()));
}

/// Appends images from files and data URIs to the buffer. `storage` owns their bytes.
void embed_images(GltfLayout& layout, const GltfContents& contents,
                  const std::filesystem::path& file, std::list<std::string>& storage) {
    static const std::string zeros(4, '\0');
    if (!layout.root.contains("images")) return;
    Json& images = layout.root["images"];
    for (std::size_t i = 0; i < images.size(); ++i) {
        Json& image = images[i];
        const std::string uri = text_in(image, "uri");
        if (!readable_path(contents.folder(), uri)) check_inside_folder(image, i, contents, file);
        std::string media_type = text_in(image, "mimeType");
        if (is_data_uri(uri)) {
            DataUri data = decode_data_uri(uri);
            if (media_type.empty()) media_type = data.media_type;
            storage.push_back(std::move(data.bytes));
        } else if (const auto path = image_file(image, contents, readable_path)) {
            storage.push_back(read_file(*path));
        } else {
            continue;
        }
        const std::string& bytes = storage.back();
        const std::string actual = image_media_type(bytes);
        if (!actual.empty()) media_type = actual;
        if (media_type.empty()) {
            throw FileError(file,
                            fmt::format("images[{}] has neither format of glTF, PNG or JPEG", i));
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
    std::string json = dump(layout.root, -1, file);
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
    FileReplacement glb(file);
    write_pieces(glb, pieces);
    glb.commit();
}

/// Copies image files to the same relative path in the new folder.
void copy_images(const GltfContents& contents, const std::filesystem::path& file) {
    const std::filesystem::path folder = std::filesystem::absolute(file).parent_path();
    const Json& images = array_in(contents.root, "images");
    for (std::size_t i = 0; i < images.size(); ++i) {
        check_inside_folder(images[i], i, contents, file);
        const auto source = image_file(images[i], contents, path_inside);
        const bool is_added = contents.image_files.contains(text_in(images[i], "uri"));
        if (!source || (folder == contents.folder() && !is_added)) continue;
        const std::string bytes = read_file(*source);
        const std::filesystem::path target =
            folder /
            (is_added ? source->filename() : source->lexically_relative(contents.folder()));
        std::error_code failed;
        if (std::filesystem::exists(staged_file(target), failed)) {
            if (read_file(target) == bytes) continue;
            throw FileError(target,
                            fmt::format("exists and differs from images[{}] of {}, which would "
                                        "replace it; write .glb, which contains its images",
                                        i, file.string()));
        }
        std::filesystem::create_directories(target.parent_path(), failed);
        if (failed) throw FileError(target.parent_path(), "cannot be made: " + failed.message());
        replace_file(target, std::as_bytes(std::span(bytes)));
    }
}

/// Throws if the new buffer would replace one of the document that was read, which stays.
void check_buffer_place(const std::filesystem::path& buffer_file, const std::filesystem::path& file,
                        const GltfContents& contents) {
    std::error_code missing;
    if (std::filesystem::equivalent(file, contents.file, missing)) return;
    for (const Json& buffer : array_in(contents.root, "buffers")) {
        const std::string uri = text_in(buffer, "uri");
        if (uri.empty() || is_data_uri(uri)) continue;
        const auto path = readable_path(contents.folder(), uri);
        if (!path || !std::filesystem::equivalent(*path, buffer_file, missing)) continue;
        throw FileError(buffer_file, fmt::format("is a buffer of {}, which would be lost; use "
                                                 "another name, or write .glb",
                                                 contents.file.string()));
    }
}

void write_json(const std::filesystem::path& file, const GltfContents& contents) {
    GltfLayout layout = layout_of(contents);
    FileSet files;
    FileReplacement gltf(file);
    if (layout.size > 0) {
        std::filesystem::path buffer_file = file;
        buffer_file.replace_extension(".bin");
        layout.root["buffers"][0]["uri"] = uri_of(buffer_file.filename().string());
        check_buffer_place(buffer_file, file, contents);
        FileReplacement buffer(buffer_file);
        write_pieces(buffer, layout.pieces);
        buffer.commit();
    }
    const std::string json = dump(layout.root, 2, file) + "\n";
    write_all(gltf, std::as_bytes(std::span(json)));
    copy_images(contents, file);
    gltf.commit();
    files.commit();
}

}  // namespace

namespace {

/// A copy that borrows the bytes of the buffers. Data that is added to it goes to a new buffer.
GltfContents borrowing_copy(const GltfContents& contents) {
    GltfContents copy;
    copy.root = contents.root;
    copy.file = contents.file;
    for (const GltfBuffer& buffer : contents.buffers) {
        GltfBuffer& borrower = copy.buffers.emplace_back();
        borrower.borrowed = buffer.bytes();
        borrower.size = buffer.size;
        borrower.is_placeholder = buffer.is_placeholder;
    }
    copy.extra_chunks = contents.extra_chunks;
    copy.retired_accessors = contents.retired_accessors;
    copy.retired_views = contents.retired_views;
    copy.retired_images = contents.retired_images;
    copy.retired_bytes = contents.retired_bytes;
    copy.image_files = contents.image_files;
    copy.position_uses = contents.position_uses;
    return copy;
}

/// Adds the normals and tangents that a material needs for another texture than a normal map. With
/// a normal map, glTF lets the renderer compute them.
void add_required_tangents(GltfDocument& document, const GltfContents& contents, Report& report) {
    for (const GltfPrimitiveId id : document.triangle_primitives()) {
        const Json& primitive = primitive_json(contents, id);
        const Json& attributes = primitive["attributes"];
        const auto material = index_in(primitive, "material");
        if (!material || (attributes.contains("NORMAL") && attributes.contains("TANGENT")))
            continue;
        const GltfTangentTexcoords texcoords = document.tangent_texcoords(id);
        if (texcoords.texture.empty() || texcoords.texture == "normalTexture") continue;
        FrameOptions options;
        options.normals = attributes.contains("NORMAL") ? NormalMode::keep : NormalMode::flat;
        options.tangents = TangentMethod::mikktspace;
        report.add(fmt::format("{} of a primitive without tangents", texcoords.texture), "material",
                   *material, "gets MikkTSpace's tangents");
        document.set_frames(id, with_frames(document.mesh(id, texcoords.set), options, report),
                            options, report);
    }
}

}  // namespace

namespace detail {

void write_gltf(const std::filesystem::path& file, const GltfContents& contents) {
    const std::string extension = lower_extension(file);
    if (extension == ".glb") {
        write_glb(file, contents);
    } else if (extension == ".gltf") {
        write_json(file, contents);
    } else {
        throw FileError(
            file, fmt::format("'{}' is not an extension of glTF files, which are .gltf and .glb",
                              extension));
    }
}

}  // namespace detail

void GltfDocument::write(const std::filesystem::path& file, Report& report) const {
    GltfDocument copy(std::make_unique<Contents>(Contents{borrowing_copy(contents_->data)}));
    GltfContents& contents = copy.contents_->data;
    try {
        repair_document(contents, report);
        add_required_tangents(copy, contents, report);
        require_valid(contents);
    } catch (const InvalidInput& error) {
        throw FileError(file, fmt::format("cannot be written: {}", error.what()));
    }
    write_gltf(file, contents);
}

}  // namespace relief
