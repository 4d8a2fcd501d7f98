// SPDX-License-Identifier: Apache-2.0
/// \file
/// The parts of experiments on meshes and maps that asset reports, other experiments, benchmarks
/// and tests use as well; and the values that experiments iterate over, with their names in
/// reports.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "experiment_driver.h"
#include "relief/accuracy/asset.h"
#include "relief/accuracy/bake_accuracy.h"
#include "relief/accuracy/experiment.h"
#include "relief/accuracy/ground_truth.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/image.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/normals.h"
#include "relief/mesh/statistics.h"

namespace relief::accuracy::detail {

inline constexpr std::array all_surfaces = {AnalyticSurface::sphere, AnalyticSurface::torus,
                                            AnalyticSurface::ellipsoid, AnalyticSurface::saddle,
                                            AnalyticSurface::cubic};
inline constexpr std::array all_triangulations = {Triangulation::regular, Triangulation::jittered,
                                                  Triangulation::anisotropic,
                                                  Triangulation::folded};
inline constexpr std::array both_arithmetics = {Arithmetic::float64, Arithmetic::float32};

/// The sample format of a map: "16 bit", "float".
inline std::string depth_name(int bits) {
    return bits == 32 ? "float" : std::to_string(bits) + " bit";
}

inline std::string name_of(AnalyticSurface surface) {
    constexpr std::array names = {"sphere", "torus", "ellipsoid", "saddle", "cubic"};
    return names.at(static_cast<std::size_t>(surface));
}

inline std::string name_of(Triangulation triangulation) {
    constexpr std::array names = {"regular", "jittered", "anisotropic", "folded"};
    return names.at(static_cast<std::size_t>(triangulation));
}

/// The angle between two directions in degrees, for lists of errors.
inline float angle_of(const glm::dvec3& actual, const glm::dvec3& expected) {
    return static_cast<float>(degrees_between(actual, expected));
}

// Vertex normals: every weighting on analytic surfaces and on the fans of [Max 1999].

/// Weightings by their names in relief-mesh; without a weight, it is chosen per vertex.
using NormalWeighting = EnumName<std::optional<NormalWeight>>;
std::vector<NormalWeighting> normal_weightings();

/// Computes one normal per position.
std::vector<glm::vec3> normals_by(std::optional<NormalWeight> weight, Arithmetic arithmetic,
                                  const Mesh& mesh);

/// A method for the vertex normals of a mesh: "max, float64". Its first choice is the weighting.
using NormalMethod = MethodOn<Mesh, std::vector<glm::vec3>>;

/// All weightings, each in the given arithmetics.
std::vector<NormalMethod> normal_methods(std::span<const Arithmetic> arithmetics);

/// The angles between normals and those of the surface, at the inner vertices of the mesh.
/// \param normals  one per position of the mesh
ErrorStats normal_errors(std::span<const glm::vec3> normals, const AnalyticMesh& ground_truth);

/// The angles at the center vertices of random fans (cubic_fan() with seeds 0 to `fans` - 1).
ErrorStats fan_errors(const NormalMethod& method, int valence, std::uint32_t fans);

// Normals from height maps: every kernel in both arithmetics, on waves and fields whose normals are
// known in closed form.

/// All kernels in float64; Gaussians of radius 2, 4, 8 and 16 come last.
std::span<const BumpMethod> kernel_methods();

/// The name of a kernel: "sobel3", "gaussian 4".
std::string name_of(Kernel kernel, int gaussian_radius);

BumpOptions options_of(const BumpMethod& method, BumpOptions options);

/// The unrounded normals of heights, without smoothing of steps.
Image normals_by(const BumpMethod& method, const Image& heights, const BumpOptions& options);

/// The complete conversion of a map, as it is timed. \param result  its memory is used again
void convert_by(const BumpMethod& method, const Image& heights, const BumpOptions& options,
                Image& result);

/// The RMS error in degrees of the unrounded normals in double precision. Texels without a defined
/// ground truth do not count.
double rms_error(const BumpField& field, Kernel kernel, int gaussian_radius);

/// A field from one of the sets of ground_truth.h. \throws InvalidInput if none has that name
const FieldRecipe& field_recipe(const std::string& name);

/// Texels along each border that are not compared, because kernels need heights beyond the border.
inline constexpr int wave_margin = 16;

/// Makes a wave of slope 1 that runs two texels to the right for one down, a direction that favors
/// no kernel.
///
/// \param bits  of the heights: 8, 16, or 32 for floats
BumpField oblique_wave(int side, double wavelength, int bits);

/// The errors of the unrounded normals of a wave map.
ErrorStats wave_errors(const BumpField& wave, const BumpMethod& method);

/// The same surface at several resolutions: waves that tile a square of `side` texels.
BumpField surface_at(int side);

/// A method named "scharr3, float32, 16 bit", with its choices and the bytes of a texel, but
/// without functions.
Method described(const BumpMethod& method);

// Baking: a sphere with bumps in closed form is baked onto a coarse sphere with several numbers of
// rays per texel and several bit depths.

/// A sphere with bumps in closed form, and a mesh of it.
class BumpySphere {
  public:
    /// Makes a mesh of 4 stacks^2 triangles with the positions and normals of the formula.
    explicit BumpySphere(int stacks);

    [[nodiscard]] const Mesh& mesh() const { return mesh_; }

    /// Intersects a ray that points roughly towards the center with the exact surface.
    /// \param inward  unit
    [[nodiscard]] static ExactPoint on_surface(const glm::dvec3& from, const glm::dvec3& inward);

    /// Intersects such a ray with the mesh, in double; the normal is interpolated. Only triangles
    /// near the exact intersection are tried.
    /// \throws std::logic_error if the ray hits none of them
    [[nodiscard]] ExactPoint on_mesh(const glm::dvec3& from, const glm::dvec3& inward) const;

  private:
    int stacks_;
    Mesh mesh_;
};

/// The normals of a whole map, three float channels, and the number of their rays.
struct WholeBake {
    Image normals;
    std::size_t rays = 0;
};
WholeBake whole_bake(const Baker& baker, const BakeMapOptions& map);

/// Bakes by several samplings, each in several formats.
class TimedBakes {
  public:
    TimedBakes(std::shared_ptr<const BakeReference> reference,
               std::span<const BakeSampling> samplings, std::vector<NormalMapFormat> formats);

    [[nodiscard]] const BakeReference& reference() const { return *reference_; }
    [[nodiscard]] const std::vector<BakeSampling>& samplings() const { return samplings_; }
    [[nodiscard]] const std::vector<NormalMapFormat>& formats() const { return formats_; }

    /// The errors of a sampling in all formats; the rays are cast once.
    const std::vector<MeasuredBake>& result(std::size_t sampling);

    /// Seconds for casting rays and encoding together. One cast serves a round of all formats; the
    /// cast of result() serves the first round on as many threads.
    double seconds_of_round(std::size_t sampling, std::size_t format);

  private:
    struct Bake {
        std::vector<MeasuredBake> by_format;
        std::vector<bool> is_format_used;
        std::size_t threads = 0;
    };
    void cast(std::size_t sampling);

    std::shared_ptr<const BakeReference> reference_;
    std::vector<BakeSampling> samplings_;
    std::vector<NormalMapFormat> formats_;
    std::vector<std::optional<Bake>> bakes_;
};

/// A method for each sampling and format, in this order. Times are those of a wall clock.
/// \param described  returns the method without its error and work
std::vector<Method> methods_of(
    const std::shared_ptr<TimedBakes>& bakes,
    const std::function<Method(const BakeSampling&, const NormalMapFormat&)>& described);

std::string name_of(const BakeSampling& way);  ///< "16 rays", "up to 64 rays beyond 2°"

/// The high and the low mesh, ready for ray casting, and the ground truth of their map.
class BumpyBake {
  public:
    static constexpr int low_slices = 46;
    static constexpr int low_stacks = 23;

    /// \param side  width and height of the map in texels
    BumpyBake(int high_stacks, int side);

    [[nodiscard]] const Baker& baker() const { return baker_; }
    [[nodiscard]] const BakeMapOptions& map() const { return map_; }
    [[nodiscard]] const BakeReference& reference() const { return reference_; }
    [[nodiscard]] std::string description() const;  ///< Of the meshes and the map.

    /// Bakes a map.
    [[nodiscard]] Image map_by(const BakeSampling& way, const NormalMapFormat& format) const;
    [[nodiscard]] const BumpySphere& high() const { return high_; }

  private:
    BumpySphere high_;
    Report report_;
    Baker baker_;
    BakeMapOptions map_;
    BakeReference reference_;
};

// Stability: sweeps over a growing quantity, hard inputs (degenerate triangles, needles), and
// textbook code without guards, which is measured for contrast with the library.

/// A quantity that grows from 10^0 by 10^step to 10^decades.
struct Sweep {
    std::string id;  ///< Of its chart.
    std::string title;
    std::string x_label;
    int decades = 0;
    int step = 1;
    /// The angular errors of a method at a value, in degrees; NaN where a direction is undefined.
    std::function<std::vector<float>(std::size_t method, double value)> errors{};
};

/// The errors of several methods in sweeps.
struct SweptErrors {
    std::vector<ErrorStats> errors;  ///< Of each method in all sweeps together.
    std::vector<Chart> charts;       ///< One per sweep.
    /// "Larger (...): plain area fails from 1e+18 on, all others are within the limit." for each
    /// chart.
    std::string breaks;
};

/// \param bound  limit of the RMS error in degrees; a method fails where it exceeds this
SweptErrors measured_sweeps(const std::vector<std::string>& methods, double bound,
                            const std::vector<Sweep>& sweeps);

/// Kinds of triangles that a mesh can have without a change of its surface.
enum class HardTriangle {
    collapsed,   ///< Refers to one vertex twice.
    coinciding,  ///< Has two corners at the same position.
    needle,      ///< Has its third corner at the middle of an edge, up to rounding.
    nowhere,     ///< Has a corner that is not a number.
    back,        ///< Lies on another triangle with the opposite orientation.
};

struct HardTriangleName {
    HardTriangle kind;
    const char* id;
    const char* title;
};
inline constexpr std::array hard_triangle_names = {
    HardTriangleName{HardTriangle::collapsed, "collapsed",
                     "Triangles that refer to a vertex twice"},
    HardTriangleName{HardTriangle::coinciding, "coinciding",
                     "Triangles with two corners at the same position"},
    HardTriangleName{HardTriangle::needle, "needle", "Needles along an edge"},
    HardTriangleName{HardTriangle::nowhere, "nowhere", "Triangles with a corner that is NaN"},
    HardTriangleName{HardTriangle::back, "back", "Triangles with another one on their back side"},
};

/// Adds `count` hard triangles, spread evenly over the mesh; with HardTriangle::back at most one
/// per triangle. The vertices and triangles of the mesh keep their indices. The result has only
/// positions and triangles.
Mesh with_hard_triangles(const Mesh& mesh, HardTriangle kind, std::size_t count);

/// Makes separate needle-shaped triangles without cancellation in their exact normals: two corners
/// lie within twice the width of the origin, where floats are fine enough, and the third corner
/// lies at a distance of 1.
///
/// \param width  length of the short side, which is perpendicular to the long ones. The first
///         corner alternates between the three.
AnalyticMesh make_needles(std::size_t count, double width, std::uint32_t seed);

/// Textbook code: normalizes the sum of cross products around each vertex; 0 / 0 gives NaN.
std::vector<glm::vec3> textbook_area_normals(const Mesh& mesh);

/// Textbook code: normalizes the sum of unit normals weighted by the arc cosines of corner angles.
std::vector<glm::vec3> textbook_angle_normals(const Mesh& mesh);

/// Textbook code, [Lengyel 2001] as printed: averages tangents over all triangles of a vertex.
/// \return three tangents per triangle
std::vector<glm::vec4> textbook_tangents(const Mesh& mesh);

/// Textbook code: Sobel differences of 3 x 3 heights, then (-dh/dx, -dh/dy, 1) normalized, y up;
/// the border is (0, 0, 1).
/// \param height  one float channel
Image textbook_sobel_normals(const Image& height, float strength);

// Errors of normal maps (angles per texel) and of images (FLIP and PSNR) against a ground truth.

/// The normals of three float channels, row by row.
std::vector<glm::dvec3> directions_of(const Image& normals);

/// Computes the angle between each texel and the ground truth, in degrees.
///
/// \param normals  three float channels, y up
/// \param ground_truth    one unit normal per texel, row by row from the top
/// \return one float channel; NaN if either direction is undefined
/// \throws InvalidInput if the counts differ
Image angles_of(const Image& normals, std::span<const glm::dvec3> ground_truth);

/// The angles of angles_of() as a list, without those within `margin` texels of the border and
/// those without ground truth.
std::vector<float> inner_angles(const Image& normals, std::span<const glm::dvec3> ground_truth,
                                int margin);

/// Statistics of inner_angles().
ErrorStats map_errors(const Image& normals, std::span<const glm::dvec3> ground_truth,
                      int margin = 0);

struct PictureError {
    ErrorStats
        figures;  ///< FLIP per pixel, 0 to 1; psnr is of sRGB codes, infinite if all are equal.
    Image map;    ///< FLIP per pixel: one float channel.
};

/// Compares an image with a reference that is rounded to 8-bit sRGB as well.
///
/// \param ground_truth    three float channels, linear light
/// \param picture  8-bit sRGB, three channels
/// \throws InvalidInput if sizes or channels differ
PictureError picture_error(const Image& ground_truth, const Image& picture);

/// Averages squares of `side` x `side` pixels in linear light.
///
/// \param linear  float channels; width and height are multiples of `side`
/// \param side    at least 1
Image averaged(const Image& linear, int side);

// Tangent methods, the basis that a fragment shader makes of their tangents, and the errors of both
// on textured analytic surfaces.

/// Three tangents per triangle; empty if the shader derives its frame.
using CornerTangents = std::vector<glm::vec4>;

/// The basis that a fragment shader computes from interpolated vectors.
enum class ShaderBasis {
    as_interpolated,  ///< Without normalization, as in shaders/tangent_frame.glsl#stored.
    made_unit,        ///< Normalizes normal and tangent first, as many shaders do.
    derived,          ///< From screen-space derivatives: shaders/tangent_frame.glsl#derivatives.
};

/// The tangents of a mesh, and their use by a fragment shader.
struct TangentFrames {
    CornerTangents tangents{};
    ShaderBasis basis = ShaderBasis::as_interpolated;
};

/// A point in a triangle.
struct Sample {
    std::uint32_t triangle = 0;
    glm::dvec3 barycentric{1.0 / 3.0};
};

/// The middle of a triangle, and a point near each corner.
std::array<Sample, 4> samples_in(std::uint32_t triangle);

/// samples_in() of each triangle whose three vertices are inner vertices.
std::vector<Sample> samples_of(const TexturedMesh& ground_truth);

/// Tangent, bitangent and normal as columns.
glm::dmat3 basis_at(const Mesh& mesh, const TangentFrames& frames, const Sample& sample);

glm::dmat3 exact_basis_at(const TexturedMesh& ground_truth, const Sample& sample);

/// The exact tangents of the surface, rounded to float: the best that a method can compute.
CornerTangents exact_tangents(const TexturedMesh& ground_truth);

/// A method for tangent frames. Its choices are the tangents and the basis of the shader.
using FrameMethod = MethodOn<Mesh, TangentFrames>;

/// mikktspace, area-weighted, lengyel, and the derived frames of screen-space, which have no work.
std::vector<FrameMethod> tangent_methods();

/// The same method with a shader that normalizes normal and tangent.
FrameMethod made_unit(const FrameMethod& method);

/// Texels tilted by 30 degrees to the right, left, up and down.
inline constexpr std::array<glm::dvec3, 4> tilted_texels = {
    glm::dvec3(0.5, 0.0, 0.8660254037844386), glm::dvec3(-0.5, 0.0, 0.8660254037844386),
    glm::dvec3(0.0, 0.5, 0.8660254037844386), glm::dvec3(0.0, -0.5, 0.8660254037844386)};

/// Adds the angles between the normals of tilted texels in two bases.
void add_texel_angles(std::vector<float>& degrees, const glm::dmat3& actual,
                      const glm::dmat3& expected);

/// The errors of the normals of tilted texels inside the triangles, in degrees.
ErrorStats texel_errors(const TexturedMesh& ground_truth, const TangentFrames& frames);

/// The errors of tangents inside the triangles.
ErrorStats inner_tangent_errors(const TexturedMesh& ground_truth, const TangentFrames& frames);

/// The angles between tangents and the exact ones at the corners of inner vertices.
std::vector<float> corner_tangent_angles(const TexturedMesh& ground_truth,
                                         const CornerTangents& tangents);

/// The errors of tilted normals that are baked without rounding in one basis and read in another.
ErrorStats mismatch_errors(const TexturedMesh& ground_truth, const FrameMethod& baker,
                           const FrameMethod& reader);

struct TexturedCase {
    std::string id;    ///< "torus-jittered-mirrored"
    std::string name;  ///< "torus, jittered, image mirrored"
    /// Absent if the case has no cells to refine.
    std::optional<Triangulation> triangulation{};
    bool is_quick = false;  ///< Whether quick runs include the case.
    std::function<TexturedMesh(int cells)> mesh;
};

/// Every surface with regular, jittered and anisotropic cells; the jittered torus with a sheared
/// and with a mirrored texture; and a plate with thin bevels, which has no cells.
std::vector<TexturedCase> textured_cases();

// Decimation: the error of decimated analytic surfaces.

/// A point of a triangle.
struct TriangleSample {
    std::size_t triangle;
    glm::dvec3 position;
    glm::dvec3 normal;  ///< Of the triangle; not unit.
};

/// Returns points of a mesh that are spread evenly over its area, without random numbers.
std::vector<TriangleSample> area_samples(const Mesh& mesh, std::size_t count);

/// The quantity that an error of a decimation measures.
enum class DecimationError {
    distance,  ///< From the exact surface.
    angle,     ///< Between a triangle and the exact surface at the nearest point, in degrees.
};

/// Returns the error of a mesh at area_samples().
/// \param seed  of the surface
ErrorStats surface_errors(const Mesh& mesh, AnalyticSurface surface, std::uint32_t seed,
                          DecimationError kind);

// Unwrapping: how much texture coordinates stretch the surface, and how many texels of the map stay
// unused.

/// A sphere of radius 1 with waves of two lengths, without poles: the six sides of a cube, each of
/// `cells` x `cells` squares. Its texture coordinates are those of the sides, side by side, so that
/// vertices on the edges of the cube exist two or three times.
/// \param noise  standard deviation of the radius at each vertex
Mesh wavy_sphere(int cells, double noise);

/// A flat gear with sharp edges: positions and triangles.
/// \param cells  squares along each flank, and rings of the two flat sides
Mesh gear_wheel(int teeth, int cells);

/// The stretch of texture coordinates in percent, at points that are spread evenly over the
/// surface: how much longer or shorter a short line on the surface becomes in the map at most,
/// compared with the mean density of texels. A triangle without area in the map is undefined.
/// \param corner_texcoords  three for each triangle
ErrorStats stretch_errors(const Mesh& mesh, std::span<const glm::vec2> corner_texcoords,
                          const glm::ivec2& size);

/// Compares the choices that change charts by their stretch.
/// \param mesh  with texture coordinates, existing charts are compared as well
/// \param description  "sphere with waves"
PreparedExperiment unwrapping_stretch(Mesh mesh, const std::string& description, int size);

}  // namespace relief::accuracy::detail
