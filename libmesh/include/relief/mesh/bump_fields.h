// SPDX-License-Identifier: Apache-2.0
/// \file
/// Height maps as they come from files, whose true normals are known: what the choice of a kernel
/// is judged by. Tests: tests/mesh/accuracy/bump_fields_test.cpp.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "relief/mesh/analytic_heights.h"
#include "relief/mesh/bump.h"

namespace relief {

/// What a field looks like before it is stored.
enum class FieldShape {
    waves,     ///< A sum of waves of all directions; tiles.
    open,      ///< The same, not tiling: clamped.
    domes,     ///< Round bumps on a plane, smooth at their rims; tiles.
    creases,   ///< Roofs: straight slopes that meet in sharp ridges; tiles.
    terraces,  ///< Level ground at several heights, walls between: real cliffs; tiles.
    mixed,     ///< Waves that are long on the left and short on the right; tiles.
};

/// How a field is stored.
enum class FieldCoding {
    float32,
    float16,      ///< Half floats.
    bits16,       ///< Over the whole range of codes.
    bits8,        ///< The same.
    bits8_in_16,  ///< Codes of 8 bits times 257.
    bits8_dim,    ///< Codes 100 to 124 only.
};

struct FieldRecipe {
    const char* name = "";
    FieldShape shape = FieldShape::waves;
    double shortest = 32.0;  ///< Wavelength, or size of what there is, in texels; half the
                             ///< side at most.
    double rms_slope = 0.3;  ///< Of the shape; of terraces, the height of a wall in texels / 4.
    FieldCoding coding = FieldCoding::float32;
    double noise = 0.0;  ///< Its deviation before storing, in texels.
    std::uint32_t seed = 1;
};

/// A height map and the truth about it.
struct BumpField {
    Image heights;                    ///< One channel as a file has it.
    BumpOptions options;              ///< Strength and wrap that belong to it.
    std::vector<glm::dvec3> normals;  ///< Unit, y up; of terraces, those of the level ground.
};

/// \throws InvalidInput if a size is below 8
BumpField make_bump_field(const FieldRecipe& recipe, int width, int height);

/// Fields that methods may be tuned on: every shape, coding, several noises and slopes.
std::span<const FieldRecipe> tuning_fields();

/// Fields that nothing has been tuned on, for judging.
std::span<const FieldRecipe> judging_fields();

/// How far normals of the field are from the truth, in degrees.
DirectionError field_error(const Image& normals, const BumpField& field);

}  // namespace relief
