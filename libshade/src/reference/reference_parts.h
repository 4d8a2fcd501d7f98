// SPDX-License-Identifier: Apache-2.0
/// \file
/// The parts of the reference renderer, in double precision: lookups in images and environments,
/// rays from the eye, a scene prepared for them, the surface at a hit, and its light. World space,
/// linear light.
///
/// Lookups are those that OpenGL 3.3 (section 3.8) defines at full resolution, straight from the
/// images: bilinear between texel centers or nearest, with all three wrap modes. Colors are decoded
/// from sRGB before they are filtered; (0,0) is the upper left corner, v grows downwards. A
/// coordinate that is not finite looks up NaN. The environment's images are laid out as
/// environment.h says; faces as in environment/environment_images.h.
///
/// Hits have exact positions in view space: the eye is at the origin and looks along -z. The rules
/// of bake/embree_scene.h make the result the same on every processor. The preparation computes
/// everything that no single pixel decides: frames of meshes without frames, vertices in world and
/// view space, decoded textures. Directions are unit, or zero if undefined; the normal of a surface
/// without a direction is (0,0,1), and a map without a direction leaves the interpolated normal.
/// Light follows Material's formula (material.h), term by term.
#pragma once

#include <complex>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "effects/light_rows.h"
#include "environment/convolution.h"
#include "reference/recorder.h"
#include "relief/export.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/height_march.h"
#include "relief/mesh/image.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/report.h"
#include "relief/shade/material.h"
#include "relief/shade/scene.h"

namespace relief::detail {
class EmbreeScene;
}  // namespace relief::detail

namespace relief::shade {
namespace RELIEF_API reference {

// Lookups

class Recorder;

/// The record of a ray on its way to a color: every discrete decision (which texel, which side of a
/// light), and every place in a texture. Rays whose decisions differ may differ by a jump, so that
/// rounding may decide what is seen; places that lie far apart mean a texture that OpenGL averages.
class Trace {
  public:
    Trace() = default;
    /// \param needs_radiance  false for a ray beside a pixel: it makes the same decisions and
    ///                        lookups as any ray, but its radiance is not computed
    /// \param recorder        null, or the recorder of the pixel's terms (recorder.h)
    explicit Trace(bool needs_radiance, Recorder* recorder = nullptr)
        : needs_radiance_(needs_radiance), recorder_(recorder) {}

    [[nodiscard]] bool needs_radiance() const { return needs_radiance_; }
    [[nodiscard]] Recorder* recorder() const { return recorder_; }

    /// Pauses the recording of a trace while it exists.
    class Unrecorded {
      public:
        explicit Unrecorded(Trace& trace) : trace_(trace), recorder_(trace.recorder_) {
            trace_.recorder_ = nullptr;
        }
        ~Unrecorded() { trace_.recorder_ = recorder_; }
        Unrecorded(const Unrecorded&) = delete;
        Unrecorded& operator=(const Unrecorded&) = delete;

      private:
        Trace& trace_;
        Recorder* recorder_;
    };

    void decide(std::int64_t decision) {
        constexpr std::uint64_t fnv_prime = 0x100000001B3ULL;
        hash_ = (hash_ ^ static_cast<std::uint64_t>(decision)) * fnv_prime;
        hash_ ^= hash_ >> 29;
    }

    /// \param texels  the place of a lookup in texels; for a cube map, a direction whose length is
    ///                the number of texels in a radian
    void look_up(const glm::dvec3& texels) { places_.push_back(texels); }

    /// Notes a lookup in a pixel whose own color rounding may decide.
    void doubt() { is_doubtful_ = true; }
    [[nodiscard]] bool is_doubtful() const { return is_doubtful_; }

    [[nodiscard]] bool decided_like(const Trace& other) const {
        return hash_ == other.hash_ && places_.size() == other.places_.size();
    }
    [[nodiscard]] const std::vector<glm::dvec3>& places() const { return places_; }

  private:
    std::uint64_t hash_ = 0xCBF29CE484222325ULL;
    std::vector<glm::dvec3> places_;
    bool is_doubtful_ = false;
    bool needs_radiance_ = true;
    Recorder* recorder_ = nullptr;
};

/// An image as RGBA: gray as (g, g, g, 1), gray with alpha as (g, g, g, a), RGB as (r, g, b, 1).
class Texels {
  public:
    Texels() = default;
    explicit Texels(const Image& image);

    [[nodiscard]] int width() const { return image_.width; }
    [[nodiscard]] int height() const { return image_.height; }

    [[nodiscard]] glm::dvec4 at(int x, int y) const;
    [[nodiscard]] glm::dvec4 bilinear(const glm::dvec2& uv, Wrap u, Wrap v) const;
    [[nodiscard]] glm::dvec4 nearest(const glm::dvec2& uv, Wrap u, Wrap v, Trace& trace) const;

  private:
    Image image_;  ///< Linear float.
};

/// Returns the index within the image of a texel index beyond its border.
int wrapped(double index, int size, Wrap wrap);

/// The images that the materials of a scene look up, decoded once for each use.
class SceneTexels {
  public:
    /// Decodes a material's images. Those that cannot be read are in unreadable().
    /// \throws FileError if an image that is required cannot be read
    void request(const Scene& scene, const Material& material);

    /// Returns the error of each unreadable image, by its index.
    [[nodiscard]] const std::map<std::size_t, std::string>& unreadable() const {
        return unreadable_;
    }

    [[nodiscard]] const Texels& get(std::size_t image, ImageUse use) const {
        return texels_.at({image, use});
    }
    [[nodiscard]] glm::dvec4 look_up(const Texture& texture, ImageUse use, const glm::dvec2& uv,
                                     Trace& trace) const;

  private:
    std::map<std::pair<std::size_t, ImageUse>, Texels> texels_;
    std::map<std::size_t, std::string> unreadable_;
};

class EnvironmentLookup {
  public:
    /// \param report  counts samples that are clamped or not finite (storable_radiance)
    /// \throws FileError if an image cannot be read; InvalidInput if images do not fit together
    EnvironmentLookup(const Environment& environment, Report& report);

    /// \param direction_world  of any length but 0
    [[nodiscard]] glm::dvec3 radiance(const glm::dvec3& direction_world) const;

    /// Returns the same radiance, and records the lookup in a trace.
    [[nodiscard]] glm::dvec3 looked_up(const glm::dvec3& direction_world, Trace& trace) const;

    /// Returns the reflection in a surface whose microfacets have GGX's distribution, with normal
    /// and eye along the direction: the mean over directions l, mirrored at normals h that are
    /// sampled from the distribution, weighted by n.l.
    /// \param roughness  0 is a mirror
    [[nodiscard]] glm::dvec3 blurred(const glm::dvec3& direction_world, double roughness,
                                     Trace& trace) const;

    /// Returns the irradiance over pi on a surface of this normal, by spherical harmonics of order
    /// 2 [Ramamoorthi and Hanrahan 2001]; 0 if their sum is negative.
    [[nodiscard]] glm::dvec3 diffuse(const glm::dvec3& normal_world) const;

  private:
    enum class Layout { faces, equirectangular, angular };

    /// Rotates a direction into the map.
    [[nodiscard]] glm::dvec3 in_map(const glm::dvec3& direction_world) const;
    [[nodiscard]] glm::dvec3 map_radiance(const glm::dvec3& direction_map) const;
    [[nodiscard]] glm::dvec3 face_texel(std::size_t face, int x, int y) const;
    [[nodiscard]] glm::dvec3 face_radiance(const glm::dvec3& direction) const;
    [[nodiscard]] std::vector<Image> faces() const;
    [[nodiscard]] glm::dvec3 texel_mean(std::size_t face, int x, int y, int size) const;

    Layout layout_ = Layout::faces;
    double intensity_ = 1.0;
    glm::dvec2 turn_{1.0, 0.0};          ///< The cosine and the sine of the rotation.
    std::vector<Texels> images_;         ///< Six faces, or one image.
    detail::IrradianceSh irradiance_{};  ///< Multiplied by the intensity.
};

/// The picture behind transmissive surfaces, as Material says, with its mip levels: a texel of each
/// further level is the bilinear mean at its center in the level before.
class PictureBehind {
  public:
    struct Level {
        int width = 0;
        int height = 0;
        std::vector<glm::dvec4> texels;  ///< Radiance times coverage, and coverage; row 0 on top.

        /// \param place  from 0 to 1, y downwards
        [[nodiscard]] glm::dvec4 bilinear(const glm::dvec2& place) const;
    };

    /// \param edges  1 for each pixel whose color rounding may decide
    PictureBehind(const Scene& scene, Level picture, std::vector<std::uint8_t> edges);

    /// Returns the radiance around the projection of a point, or of the alternative if the point is
    /// not in front of the eye.
    /// \param blur  from 0, none, to 1, the last level
    [[nodiscard]] glm::dvec3 look_up(const glm::dvec3& position_world,
                                     const glm::dvec3& alternative_world, double blur,
                                     Trace& trace) const;

  private:
    [[nodiscard]] std::optional<glm::dvec2> place_of(const glm::dvec3& position_world) const;
    [[nodiscard]] bool touches_edge(const glm::dvec2& place) const;

    glm::dmat4 view_from_world_;
    glm::dvec2 half_size_;  ///< Of the picture, as half_height() defines it.
    bool is_orthographic_;
    glm::dvec3 background_;
    std::vector<Level> levels_;
    std::vector<std::uint8_t> edges_;
};

/// Returns GGX's directional albedo: x multiplies f0, y is added (environment/convolution.h).
glm::dvec2 directional_albedo(double n_dot_v, double roughness);

// Rays from the eye

/// Triangles of one instance; both spans must outlive their use.
struct ViewMesh {
    std::span<const glm::dvec3> positions_view;
    std::span<const glm::uvec3> triangles;
};

struct Hit {
    std::uint32_t instance = 0;
    std::uint32_t triangle = 0;
    double depth = 0.0;             ///< Distance along -z.
    glm::dvec3 barycentric{0.0};    ///< On the triangle itself, correct for perspective.
    bool counter_clockwise = true;  ///< As the eye sees it.
};

class Visibility {
  public:
    /// \param camera  its projection, and the depth range of hits
    Visibility(std::vector<ViewMesh> meshes, const Camera& camera);
    ~Visibility();
    Visibility(const Visibility&) = delete;
    Visibility& operator=(const Visibility&) = delete;

    /// Returns all hits of the ray through (x, y, -1), nearest first. It begins at the origin, or,
    /// if the camera is orthographic, at (x, y, 0). If the ray hits an edge or a vertex that
    /// triangles of an instance share, only the nearest of them is a hit; ties: the first one.
    [[nodiscard]] std::vector<Hit> hits(double x, double y) const;

  private:
    [[nodiscard]] bool shares_place(const Hit& a, const Hit& b) const;
    [[nodiscard]] bool is_repeated(const std::vector<Hit>& all, std::size_t index) const;

    std::vector<ViewMesh> meshes_;
    double near_;
    double far_;
    bool is_orthographic_;
    std::unique_ptr<relief::detail::EmbreeScene> embree_;
};

/// Triangles of all instances in world space, for the shadow of the main light.
class ShadowCasters {
  public:
    /// \param meshes  their positions are in world space
    ShadowCasters(detail::ShadowView view, std::vector<ViewMesh> meshes);
    ~ShadowCasters();

    /// Returns the triangles between a position and a point of the light, with their weights.
    [[nodiscard]] std::vector<Hit> between(const glm::dvec3& position_world,
                                           const glm::dvec2& point) const;

    [[nodiscard]] const detail::ShadowView& view() const { return view_; }

  private:
    detail::ShadowView view_;
    std::unique_ptr<relief::detail::EmbreeScene> embree_;
};

// Prepared scenes and surfaces

/// One instance of a mesh, by vertex.
struct PreparedInstance {
    const Mesh* mesh = nullptr;  ///< With normals, and with tangents if something needs them.
    std::vector<glm::dvec3> positions_world;
    std::vector<glm::dvec3> positions_view;
    std::vector<glm::dvec3> normals_world;
    std::vector<glm::dvec4> tangents_world;    ///< Empty if the mesh has none.
    glm::dmat3 world_from_object_normal{1.0};  ///< Up to a positive factor.
    bool mirrors = false;                      ///< The matrix reverses the winding of triangles.
    std::vector<float> open_shares{};          ///< Empty if all light arrives.
};

struct PreparedScene {
    /// \throws InvalidInput, FileError as render_reference does
    PreparedScene(const Scene& scene, Report& report);

    [[nodiscard]] const Material& material_of(std::uint32_t instance, std::uint32_t triangle) const;
    /// Returns the relief of a triangle; null if it has none.
    [[nodiscard]] const HeightField* relief_of(std::uint32_t instance,
                                               std::uint32_t triangle) const;
    /// Returns the index of the range in its mesh.
    [[nodiscard]] std::size_t range_of(std::uint32_t instance, std::uint32_t triangle) const;
    [[nodiscard]] FlatCode flat_code(const NormalMap& map) const;

    const Scene& scene;
    std::vector<Material> materials;  ///< Without the textures that cannot be read.
    glm::dvec4
        eye_world;  ///< Homogeneous: the position, or the direction to an orthographic camera.
    std::vector<FramedMesh> meshes;    ///< At rest.
    std::deque<Mesh> deformed_meshes;  ///< Of the instances that a pose deforms.
    std::vector<PreparedInstance> instances;
    SceneTexels texels;
    std::map<std::size_t, FlatCode> detected_flat_codes;  ///< By image.
    std::map<std::size_t, int> normal_map_bits;           ///< By image.
    std::optional<EnvironmentLookup> environment;
    std::map<float, detail::SheenAlbedo> sheen_albedos;  ///< By sheen roughness.
    std::optional<PictureBehind> behind;                 ///< If a surface is transmissive.
    std::unique_ptr<ShadowCasters> shadow;               ///< If a light casts one.
    /// The reliefs of the materials, by their index.
    std::map<std::uint32_t, HeightField> reliefs;
    std::map<float, detail::SheenAlbedos> sheen_tables;  ///< The same, if a texture multiplies it.
};

/// Where the view meets a relief, and the frame of its texels on the triangle.
struct ReliefHit {
    const HeightField* field = nullptr;
    double black_depth = 0.0;          ///< In texels.
    glm::dvec2 texcoord_surface{0.0};  ///< Of the surface above it.
    glm::dvec2 texcoord{0.0};
    glm::dvec3 outward_world{0.0};  ///< Against the ray: the vector to the eye or to the light.
    /// How far the point is beyond that of the surface: a multiple of that vector.
    double beyond = 0.0;
    glm::dvec3 normal_world{0.0};   ///< Of the surface, as interpolated; unit.
    glm::dvec3 along_x_world{0.0};  ///< The edges of a texel.
    glm::dvec3 along_y_world{0.0};
    double texel_world = 0.0;     ///< The square root of its area.
    HeightCurvature curvature;    ///< Zero unless the material's relief curves with the surface.
    bool leaves_surface = false;  ///< The view leaves the curved relief: nothing is drawn.
};

/// Interpolated attributes at a hit, and the normal: interpolated or of the plane, bent by a normal
/// or bump map.
struct Surface {
    glm::dvec3 position_world{0.0};
    glm::dvec3 normal_world{0.0, 0.0, 1.0};       ///< Unit, on the visible side.
    glm::dvec3 coat_normal_world{0.0, 0.0, 1.0};  ///< The same with the clear coat's map alone.
    glm::dvec3 view_world{0.0, 0.0,
                          1.0};  ///< Unit, to the eye; the normal if the eye is at the surface.
    glm::dvec2 texcoord{0.0};    ///< Where the view meets the relief, if there is one.
    glm::dvec2 texcoord_2{0.0};
    glm::dvec4 color{1.0};      ///< Interpolated vertex color.
    double open_share = 1.0;    ///< Interpolated from the vertices.
    bool has_texcoord = false;  ///< Without them, no texture is looked up.
    bool has_texcoord_2 = false;
    /// The tangent frame of an anisotropic material, as interpolated; otherwise zero.
    glm::dvec3 tangent_world{0.0};
    glm::dvec3 bitangent_world{0.0};
    std::optional<ReliefHit> relief;  ///< Where the view meets it, if it does.
};

/// Tells whether a material shows what is behind it by transmission, on this mesh.
bool is_transmissive(const Material& material, const Mesh& mesh);

/// Tells whether the hit shows the back of its triangle.
bool is_back(const PreparedScene& prepared, const Hit& hit);

/// \param to_light_world  null: the eye sees it. Otherwise the light in that direction, for which
///                        only reliefs that write their depth are displaced
Surface surface_at(const PreparedScene& prepared, const Hit& hit, const Material& material,
                   Trace& trace, const glm::dvec3* to_light_world = nullptr);

/// Returns the surface at a corner of the triangle that was hit, for light computed at vertices. No
/// map bends its normal.
Surface surface_at_corner(const PreparedScene& prepared, const Hit& hit, int corner);

// Reliefs

/// Tells whether the relief hides light from the point that the view meets.
/// \param light_world  unit, to the light
bool is_shadowed(const ReliefHit& relief, const glm::dvec3& light_world);

/// True if shadows meet the relief of a material instead of the surface.
inline bool has_displaced_shadow(const Material& material) {
    return material.height_map && material.height_map->write_depth;
}

/// Tells whether the view leaves the material's height map where it is clamped, or a relief that
/// curves with the surface, so that nothing is drawn.
bool is_clipped(const Material& material, const Surface& surface);

/// Sets the depth of a hit to that of its relief, if the material writes it.
void set_relief_depth(const PreparedScene& prepared, const Material& material, Hit& hit);

// Light

/// Returns the reflectance of a smooth boundary by Fresnel's formulas for unpolarized light: the
/// mean of both polarizations.
///
/// \param index   of the inside relative to the outside; n + ik for metals
/// \param cosine  of the angle of incidence, within [0,1]
/// \return within [0,1]; 0 for an index of 1, which is no boundary, and 1 for an index of 0
double fresnel(std::complex<double> index, double cosine);

/// Returns I of Material's formula: the reflectance of a thin film in air, for red, green and blue.
///
/// \param f0         the reflectance of the base in air, at normal incidence
/// \param cosine     of the angle of incidence, within [0,1]
/// \param index      of the film, at least 1
/// \param thickness  in nanometers
glm::dvec3 film_reflectance(const glm::dvec3& f0, double cosine, double index, double thickness);

/// Returns Material's factor F at n.v, clamped to [0,1] by channel; 0 if the reflectivity is zero.
glm::dvec3 fresnel_factor(const Material& material, double n_dot_v);

/// The light from a surface to the eye.
struct Shaded {
    TermSum radiance;         ///< Unrestricted, like the data of the scene.
    double alpha = 1.0;       ///< As Material says, whatever the alpha mode.
    bool is_clipped = false;  ///< Nothing is drawn: is_clipped().
};

Shaded shade(const PreparedScene& prepared, const Hit& hit, const Material& material, Trace& trace);

}  // namespace reference
}  // namespace relief::shade
