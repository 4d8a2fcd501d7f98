// SPDX-License-Identifier: Apache-2.0
// Leaving retired accessors, buffer views and their bytes out of a document, and joining its
// buffers into one.
//
// Bytes are cut out of a buffer where a retired accessor or view covers them and nothing else does.
// Cuts are whole multiples of the alignment, so that all that follows keeps its own.
// Tests: tests/mesh/io/gltf/gltf_frames_test.cpp.
#include "io/gltf/gltf_layout.h"

#include <algorithm>
#include <limits>
#include <map>
#include <set>

#include "io/gltf/gltf_accessor.h"
#include "io/gltf/gltf_schema.h"

namespace relief {
namespace {

/// Bytes [begin, end) of one buffer.
struct Extent {
    std::size_t begin = 0;
    std::size_t end = 0;
};

constexpr std::size_t dropped = std::numeric_limits<std::size_t>::max();

/// The compressed copy of a view, or null.
const Json* packed_copy(const Json& view) {
    for (const char* extension : meshopt_extensions) {
        if (const Json* packed = find(view, "extensions", extension)) return packed;
    }
    return nullptr;
}

/// How often each entry of an array is referred to.
std::vector<std::size_t> reference_counts(Json& root, std::string_view target, const char* key) {
    std::vector<std::size_t> counts(array_in(root, key).size(), 0);
    visit_references(root, [&](std::string_view refers_to, Json& index) {
        if (refers_to == target) ++counts[index.get<std::size_t>()];
    });
    return counts;
}

/// Erases entries of an array and renumbers what refers to it.
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

/// The bytes that an accessor's elements cover, gaps between them included.
Extent extent_of_elements(const Json& root, const Json& accessor) {
    const Json& view = root["bufferViews"][size_in(accessor, "bufferView")];
    const std::size_t size = element_layout(accessor).size;
    const std::size_t stride = size_in(view, "byteStride", size);
    const std::size_t count = size_in(accessor, "count");
    const std::size_t begin = size_in(view, "byteOffset") + size_in(accessor, "byteOffset");
    return {begin, count == 0 ? begin : begin + (count - 1) * stride + size};
}

/// Finds what can go, and what of each buffer is covered by what goes and by what stays.
class Clearance {
  public:
    Clearance(Json& root, const GltfContents& contents)
        : root_(root), dead_(contents.buffers.size()), live_(contents.buffers.size()) {
        for (const GltfBuffer& buffer : contents.buffers)
            sizes_.push_back(buffer.size);
        drop_accessors(contents);
        drop_views(contents);
        for (const GltfExtent& extent : contents.retired_bytes)
            dead_[extent.buffer].push_back({extent.begin, extent.end});
        const auto is_empty = [](const std::vector<Extent>& extents) { return extents.empty(); };
        if (!std::all_of(dead_.begin(), dead_.end(), is_empty)) collect_live();
    }

    /// Erases what can go. \return the dead bytes of each buffer, cut to multiples of `alignment`
    std::vector<std::vector<Extent>> clear(std::size_t alignment);

  private:
    void drop_accessors(const GltfContents& contents);
    void drop_views(const GltfContents& contents);
    void collect_live();
    void add(std::vector<std::vector<Extent>>& to, const Json& view, Extent extent) {
        to[size_in(view, "buffer")].push_back(extent);
    }
    void add_view_to(std::vector<std::vector<Extent>>& to, const Json& view) {
        add(to, view, extent_of_view(view));
        if (const Json* packed = packed_copy(view)) {
            add(to, *packed, extent_of_view(*packed));
        }
    }

    Json& root_;
    std::set<std::size_t> dropped_accessors_, dropped_views_;
    std::set<std::size_t> touched_views_;  ///< Those that lost an accessor.
    std::vector<std::vector<Extent>> dead_, live_;
    std::vector<std::size_t> sizes_;  ///< Of the buffers.
};

void Clearance::drop_accessors(const GltfContents& contents) {
    const auto counts = reference_counts(root_, "accessors", "accessors");
    for (const std::size_t i : contents.retired_accessors) {
        if (counts[i] > 0) continue;
        dropped_accessors_.insert(i);
        const Json& accessor = root_["accessors"][i];
        if (const auto view = index_in(accessor, "bufferView")) {
            touched_views_.insert(*view);
            add(dead_, root_["bufferViews"][*view], extent_of_elements(root_, accessor));
        }
        for (const char* part : {"indices", "values"}) {
            const Json* sparse = find(accessor, "sparse", part);
            if (sparse != nullptr) touched_views_.insert(size_in(*sparse, "bufferView"));
        }
    }
}

void Clearance::drop_views(const GltfContents& contents) {
    auto counts = reference_counts(root_, "bufferViews", "bufferViews");
    // What the dropped accessors refer to does not count.
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
        add_view_to(dead_, root_["bufferViews"][i]);
    }
}

/// Of a view that lost an accessor, only what the others cover lives on, if accessors are all that
/// refers to it; any other view lives whole.
void Clearance::collect_live() {
    std::map<std::size_t, std::size_t> accessor_counts;
    const Json& accessors = array_in(root_, "accessors");
    for (std::size_t i = 0; i < accessors.size(); ++i) {
        const auto view = index_in(accessors[i], "bufferView");
        if (view) ++accessor_counts[*view];
    }
    const auto counts = reference_counts(root_, "bufferViews", "bufferViews");
    const auto is_partly_live = [&](std::size_t view) {
        return touched_views_.contains(view) && accessor_counts[view] == counts[view] &&
               packed_copy(root_["bufferViews"][view]) == nullptr;
    };
    for (std::size_t i = 0; i < accessors.size(); ++i) {
        const auto view = index_in(accessors[i], "bufferView");
        if (!view || dropped_accessors_.contains(i) || !is_partly_live(*view)) continue;
        add(live_, root_["bufferViews"][*view], extent_of_elements(root_, accessors[i]));
    }
    const Json& views = array_in(root_, "bufferViews");
    for (std::size_t i = 0; i < views.size(); ++i) {
        if (!dropped_views_.contains(i) && !is_partly_live(i)) add_view_to(live_, views[i]);
    }
}

/// The parts of `dead` that `live` does not cover, ascending.
std::vector<Extent> uncovered(std::vector<Extent> dead, std::vector<Extent> live) {
    const auto by_begin = [](const Extent& a, const Extent& b) { return a.begin < b.begin; };
    std::sort(dead.begin(), dead.end(), by_begin);
    std::sort(live.begin(), live.end(), by_begin);
    std::vector<Extent> result;
    std::size_t done = 0;  // All before this is decided.
    auto next = live.begin();
    for (const Extent& extent : dead) {
        std::size_t at = std::max(extent.begin, done);
        while (at < extent.end) {
            while (next != live.end() && next->end <= at)
                ++next;
            // Live extents may overlap: the next one may begin long before.
            const std::size_t free_until =
                next == live.end() ? extent.end : std::min(extent.end, next->begin);
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

std::vector<std::vector<Extent>> Clearance::clear(std::size_t alignment) {
    std::vector<std::vector<Extent>> cuts(dead_.size());
    for (std::size_t buffer = 0; buffer < dead_.size(); ++buffer) {
        // The padding behind what goes away goes with it.
        for (Extent& extent : dead_[buffer]) {
            extent.end = std::min((extent.end + 3) / 4 * 4, sizes_[buffer]);
        }
        for (Extent extent : uncovered(dead_[buffer], live_[buffer])) {
            // What follows keeps its alignment; behind the end of a buffer nothing does.
            const bool is_last = extent.end == sizes_[buffer];
            if (!is_last) extent.end -= (extent.end - extent.begin) % alignment;
            if (extent.end > extent.begin) cuts[buffer].push_back(extent);
        }
    }
    erase_entries(root_, "accessors", dropped_accessors_);
    erase_entries(root_, "bufferViews", dropped_views_);
    return cuts;
}

/// Where the bytes of all buffers go in the one that is written.
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

    /// The new place of a byte; of one that was cut out, that of the first behind the cut.
    [[nodiscard]] std::size_t place_of(std::size_t buffer, std::size_t offset) const {
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
    /// Bytes from `from` on, up to the next move, go to `to` and behind.
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

/// Moves a view, or the compressed form of one.
void move_view(Json& view, const Relocation& relocation) {
    const std::size_t buffer = size_in(view, "buffer");
    const Extent extent = extent_of_view(view);
    const std::size_t begin = relocation.place_of(buffer, extent.begin);
    view["byteLength"] = relocation.place_of(buffer, extent.end) - begin;
    view["buffer"] = 0;
    set_offset(view, begin);
}

/// Rewrites every offset and length, accessors first, since they are relative to their views.
void relocate(Json& root, const Relocation& relocation) {
    const auto move_in_view = [&](Json& holder) {
        const Json& view = root["bufferViews"][size_in(holder, "bufferView")];
        const std::size_t buffer = size_in(view, "buffer");
        const std::size_t view_begin = size_in(view, "byteOffset");
        set_offset(holder, relocation.place_of(buffer, view_begin + size_in(holder, "byteOffset")) -
                               relocation.place_of(buffer, view_begin));
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

/// The only buffer of the result.
void join_buffers(Json& root, std::size_t size) {
    if (size == 0) {
        root.erase("buffers");
        return;
    }
    Json buffer = root["buffers"][0];
    buffer.erase("uri");
    // The joined buffer is more than the stand-in for what meshopt unpacks.
    for (const char* extension : meshopt_extensions) {
        if (find(buffer, "extensions", extension) == nullptr) continue;
        buffer["extensions"].erase(extension);
        if (buffer["extensions"].empty()) buffer.erase("extensions");
    }
    buffer["byteLength"] = size;
    root["buffers"] = Json::array({buffer});
}

}  // namespace

GltfLayout layout_of(const GltfContents& contents) {
    GltfLayout layout;
    layout.root = contents.root;
    const bool has_metadata =
        find(layout.root, "extensions", "EXT_structural_metadata", "propertyTables") != nullptr;
    const std::size_t alignment = has_metadata ? 8 : 4;
    std::vector<std::vector<Extent>> cuts(contents.buffers.size());
    const bool has_retired = !contents.retired_accessors.empty() ||
                             !contents.retired_views.empty() || !contents.retired_bytes.empty();
    if (has_retired && !has_unknown_extension(layout.root)) {
        cuts = Clearance(layout.root, contents).clear(alignment);
    }
    Relocation relocation(contents, cuts, alignment);
    relocate(layout.root, relocation);
    join_buffers(layout.root, relocation.size);
    layout.pieces = std::move(relocation.pieces);
    layout.size = relocation.size;
    return layout;
}

}  // namespace relief
