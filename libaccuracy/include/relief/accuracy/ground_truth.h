// SPDX-License-Identifier: Apache-2.0
/// \file
/// Generates height fields and meshes whose exact normals and tangents are known: the ground truth
/// for the errors of derivative kernels, normals and tangents.
/// Tests: tests/accuracy/ground_truth_test.cpp, tests/accuracy/measure_bump_test.cpp.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/image.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/statistics.h"

namespace RELIEF_API relief {
namespace accuracy {

/// The height amplitude * sin(dot(frequency, (x, y)) + phase); x points right and y down, both in
/// texels.
struct HeightWave {
    double amplitude = 1.0;  ///< In texels.
    glm::dvec2 frequency{};  ///< In radians per texel.
    double phase = 0.0;      ///< In radians.
};

/// A height map and its exact normals.
struct BumpField {
    Image heights;                    ///< One channel, as stored in a file.
    BumpOptions options;              ///< The matching strength and wrap.
    std::vector<glm::dvec3> normals;  ///< Unit, y up; NaN where the surface has none.
};

/// Samples a sum of waves at the texel centers (x, y) = (0, 0), (1, 0), ... The heights are floats
/// in texels, which have a strength of 1; the wrap is not set. \throws InvalidInput if a size is
/// not positive
BumpField wave_heights(int width, int height, std::span<const HeightWave> waves);

/// Creates waves whose sum tiles: a whole number of periods of each wave fits into width and
/// height.
///
/// \param shortest  in texels; wavelengths lie between this and the longer side
/// \param rms_slope  RMS slope of the sum if all frequencies differ; each wave has the same share.
///         Waves of equal frequency interfere, and the RMS slope of the sum differs
/// \param seed  determines directions, lengths and phases; the same seed gives the same waves on
///         every machine
/// \throws InvalidInput if a size or the count is not positive, or if no wave that tiles is at
///         least `shortest` texels long
std::vector<HeightWave> tiling_waves(int width, int height, int count, double shortest,
                                     double rms_slope, std::uint32_t seed);

/// Heights as integer codes.
struct CodedHeights {
    Image codes;            ///< One channel of 8 or 16 bits.
    double strength = 0.0;  ///< The height of the maximum code above code 0, in texels.
};
/// Quantizes heights: the minimum becomes code 0, the maximum becomes the maximum code, and other
/// heights are rounded to the nearest code.
/// \throws InvalidInput if the field is empty or not one float channel, or bits is not 8 or 16
CodedHeights coded_heights(const Image& heights, int bits);

/// Computes the angles between normals and the exact normals of a field, in degrees. Texels for
/// which the field has no normal do not count.
///
/// \param normals  three float channels, of the same size
/// \param margin  width of the border that is ignored, in texels
/// \throws InvalidInput if the sizes differ
ErrorStats normal_error(const Image& normals, const BumpField& field, int margin = 0);

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

/// Generates a field. Terraces have the normals of their flat ground, and none beside walls.
/// \throws InvalidInput if a size is below 8
BumpField make_bump_field(const FieldRecipe& recipe, int width, int height);

/// Fields for tuning methods: all shapes and codings, with several noise levels and slopes.
std::span<const FieldRecipe> tuning_fields();

/// Fields for evaluation, which are never used for tuning.
std::span<const FieldRecipe> evaluation_fields();

/// Surfaces whose normals and tangents are known in closed form.
enum class AnalyticSurface {
    sphere,     ///< Radius 1; open at both poles.
    torus,      ///< Radii 1 and 0.4.
    ellipsoid,  ///< Semi-axes 1, 0.7 and 0.4; open at both poles.
    saddle,     ///< z = 0.5 (x^2 - y^2) over [-1,1]^2.
    cubic,      ///< z = a cubic polynomial in x and y with random coefficients, over [-1,1]^2.
};

/// The triangulation of the parameter domain. Each cell has two triangles. The diagonal is random
/// if the points are random.
enum class Triangulation {
    regular,      ///< A square grid.
    jittered,     ///< Random offsets of up to 0.24 cells; no triangle is inverted.
    anisotropic,  ///< Jittered; cells are 16 times as long as wide.
    folded,       ///< Random offsets of up to 0.6 cells; some triangles are inverted.
};

/// A mesh and its exact normals.
struct AnalyticMesh {
    Mesh mesh;                        ///< Positions and triangles, without duplicate vertices.
    std::vector<glm::dvec3> normals;  ///< Unit; at the positions before rounding to float.
    /// 1 for vertices that triangles surround completely, else 0.
    std::vector<unsigned char> inner;
};

/// Triangulates a surface.
///
/// \param cells  along each parameter, at least 4; anisotropic meshes have 4 times as many along
///         one parameter and a quarter along the other
/// \param seed  of all random numbers; the same seed gives the same mesh on every machine
AnalyticMesh analytic_mesh(AnalyticSurface surface, Triangulation triangulation, int cells,
                           std::uint32_t seed);

/// A point of an exact surface.
struct ExactPoint {
    glm::dvec3 position;
    glm::dvec3 normal;  ///< Unit.
};

/// Returns a function that finds the point of the exact surface nearest to a point. The surface is
/// the whole sphere, ellipsoid or polynomial, beyond the boundaries of analytic_mesh().
///
/// \param seed  that of the mesh
/// \return for a point whose distance from the surface is well below the radii of curvature there;
///         far points may get another point of the surface. Positions have an error of about 1e-12
std::function<ExactPoint(const glm::dvec3& position)> nearest_on_surface(AnalyticSurface surface,
                                                                         std::uint32_t seed);

/// Creates the experiment of [Max 1999]: a closed fan around a vertex at the origin of a cubic
/// surface z(x, y), with `valence` neighbors on the surface at random directions and distances. The
/// exact normal of the vertex is (0,0,1).
Mesh cubic_fan(int valence, std::uint32_t seed);

/// The mapping of an image onto a surface. The first parameter runs from left to right, the second
/// one from bottom to top.
enum class TextureLayout {
    upright,   ///< u is the first parameter, v is 1 minus the second one.
    sheared,   ///< v also increases along the first parameter, half as fast as u.
    mirrored,  ///< Two copies side by side: u increases up to the middle and then decreases.
};

/// The tangent frame of the exact surface.
struct SurfaceFrame {
    glm::dvec3 normal;   ///< Unit.
    glm::dvec3 tangent;  ///< Unit, perpendicular to the normal; u increases along it at constant v.
    double handedness;   ///< 1 or -1; its product with cross(normal, tangent) points towards
                         ///< decreasing v.
};

/// A textured mesh and the exact frames of its surface.
struct TexturedMesh {
    Mesh mesh;  ///< Positions, exact normals, texture coordinates and triangles.
    /// The surface parameters of each vertex. Inside of a triangle, interpolate them in the same
    /// way as the texture coordinates.
    std::vector<glm::dvec2> parameters;
    std::vector<unsigned char> inner;  ///< 1 for vertices away from borders and seams, else 0.
    /// Returns the exact frame at parameters inside of a triangle. On the line between an image and
    /// its mirror image, this is the frame of the right side.
    std::function<SurfaceFrame(const glm::dvec2& parameters)> frame_at;
};

/// Like analytic_mesh(), with texture coordinates. Closed surfaces have a seam: vertices at the
/// same position with different texture coordinates.
///
/// \param cells  as in analytic_mesh(); even for TextureLayout::mirrored, so that the images meet
///         along edges
TexturedMesh textured_mesh(AnalyticSurface surface, Triangulation triangulation,
                           TextureLayout layout, int cells, std::uint32_t seed);

/// Creates the square [-1,1]^2 that faces +z, as two triangles, with bevels around it that slope
/// down at 45 degrees. All normals of the square are (0,0,1), as in game models. The image is
/// upright on the square and continues over the bevels with a shear of 45 degrees.
///
/// \param width  of the bevels, above 0
/// \return a mesh in which the vertices of the square are the inner ones, the parameters are x and
///         y, and the exact frames are those of the square
TexturedMesh beveled_plate(double width);

}  // namespace accuracy
}  // namespace relief
