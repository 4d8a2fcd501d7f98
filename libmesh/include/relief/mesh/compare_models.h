// SPDX-License-Identifier: Apache-2.0
/// \file
/// The differences between the normals and tangents of two models.
/// Tests: tests/tools/relief_mesh_compare_test.cpp.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "relief/mesh/compare.h"
#include "relief/mesh/model.h"

namespace relief {

/// A primitive of a joined model.
struct ComparedPart {
    std::string name;  ///< Empty for a file with one mesh.
    std::size_t first_triangle = 0;
    std::size_t triangle_count = 0;
    bool has_normals = false;
    bool has_tangents = false;
    std::size_t unmatched = 0;   ///< The number of triangles without partner.
    FrameComparison comparison;  ///< Only for parts of the first model.
};

/// The primitives of a model, joined to one mesh with a material range per primitive.
struct JoinedModel {
    Mesh mesh;
    glm::dvec3 origin{0.0};  ///< The origin of the positions (mesh_file.h).
    std::vector<ComparedPart> parts;
    bool in_world_space = false;
};

/// Joins the primitives in object space, or with `in_world_space` all their instances in world
/// space. Mesh files are always in world space.
/// \throws InvalidInput if there are no triangles
JoinedModel joined_model(Model model, bool in_world_space);

struct ModelMatchOptions {
    /// The tolerance of positions. Default: 1e-5 of the size of the models, the precision of six
    /// digits, but at least the spacing of floats at their coordinates.
    std::optional<double> position_tolerance;
    /// The tolerance of texture coordinates. Default: 1e-6, times the largest if that is above 1.
    std::optional<double> texcoord_tolerance;
    bool by_texcoord = true;
};

struct ModelComparison {
    JoinedModel a;
    JoinedModel b;
    MatchOptions options;  ///< The tolerances in use.
    CornerMatch match;
    FrameComparison all;
    /// Matched corners with normals, or tangents, in only one of the models.
    std::size_t normals_in_one = 0;
    std::size_t tangents_in_one = 0;

    /// Returns whether no matched corner differs by more than `degrees` or in its sign.
    [[nodiscard]] bool is_within(double degrees) const;
    /// Returns whether each triangle has exactly one possible partner, and all directions could be
    /// compared.
    [[nodiscard]] bool is_complete() const;
    /// Returns whether the models have normals or tangents in common.
    [[nodiscard]] bool has_directions() const;
};

/// Matches the corners of two models and measures the angles between their normals and tangents.
/// Each comparison lists at most 24 of the worst corners.
ModelComparison compare_models(JoinedModel a, JoinedModel b, const ModelMatchOptions& options = {});

}  // namespace relief
