// SPDX-License-Identifier: Apache-2.0
/// \file
/// Computes the reference picture of a scene: the formula of Material (material.h) in double
/// precision on the CPU, implemented from that comment and not from the shaders. The renderer
/// and accuracy reports are compared with it.
///
/// World space, linear light. It is a library of its own, relief::reference, because it needs
/// Embree.
#pragma once

#include <cstdint>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/image.h"
#include "relief/mesh/report.h"
#include "relief/shade/frame_settings.h"
#include "relief/shade/scene.h"

namespace RELIEF_API relief {
namespace shade {

struct ReferenceSettings {
    int width = 256;
    int height = 256;
    /// The distance in pixels from the center of a pixel within which an edge is reported: at least
    /// the shift of an edge by OpenGL's rounding of vertices to 1/256 pixel. 0: no edges are
    /// searched.
    double edge_margin = 1.0 / 32.0;
};

/// The first surface of a pixel.
struct ReferenceHit {
    static constexpr std::uint32_t none = 0xFFFFFFFFU;

    std::uint32_t instance = none;  ///< Index into Scene::instances; none: skybox or background.
    std::uint32_t triangle = none;  ///< Index into its mesh's triangles.
    bool back = false;              ///< Its back face is visible.

    friend bool operator==(const ReferenceHit&, const ReferenceHit&) = default;
};

struct Reference {
    /// Four float channels, linear, before exposure and tone mapping. Alpha is the coverage of the
    /// background (by surfaces, or fully by a skybox) and not multiplied in.
    Image radiance;
    /// One channel of 8 bits: 255 if a discrete property changes within edge_margin of the pixel's
    /// center (the surface, the texel of a nearest-filtered texture, the side of a light), so that
    /// rounding may decide the color, or if a texture is so fine that OpenGL averages it; otherwise
    /// 0.
    Image edges;
    std::vector<ReferenceHit> hits;  ///< By pixel, row 0 at the top.
};

/// Renders the scene as its camera sees it, at the center of each pixel.
///
/// \param report  counts fallbacks of normal and tangent computation, and triangles with a vertex
///         that is not finite, which are not drawn; names textures that cannot be read, which are
///         omitted as in renderer.h
/// \return always finite; shaders/README.md defines degenerate cases. Textures are sampled at full
///         resolution, bilinearly or nearest, without minification, and without
///         Material::specular_antialiasing. The same bits for any number of threads
/// \throws InvalidInput if the scene or the settings are not valid or there is no camera; FileError
///         if an image of the environment, or one that is required (image_source.h), cannot be read
Reference render_reference(const Scene& scene, const ReferenceSettings& settings,
                           Report& report = IgnoredReport());

/// Computes Instance::open_shares of all instances, if the scene requests ambient occlusion.
///
/// Meshes are as their poses deform them now; a later pose does not change the shares. Surfaces
/// that cast no shadow (scene.h) do not occlude. An instance where all light arrives has no shares.
///
/// \param rays  for each vertex, 1 to 65536
/// \throws InvalidInput if the scene is not valid; Cancelled
void add_ambient_occlusion(Scene& scene, int rays = 64);

/// Converts radiance to a picture over the scene's background.
///
/// \param radiance  as in Reference
/// \return four float channels, not premultiplied by alpha; as in frame_settings.h, except that
///         srgb is not rounded to 8 bits
/// \throws InvalidInput for OutputCoding::half
///
/// Sources of tone curves: [Reinhard et al. 2002], [Narkowicz 2016], [Hill 2017] and [Khronos PBR
/// Neutral].
Image reference_picture(const Image& radiance, const Scene& scene, OutputCoding output);

}  // namespace shade
}  // namespace relief
