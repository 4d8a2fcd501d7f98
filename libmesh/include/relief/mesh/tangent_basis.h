// SPDX-License-Identifier: Apache-2.0
/// \file
/// By which method the tangents of a mesh were made, found out from the mesh itself.
///
/// A normal map is right only in the frame that its baker assumed, and files do not say which that
/// was. Here the methods in use are computed anew and held against what is stored.
/// Tests: tests/mesh/geometry/tangents/tangent_basis_test.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "relief/mesh/angle_distribution.h"
#include "relief/mesh/mesh.h"

namespace relief {

/// The methods that can be told.
enum class TangentBasis {
    mikktspace,  ///< tangents.h, as the next two.
    area_weighted,
    lengyel,
    triangle,  ///< Each triangle's own gradient, not averaged: facets.
};

/// All of them, in the order of the enumeration.
std::span<const TangentBasis> tangent_bases();

/// "mikktspace", "area-weighted", "lengyel", "triangle": the words of the tools.
std::string_view word_of(TangentBasis basis);

/// How stored tangents agree with one method, over the corners that can be judged.
///
/// Compared is the direction within the plane of the normal: whether a tangent leans out of it is
/// for diagnose() to say. The frames of a method may be stored turned by a quarter or more, where a
/// program means another axis by the tangent, or goes by flipped texture coordinates.
struct BasisAgreement {
    TangentBasis basis = TangentBasis::mikktspace;
    /// Corners within the tolerance of the method's tangent; of its bitangent (a quarter turn); of
    /// the opposites of the two.
    std::array<std::size_t, 4> within{};
    int quarter_turns = 0;     ///< The one with the most.
    AngleDistribution angles;  ///< From that direction.
    /// Of the corners within the tolerance of that direction: those whose w is the opposite of the
    /// method's.
    std::size_t negated = 0;
    double mean_clamped = 0.0;  ///< Degrees, larger ones counted as the tolerance.

    [[nodiscard]] std::size_t agreeing() const {
        return within[static_cast<std::size_t>(quarter_turns)];
    }
    /// The same as a share of all, 0 to 1.
    [[nodiscard]] double share() const;
};

struct SniffedTangents {
    /// Absent: none of those that are known.
    std::optional<TangentBasis> basis;
    /// Other methods that come to the same on this mesh, as all do on a plane.
    std::vector<TangentBasis> same_here;
    /// What each method comes to, in the order of the enumeration; empty where nothing can be
    /// judged: no tangents, no normals, no texture coordinates.
    std::vector<BasisAgreement> agreements;
    std::size_t corners = 0;    ///< That were judged.
    std::size_t left_out = 0;   ///< On triangles too degenerate to have a certain direction.
    std::size_t undefined = 0;  ///< Whose stored tangent is no direction.
    double tolerance = 0.0;     ///< Degrees.
    int stored_bits = 0;  ///< 8 or 16: all values are multiples of what that holds; 0: floats.

    /// That of `basis`, or, if it is absent, the one with the smallest mean; null where there are
    /// none.
    [[nodiscard]] const BasisAgreement* best() const;
    /// All others have a mean at least half as large again: where no basis agrees, tangents that
    /// were made by this one from other numbers (positions before rounding, other normals), or
    /// stored coarsely.
    [[nodiscard]] bool is_best_by_far() const;
};

/// Holds the tangents of a mesh against every method that is known.
///
/// \param mesh  with the texture coordinates that its tangents are thought to belong to
/// \return a basis where 95 of 100 corners agree with it within the tolerance: a tenth of a degree,
///         which is what float arithmetic in another order leaves, and half a degree where 8-bit
///         storage rounds. Of several the one with the smallest mean; those as good are named too
/// \throws InvalidInput if the mesh is not valid
///
/// Left out are corners of triangles whose area, in space or in the image, is so small that
/// rounding of their corners turns the gradient: their height is less than 1000 times the spacing
/// of floats there, or a millionth of their longest side.
SniffedTangents sniff_tangents(const Mesh& mesh);

/// What a quarter turn and a sign come to, in words: "", "w negated", ...
std::string_view variant_in_words(int quarter_turns, bool is_negated);

}  // namespace relief
