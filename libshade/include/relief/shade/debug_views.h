// SPDX-License-Identifier: Apache-2.0
/// \file
/// Pictures of what shading is made of, instead of the shaded picture, and things drawn over it.
///
/// A view is asked for in FrameSettings. The normal picture's programs and pixels are what they are
/// without this file: a view is one more choice of shader files. World space, linear light.
/// Tests: tests/shade/effects/debug_views_test.cpp, tests/shade/render/debug_views_test.cpp,
/// overlays_test.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace relief {

/// What a picture shows.
///
/// *Data* is stored as it is: code = 0.5 v + 0.5 by component for a unit vector v in world space,
/// so that an 8-bit picture holds round(255 (0.5 v + 0.5)); no exposure, no tone curve, no sRGB
/// coding, one sample a pixel (at its centre), no skybox, and a blended surface counts as opaque.
/// An alpha mask still cuts its holes. A direction that nothing determines is 0, mid-grey.
///
/// *Terms* are light: one summand of the radiance in material.h, coded as the picture is. In linear
/// float the terms of a scene without unlit surfaces add up to its picture without the skybox. A
/// surface without the term is black there, since that is its share.
///
/// A surface for which a view of data has no meaning is hatched (nothing_to_show) and counted in
/// the report. Where no surface has anything to show, Renderer throws InvalidInput with the reason.
enum class DebugView : std::uint8_t {
    picture,  ///< Everything, as always.
    // Data.
    geometric_normal,  ///< Of the triangle's plane, on the side that is seen.
    shading_normal,    ///< That light meets: interpolated, bent by maps, turned on back faces.
    tangent,           ///< Of the frame that normal maps are read in: the mesh's, MikkTSpace's
                       ///< where it has none, or by derivatives as the material says; made unit.
    bitangent,         ///< Likewise, made unit: where the image's v decreases.
    handedness,        ///< right_handed_color or left_handed_color; an instance may mirror.
    texcoords,         ///< (u - floor u, v - floor v, 0 or 1 in squares of 1/checker_squares).
    normal_map,        ///< In tangent space (of an object-space map: object space), green up, made
                       ///< unit: from a normal map or a bump map.
    height,            ///< A bump map's height, grey: 0 black, 1 white.
    // Terms.
    ambient,
    diffuse,            ///< Lamps, scattered.
    specular,           ///< Lamps, mirrored: highlights.
    environment_light,  ///< The environment's, scattered.
    reflection,         ///< The environment, mirrored.
    refraction,         ///< The environment, through the surface.
    emission,
    /// How many fragments lie on each other at a pixel, whatever their depth: overdraw_step each,
    /// added up. Blue / overdraw_step.b is their number, up to 63 in 8 bits.
    overdraw,
    /// What a surface gets that has nothing to show; not to be asked for.
    nothing_to_show,
};

enum class DebugViewKind : std::uint8_t { picture, data, term, count };

struct DebugViewInfo {
    DebugView view;
    std::string_view name;  ///< "geometric-normal", as on command lines.
    std::string_view what;  ///< In words.
    DebugViewKind kind;
};

/// All that can be asked for, in the order of the enumeration.
std::span<const DebugViewInfo> debug_views();

/// The words for one of them, nothing_to_show too.
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
/// Codes of 255 that a fragment adds: from black over red and yellow to white, which is 64.
inline constexpr glm::vec3 overdraw_step{64.0F / 255.0F, 16.0F / 255.0F, 4.0F / 255.0F};
/// Stripes of nothing_to_show, 8 pixels wide along x + y, (51,51,51) and (77,77,77).
inline constexpr glm::vec2 hatching{51.0F / 255.0F, 77.0F / 255.0F};

/// A coloured point on a surface, drawn as a disc over everything, hidden or not.
struct Marker {
    std::size_t instance = 0;
    glm::vec3 position_object{0.0F};
    glm::vec3 color_srgb{1.0F};

    friend bool operator==(const Marker&, const Marker&) = default;
};

/// Drawn over the finished picture: colours are what they are, whatever its exposure and tone
/// curve. Lines are a pixel wide, one sample; opaque surfaces hide them, those with an alpha mask
/// or blending do not.
struct Overlays {
    /// Edges of all triangles that are drawn.
    bool wireframe = false;
    /// At every vertex its tangent (red), bitangent (green) and normal (blue), as long as this
    /// share of the scene's size (the diagonal of its box). Tangents only where there are
    /// texture coordinates or stored ones; those that the mesh lacks are computed.
    std::optional<float> vertex_frames;
    /// E.g. health_markers.h.
    std::shared_ptr<const std::vector<Marker>> markers;

    [[nodiscard]] bool any() const { return wireframe || vertex_frames || markers; }
    friend bool operator==(const Overlays&, const Overlays&) = default;
};

/// The usual length of vertex frames, as a share of the scene's size.
inline constexpr float usual_frame_length = 0.01F;
/// Pixels across a marker's disc.
inline constexpr int marker_pixels = 9;

// sRGB.
inline constexpr glm::vec3 wireframe_color{1.0F, 0.8F, 0.0F};  ///< (255,204,0)
inline constexpr glm::vec3 tangent_color{1.0F, 0.2F, 0.2F};    ///< (255,51,51)
inline constexpr glm::vec3 bitangent_color{0.2F, 1.0F, 0.2F};  ///< (51,255,51)
inline constexpr glm::vec3 normal_color{0.4F, 0.6F, 1.0F};     ///< (102,153,255)

}  // namespace relief
