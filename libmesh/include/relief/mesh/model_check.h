// SPDX-License-Identifier: Apache-2.0
/// \file
/// Checks whole models: diagnoses each part, identifies the method of its tangents, and separates
/// problems from notes by the use of the part.
/// Tests: tests/tools/relief_mesh_check_test.cpp.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/diagnose.h"
#include "relief/mesh/model.h"
#include "relief/mesh/report.h"
#include "relief/mesh/tangents.h"

namespace RELIEF_API relief {

/// The result of identifying the tangents of a primitive.
struct CheckedTangents {
    IdentifiedTangents identified;
    int texcoord_set = 0;       ///< The set that the tangents match, or else `usual_set`.
    int usual_set = 0;          ///< The set that glTF assigns to the tangents.
    bool has_normals = true;    ///< Without normals, glTF ignores tangents.
    bool has_texcoords = true;  ///< Without them, no method can be compared.
};

/// A triangle primitive of a glTF file, or the mesh of another file.
struct CheckedPart {
    std::string name;  ///< Empty for a file with one mesh.
    std::size_t triangles = 0;
    std::size_t vertices = 0;
    Diagnosis diagnosis;
    Report problems;
    Report notes;
    std::optional<CheckedTangents> tangents;  ///< Absent if the primitive has no tangents.
};

struct CheckedModel {
    /// Findings of the reader. Missing references are problems; content that relief does not use
    /// (points, lines, foreign properties) is a note.
    Report reading_problems;
    Report reading_notes;
    std::vector<CheckedPart> parts;

    /// Returns whether there is no problem.
    [[nodiscard]] bool is_sound() const;
};

/// Checks a model.
///
/// The severities are those of diagnose.h with two exceptions. With `for_baking`, overlapping
/// texture coordinates are a problem. Triangles without texture gradient are only a note if nothing
/// needs tangents: no baking, no normal or bump map in the materials, and no stored tangents.
///
/// \param reading  the report of the reader of the model
/// \throws InvalidInput if a mesh is not valid
CheckedModel check_model(const Model& model, const Report& reading, bool for_baking);

}  // namespace relief
