// SPDX-License-Identifier: Apache-2.0
/// \file
/// The picture that a scene ought to give: Material's formula (material.h) in double precision on
/// the CPU, written down from that comment and not from the shaders. Ground truth for the renderer
/// and for reports on accuracy.
///
/// World space, linear light. A library of its own, relief::reference, because it needs Embree.
/// Tests: tests/shade/reference/, tests/shade/render/reference_test.cpp.
#pragma once

#include <cstdint>
#include <vector>

#include "relief/mesh/image.h"
#include "relief/mesh/report.h"
#include "relief/shade/frame_settings.h"
#include "relief/shade/scene.h"

namespace relief {

struct ReferenceSettings {
    int width = 256;
    int height = 256;
    /// How far from the centre of a pixel, in pixels, an edge counts as near: at least as far as
    /// OpenGL's rounding of vertices to 1/256 pixel moves one. 0: no edges are looked for.
    double edge_margin = 1.0 / 32.0;
};

/// What a pixel shows first.
struct ReferenceHit {
    static constexpr std::uint32_t none = 0xFFFFFFFFU;

    std::uint32_t instance = none;  ///< Index into Scene::instances; none: skybox or background.
    std::uint32_t triangle = none;  ///< Index into its mesh's triangles.
    bool back = false;              ///< Its back face is seen.

    friend bool operator==(const ReferenceHit&, const ReferenceHit&) = default;
};

struct Reference {
    /// Four float channels, linear, before exposure and tone mapping. Alpha is how much of the
    /// background is covered (by surfaces, or all of it by a skybox) and not multiplied in.
    Image radiance;
    /// One channel of 8 bits: 255 where something discrete changes within edge_margin of the
    /// pixel's centre (which surface, which texel of a nearest-filtered texture, which side of a
    /// lamp), so that rounding may decide what is seen, and where a texture is so fine that OpenGL
    /// averages it; else 0.
    Image edges;
    std::vector<ReferenceHit> hits;  ///< By pixel, row 0 on top.
};

/// The scene as its camera sees it, at the centre of each pixel.
///
/// \param report  counts fallbacks of normal and tangent computation, and triangles with a vertex
///                that is not finite: they are not drawn; names textures that cannot be read, which
///                are left out as renderer.h says
/// \return as shaders/README.md says in every hard case; always finite. Textures are looked up at
///         full resolution, bilinearly or nearest: minified ones show what OpenGL averages, which
///         is not done here, and neither is Material::specular_antialiasing. The same bits for any
///         number of threads.
/// \throws InvalidInput if the scene or the settings are not valid or there is no camera; FileError
///         if an image of the environment, or one that is required (scene.h), cannot be read
Reference render_reference(const Scene& scene, const ReferenceSettings& settings, Report& report);

/// The picture of a radiance, composed over the scene's background.
///
/// \param radiance  as in Reference
/// \return four float channels, alpha not multiplied in; as frame_settings.h says, but that srgb is
///         not rounded to 8 bits
/// \throws InvalidInput for OutputCoding::half
///
/// Source of ToneMapping::aces: [Narkowicz 2016].
Image reference_picture(const Image& radiance, const Scene& scene, OutputCoding output);

}  // namespace relief
