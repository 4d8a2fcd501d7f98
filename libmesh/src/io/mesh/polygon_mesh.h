// SPDX-License-Identifier: Apache-2.0
/// \file
/// From the corners of polygons to the vertices and triangles of a mesh.
///
/// *Triangulation* follows one fixed rule. A quad is cut along the diagonal that is shorter in
/// texture space. Without texture coordinates, or if they give equal lengths, the diagonal that is
/// shorter in object space is used; on a further tie the one from the first corner to the third.
/// This is the rule of MikkTSpace, so that tangents agree with those of the quad mesh. A quad with
/// one reflex corner is cut at this corner, because the other diagonal lies outside. Larger
/// polygons are cut into ears in the plane of their Newell normal, lowest corner number first, so
/// that a convex polygon becomes a fan around its first corner.
///
/// *Vertices.* Equal corners are merged into vertices. Values are equal if all their bits are.
/// Vertices are numbered in order of first use, so the numbers depend only on the corners and their
/// order.
///
/// Source: [Mikkelsen 2008] (quads), [Sutherland et al. 1974] (Newell normal), [Meisters 1975]
/// (ears).
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <limits>
#include <span>
#include <vector>

#include "io/mesh/obj_parser.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"

namespace relief::detail {

/// The method that cut a polygon.
enum class PolygonCut {
    ears,          ///< Completely, or it has four corners at most.
    fan,           ///< The rest is a fan: no plane, crossing edges, or non-finite corners.
    fan_at_limit,  ///< The rest is a fan after 200 million tests.
};

/// Cuts a polygon of n corners into n - 2 triangles with the same winding.
///
/// \param positions  one per corner, object space, any unit of length; at least 3
/// \param texcoords  one per corner, or empty
/// \param triangles  triples of corner numbers are appended
PolygonCut triangulate_polygon(std::span<const glm::vec3> positions,
                               std::span<const glm::vec2> texcoords,
                               std::vector<glm::uvec3>& triangles);

/// Polygons as consecutive ranges of vertex indices.
struct Polygons {
    std::vector<std::uint32_t> corners;
    std::vector<std::uint32_t> corner_counts;
};

/// Triangles, and the polygon of each.
struct CutPolygons {
    std::vector<glm::uvec3> triangles;
    std::vector<std::uint32_t> polygons;
};

/// Triangulates polygons by triangulate_polygon().
///
/// \param vertices  positions, and texture coordinates if it has them
/// \param report    counts polygons of fewer than three corners (left out), and those that are cut
///         as fans
CutPolygons cut_polygons(const Mesh& vertices, const Polygons& polygons, Report& report);

/// Sets the triangles of a mesh. \throws FileError if a polygon names a missing vertex, or if there
/// are no triangles
void add_triangles(Mesh& mesh, const Polygons& polygons, const std::filesystem::path& file,
                   Report& report);

/// Checks triangles that are the faces of a file. \throws FileError if one names a missing vertex
void check_faces(const Mesh& mesh, const std::filesystem::path& file);

/// An open-addressing hash table that numbers keys of N words in order of first use.
template <std::size_t N>
class KeyNumbers {
  public:
    using Key = std::array<std::uint32_t, N>;

    explicit KeyNumbers(std::size_t expected) {
        slots_.assign(std::bit_ceil(2 * expected + 16), none);
        keys_.reserve(expected);
    }

    /// Returns the number of a key; a new key gets the next number.
    std::uint32_t number_of(const Key& key) {
        if (2 * keys_.size() >= slots_.size()) grow();
        std::uint32_t& slot = slots_[slot_of(key)];
        if (slot == none) {
            slot = static_cast<std::uint32_t>(keys_.size());
            keys_.push_back(key);
        }
        return slot;
    }

    /// Returns all keys, indexed by their number.
    [[nodiscard]] const std::vector<Key>& keys() const { return keys_; }

  private:
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

    std::size_t slot_of(const Key& key) const {
        // Words are combined with a multiplier and a shift of MurmurHash3's finalizer.
        std::uint64_t hash = 0;
        for (const std::uint32_t word : key) {
            hash = (hash ^ word) * 0xff51afd7ed558ccdULL;
            hash ^= hash >> 33;
        }
        std::size_t slot_index = hash & (slots_.size() - 1);
        while (slots_[slot_index] != none && keys_[slots_[slot_index]] != key) {
            slot_index = (slot_index + 1) & (slots_.size() - 1);
        }
        return slot_index;
    }

    void grow() {
        slots_.assign(2 * slots_.size(), none);
        for (std::size_t i = 0; i < keys_.size(); ++i) {
            slots_[slot_of(keys_[i])] = static_cast<std::uint32_t>(i);
        }
    }

    std::vector<std::uint32_t> slots_;
    std::vector<Key> keys_;
};

/// Fills `mesh` with one vertex for each combination of values among the corners; attributes that
/// no corner has stay empty.
///
/// Each corner must have a texture coordinate if any has one, and a normal if any has one.
/// \return the vertex of each corner
std::vector<std::uint32_t> unify_vertices(const ObjStatements& statements, Mesh& mesh);

}  // namespace relief::detail
