// SPDX-License-Identifier: Apache-2.0
/// \file
/// Settings of a picture: size, samples, output coding, debug views, overlays and markers.
/// Tests: tests/shade/effects/effects_test.cpp, tests/shade/render/debug_views_test.cpp,
/// overlays_test.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/diagnose.h"
#include "relief/shade/scene.h"
#include "relief/shade/shader_texts.h"

namespace RELIEF_API relief {
namespace shade {

// Debug views show one input or term of shading instead of the picture. FrameSettings selects the
// view. Views do not change the programs and pixels of the normal picture: a view selects other
// shader parts. World space, linear light.

/// The content of a picture.
///
/// *Data* views store values without conversion: code = 0.5 v + 0.5 by component for a unit vector
/// v in world space, so that an 8-bit picture holds round(255 (0.5 v + 0.5)). There is no exposure,
/// tone mapping, sRGB coding or skybox; each pixel has one sample at its center; blended surfaces
/// count as opaque, and alpha masks still cut holes. An undefined direction is 0, mid-gray.
///
/// *Term* views show one summand of the radiance in material.h, coded as the picture is. In linear
/// float, the terms of a scene without unlit surfaces add up to its picture without the skybox. A
/// surface without the term is black.
///
/// A surface without data for a data view is hatched (nothing_to_show) and counted in the report.
/// If no surface has any, Renderer throws InvalidInput with the reason.
enum class DebugView : std::uint8_t {
    picture,  ///< The normal picture.
    // Data.
    geometric_normal,  ///< The normal of the triangle's plane, on the visible side.
    shading_normal,    ///< The normal for lighting: interpolated, perturbed by maps, two-sided.
    /// Unit tangent of the frame of normal maps: stored, by MikkTSpace if the mesh has none, or
    /// from derivatives if the material says so.
    tangent,
    bitangent,   ///< Its unit bitangent: the direction of decreasing v.
    handedness,  ///< right_handed_color or left_handed_color; an instance may mirror.
    texcoords,   ///< (u - floor u, v - floor v, 0 or 1 in squares of 1/checker_squares).
    normal_map,  ///< In tangent space (of an object-space map: object space), green up, made
                 ///< unit: from a normal map or a bump map.
    height,      ///< A bump map's height, gray: 0 black, 1 white.
    // Terms.
    ambient,
    diffuse,            ///< The scattered light of light sources.
    specular,           ///< The highlights of light sources.
    environment_light,  ///< The scattered light of the environment.
    reflection,         ///< The reflected environment.
    refraction,         ///< The environment seen through the surface.
    emission,
    /// The number of fragments at a pixel, at any depth: the sum of overdraw_step. Blue /
    /// overdraw_step.b is their number, up to 63 in 8 bits.
    overdraw,
    /// The pattern of surfaces that have nothing to show; it cannot be requested.
    nothing_to_show,
};

enum class DebugViewKind : std::uint8_t { picture, data, term, count };

struct DebugViewInfo {
    DebugView view;
    std::string_view name;  ///< "geometric-normal", as on command lines.
    std::string_view what;  ///< A description.
    DebugViewKind kind;
};

/// All views that can be requested, in the order of the enumeration.
std::span<const DebugViewInfo> debug_views();

/// Returns name and description of a view, nothing_to_show included.
const DebugViewInfo& debug_view_info(DebugView view);

[[nodiscard]] inline bool is_data(DebugView view) {
    return view != DebugView::picture && (view <= DebugView::height || view > DebugView::emission);
}
[[nodiscard]] inline bool is_term(DebugView view) {
    return view >= DebugView::ambient && view <= DebugView::emission;
}

inline constexpr glm::vec3 right_handed_color{0.2F, 0.6F, 1.0F};  ///< w = 1: blue, (51,153,255).
inline constexpr glm::vec3 left_handed_color{1.0F, 0.4F, 0.2F};   ///< w = -1: red, (255,102,51).
/// Squares of the checker along a side of the texture.
inline constexpr int checker_squares = 8;
/// The 8-bit codes that a fragment adds: from black over red and yellow to white, which is 64.
inline constexpr glm::vec3 overdraw_step{64.0F / 255.0F, 16.0F / 255.0F, 4.0F / 255.0F};
/// Stripes of nothing_to_show, 8 pixels wide along x + y, (51,51,51) and (77,77,77).
inline constexpr glm::vec2 hatching{51.0F / 255.0F, 77.0F / 255.0F};

/// A colored point on a surface, drawn as a disc over everything, hidden or not.
struct Marker {
    std::size_t instance = 0;
    glm::vec3 position_object{0.0F};
    glm::vec3 color_srgb{1.0F};

    friend bool operator==(const Marker&, const Marker&) = default;
};

/// A horizontal square grid in world space with the x (red), y (green) and z (blue) axes from its
/// middle. The lines are at multiples of `spacing`.
struct Grid {
    glm::dvec3 middle{0.0};
    double spacing = 1.0;
    int cells = 1;  ///< From the middle to each side.

    friend bool operator==(const Grid&, const Grid&) = default;
};

/// A grid below a box, half as large again as its larger side in the xz plane, along which 4 to 10
/// cells of 1, 2 or 5 times a power of 10 fit. The spacing is 1 for a box without size.
Grid grid_below(const Bounds& world);

/// Overlays on the finished picture. Exposure and tone curve do not change their colors. Lines are
/// a pixel wide, one sample; opaque surfaces hide them, those with an alpha mask or blending do
/// not.
struct Overlays {
    /// The edges of all drawn triangles.
    bool wireframe = false;
    /// The tangent (red), bitangent (green) and normal (blue) of every vertex. Their length is this
    /// fraction of the scene's size (the diagonal of its box). Tangents need texture coordinates or
    /// stored tangents; missing ones are computed.
    std::optional<float> vertex_frames;
    std::optional<Grid> grid;
    /// The markers to draw, for example those of health_markers().
    std::shared_ptr<const std::vector<Marker>> markers;

    [[nodiscard]] bool any() const { return wireframe || vertex_frames || grid || markers; }
    friend bool operator==(const Overlays&, const Overlays&) = default;
};

/// The default length of vertex frames, as a fraction of the scene's size.
inline constexpr float default_frame_length = 0.01F;
/// Pixels across a marker's disc.
inline constexpr int marker_pixels = 9;

// The colors of overlays in sRGB.
inline constexpr glm::vec3 wireframe_color{1.0F, 0.8F, 0.0F};  ///< (255,204,0)
inline constexpr glm::vec3 grid_color{0.4F, 0.4F, 0.4F};       ///< (102,102,102)
inline constexpr glm::vec3 tangent_color{1.0F, 0.2F, 0.2F};    ///< (255,51,51)
inline constexpr glm::vec3 bitangent_color{0.2F, 1.0F, 0.2F};  ///< (51,255,51)
inline constexpr glm::vec3 normal_color{0.4F, 0.6F, 1.0F};     ///< (102,153,255)

/// The coding of the finished radiance.
enum class OutputCoding : std::uint8_t {
    linear,   ///< Radiance, up to the largest float.
    clamped,  ///< Radiance clamped to 1.
    srgb,     ///< Exposed and tone-mapped (scene.h), clamped to 1, as sRGB codes.
    half,     ///< Radiance up to 65504, the input of the finishing pass; not for pictures.
};

struct FrameSettings {
    int width = 1024;
    int height = 1024;
    /// Samples per pixel: 1 or 4 (multisampling; edges only). Each is tone-mapped, and they are
    /// averaged in linear light.
    int samples = 4;
    /// srgb: 8-bit RGBA, ready for a screen. linear: float RGBA radiance. clamped: radiance up to
    /// 1.
    OutputCoding output = OutputCoding::srgb;
    /// The view that replaces the picture. Views of data have one sample a pixel and ignore
    /// `samples`.
    DebugView view = DebugView::picture;
    Overlays overlays = {};
    /// The camera of the picture, if it is known: depth mapping is planned only where it can move
    /// what this camera sees by half a pixel. If it is absent, depth mapping is planned for any
    /// camera.
    std::optional<Camera> camera = std::nullopt;
    /// Texts that replace parts of the shaders; none if it is null. Other texts are another object.
    std::shared_ptr<const ShaderTexts> shaders = nullptr;

    friend bool operator==(const FrameSettings&, const FrameSettings&) = default;
};

/// Returns "material 'paint'", "material 3" if it has no name, or "the default material" for none.
std::string material_label(const Scene& scene, std::optional<std::size_t> material);

/// Returns "instance 'wheel'"; without a name that of its mesh: "mesh 'Wheel'"; otherwise "instance
/// 3".
std::string instance_label(const Scene& scene, std::size_t instance);

/// Returns "mesh 'Wheel'" or "mesh 3".
std::string mesh_label(const Scene& scene, std::size_t mesh);

// Markers show the findings of the mesh health check (diagnose.h, `relief-mesh check`). They are
// drawn over a picture and colored by kind.

/// A condition, counted over all instances.
struct MarkedCondition {
    MeshCondition condition;
    std::size_t count = 0;  ///< Affected elements; those of a mesh once for each instance.
    /// Number of elements with a marker; the others are not finite, or exceed max_markers.
    std::size_t marked = 0;
    glm::vec3 color_srgb{1.0F};
};

struct HealthMarkers {
    std::shared_ptr<const std::vector<Marker>> markers;  ///< In the order of the conditions.
    std::vector<MarkedCondition> conditions;             ///< The legend, in the same order.
};

/// The maximum number of markers for one condition in one mesh.
inline constexpr std::size_t max_markers = 10000;

/// Returns the sRGB color of a condition; every condition has a different one.
glm::vec3 marker_color(MeshCondition condition);

/// Diagnoses every mesh that an instance shows. The marker of a vertex is at its position; that of
/// a triangle, or of an edge by its first triangle, at the center of its corners. Elements that are
/// not finite, and conditions of the whole mesh, are counted without a marker.
///
/// \param severity  only conditions of this severity: problems (for which `relief-mesh check`
///         reports an unsound mesh) or notes; if absent, both. Problems alone are faster
HealthMarkers health_markers(const Scene& scene,
                             std::optional<Severity> severity = Severity::problem);

}  // namespace shade
}  // namespace relief
