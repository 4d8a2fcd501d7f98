// SPDX-License-Identifier: Apache-2.0
/// \file
/// Generates height maps like those in files, with exact normals, for tuning and evaluating the
/// choice of a kernel.
/// Tests: tests/mesh/accuracy/bump_experiment_test.cpp.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/analytic_heights.h"
#include "relief/mesh/bump.h"

namespace RELIEF_API relief {

/// The shape of a field before it is stored.
enum class FieldShape {
    waves,     ///< A sum of waves in all directions; tiles.
    open,      ///< The same without tiling, for Wrap::clamp.
    domes,     ///< Round bumps on a plane with smooth rims; tiles.
    creases,   ///< Plane slopes that meet in sharp ridges; tiles.
    terraces,  ///< Flat ground at several heights with vertical walls between; tiles.
    mixed,     ///< Long waves on the left and short ones on the right; tiles.
};

/// The sample format of a field.
enum class FieldCoding {
    float32,
    float16,      ///< Half floats.
    bits16,       ///< Codes over the whole range.
    bits8,        ///< Codes over the whole range.
    bits8_in_16,  ///< Codes of 8 bits times 257.
    bits8_dim,    ///< Codes 100 to 124 only.
};

struct FieldRecipe {
    const char* name = "";
    FieldShape shape = FieldShape::waves;
    /// Minimum wavelength or feature size in texels, at most half of the side.
    double shortest = 32.0;
    /// RMS slope of the shape; for terraces, a quarter of the wall height in texels.
    double rms_slope = 0.3;
    FieldCoding coding = FieldCoding::float32;
    /// Standard deviation of the noise that is added before storing, in texels.
    double noise = 0.0;
    std::uint32_t seed = 1;
};

/// A height map and its exact normals.
struct BumpField {
    Image heights;                    ///< One channel, as stored in a file.
    BumpOptions options;              ///< The matching strength and wrap.
    std::vector<glm::dvec3> normals;  ///< Unit, y up; those of the flat ground for terraces.
};

/// Generates a field. \throws InvalidInput if a size is below 8
BumpField make_bump_field(const FieldRecipe& recipe, int width, int height);

/// Fields for tuning methods: all shapes and codings, with several noise levels and slopes.
std::span<const FieldRecipe> tuning_fields();

/// Fields for evaluation, which are never used for tuning.
std::span<const FieldRecipe> evaluation_fields();

/// Computes the angles between normals and the exact normals of the field, in degrees.
DirectionError field_error(const Image& normals, const BumpField& field);

}  // namespace relief
