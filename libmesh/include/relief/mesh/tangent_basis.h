// SPDX-License-Identifier: Apache-2.0
/// \file
/// Identifies the method with which the stored tangents of a mesh were computed.
///
/// A normal map is correct only with the tangents that its baker assumed, but files do not name the
/// method. Therefore the tangents are computed by all known methods and compared with the stored
/// ones.
/// Tests: tests/mesh/geometry/tangent_basis_test.cpp.
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

/// The methods that can be identified.
enum class TangentBasis {
    mikktspace,  ///< See tangents.h, also for the next two.
    area_weighted,
    lengyel,
    triangle,  ///< The gradient of each triangle, without averaging: faceted.
};

/// All methods, in the order of the enumeration.
std::span<const TangentBasis> tangent_bases();

/// Returns the name as in the tools: "mikktspace", "area-weighted", "lengyel", "triangle".
std::string_view name_of(TangentBasis basis);

/// The agreement of stored tangents with one method, over all corners that can be compared.
///
/// The directions within the plane of the normal are compared; diagnose() reports tangents outside
/// of this plane. Stored frames may be rotated by multiples of 90 degrees, if a program uses
/// another axis as the tangent or flipped texture coordinates.
struct TangentAgreement {
    TangentBasis basis = TangentBasis::mikktspace;
    /// Number of corners within the tolerance of the method's tangent, its bitangent (rotated by 90
    /// degrees), and the opposites of both.
    std::array<std::size_t, 4> within{};
    int quarter_turns = 0;     ///< The rotation with the most corners, in units of 90 degrees.
    AngleDistribution angles;  ///< The angles to that direction.
    /// Number of the corners within the tolerance of that direction whose w is opposite to the
    /// method's.
    std::size_t negated = 0;
    /// The mean angle in degrees; angles above the tolerance count as the tolerance.
    double mean_clamped = 0.0;

    [[nodiscard]] std::size_t agreeing() const {
        return within[static_cast<std::size_t>(quarter_turns)];
    }
    /// The agreeing corners as a share of all, 0 to 1.
    [[nodiscard]] double share() const;
};

struct IdentifiedTangents {
    /// The identified method; absent if no known method agrees.
    std::optional<TangentBasis> basis;
    /// Other methods with the same result on this mesh, such as all methods on a plane.
    std::vector<TangentBasis> equivalent_methods;
    /// The agreement with each method, in the order of the enumeration; empty if nothing can be
    /// compared, because there are no tangents, normals or texture coordinates.
    std::vector<TangentAgreement> agreements;
    std::size_t corners = 0;  ///< Number of compared corners.
    /// Number of corners of triangles that are too degenerate for a reliable direction.
    std::size_t left_out = 0;
    std::size_t undefined = 0;  ///< Number of corners whose stored tangent has no direction.
    double tolerance = 0.0;     ///< In degrees.
    /// 8 or 16 if all values are multiples of what this number of bits can store; 0 for floats.
    int stored_bits = 0;

    /// The agreement with `basis`, or with the method of the smallest mean if no method was
    /// identified; null if there is none.
    [[nodiscard]] const TangentAgreement* best() const;
    /// Returns true if the means of all other methods are at least 1.5 times as large. If no method
    /// was identified, the tangents then probably come from this method and different input
    /// (unrounded positions, other normals) or were stored with low precision.
    [[nodiscard]] bool is_clearly_best() const;
};

/// Compares the tangents of a mesh with every known method.
///
/// \param mesh  with the texture coordinates that belong to the tangents
/// \return a method is identified if 95% of the corners agree with it within the tolerance: 0.1
///         degrees, which covers float arithmetic in another order, or half a degree for 8-bit
///         storage. Of several methods it is the one with the smallest mean; methods that are
///         equally good are listed too
/// \throws InvalidInput if the mesh is not valid
///
/// Corners are omitted if their triangle is so small, in space or in the image, that rounding of
/// its corners changes the gradient: its height is less than 1000 times the spacing of floats at
/// its position, or less than 1e-6 of its longest side.
IdentifiedTangents identify_tangents(const Mesh& mesh);

/// Describes a rotation by multiples of 90 degrees and a sign: "", "w negated", ...
std::string_view variant_text(int quarter_turns, bool is_negated);

}  // namespace relief
