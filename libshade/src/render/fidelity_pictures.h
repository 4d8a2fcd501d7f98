// SPDX-License-Identifier: Apache-2.0
/// \file
/// The pictures that fidelity.h compares: a scene from all views, with each light and as normals.
/// Tests: tests/shade/render/fidelity_test.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/report.h"
#include "relief/shade/fidelity.h"
#include "relief/shade/renderer.h"
#include "relief/shade/scene.h"

namespace RELIEF_API relief {
namespace shade::detail {

/// The part of the side of the pictures that the source's sphere fills.
inline constexpr double fidelity_sphere_share = 0.9;

/// A sphere in world space.
struct FidelitySphere {
    glm::dvec3 center{0.0};
    double radius = 0.0;
};

bool has_triangles(const Scene& scene);

/// \throws InvalidInput if the source has no triangle, or a radius out of range
FidelitySphere fidelity_sphere(const Scene& source);

/// The materials of the pictures.
enum class FidelityMaterials {
    as_authored,
    gray,     ///< Matte, of the default gray. The source has neither materials nor colors.
    colored,  ///< Matte, with base colors. The source has only vertex colors.
};

/// Sources without materials have no gloss, and often no color, that a result could lose.
FidelityMaterials fidelity_materials(const Scene& source);

/// Moves and scales a scene so that the sphere is the unit sphere around the origin, and removes
/// all that is not a surface.
Scene normalized_scene(Scene scene, const FidelitySphere& sphere, FidelityMaterials materials);

/// A picture in linear light, multiplied by alpha: 65535 stands for 1.
using ColorPicture = std::vector<glm::u16vec4>;

struct NormalPicture {
    std::vector<glm::vec3> normals;  ///< The sums of the samples, of any length.
    std::vector<float> coverage;     ///< The covered part of each pixel.
};

/// All pictures of a view.
struct ViewPictures {
    std::array<ColorPicture, fidelity_light_count> colors;
    NormalPicture normals;
};

/// A scene on the GPU, with a renderer for each light and for normals.
class DrawnScene {
  public:
    /// \param scene  normalized, with at least one triangle
    DrawnScene(RenderCache& cache, const Context& context, const Scene& scene, int size,
               int per_side, Report& report);

    /// \param from  the direction to the camera, a unit vector
    ViewPictures draw(const glm::vec3& from);

  private:
    ColorPicture draw_light(FidelityLight light, const glm::vec3& from);
    NormalPicture draw_normals(const glm::vec3& from);

    double reach_;
    int per_side_;
    /// The color of all surfaces if they have the same one. Their base color needs no drawing.
    std::optional<glm::vec3> color_;
    Scene grazing_;
    std::array<std::optional<Renderer>, fidelity_light_count> lights_;
    std::optional<Renderer> normals_;
};

/// The pictures of a scene without triangles.
ViewPictures empty_view(int size);

}  // namespace shade::detail
}  // namespace relief
