// SPDX-License-Identifier: Apache-2.0
/// \file
/// Defines scenes as plain data: meshes, materials (material.h), lights (lights.h), a camera, an
/// environment. No OpenGL.
///
/// World space is right-handed, y up. Colors are linear. Angles are radians. Images are named here
/// and decoded only if the effect plan (effects.h) needs them. scene_fields.h has the name and
/// range of every field.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "relief/mesh/image.h"
#include "relief/mesh/mesh.h"
#include "relief/shade/lights.h"
#include "relief/shade/material.h"
#include "relief/shade/shared.h"

namespace relief {

/// The source of an image: a file, an encoded file in memory, or a decoded image.
struct ImageSource {
    std::string name;  ///< For messages.
    std::variant<std::filesystem::path, Shared<std::vector<std::byte>>, Shared<Image>> source;
    std::string origin{};  ///< The file that names the image, for messages; empty: none.
    /// The reason why the image cannot be decoded; empty if there is none.
    std::string fault{};
    /// True if a Renderer throws if it cannot decode the image. Otherwise it reports the error and
    /// draws without the texture.
    bool is_required = false;
};

/// The maximum of a material's color components.
inline constexpr float max_reflectance = 1e9F;

/// A perspective camera that looks along its own -z.
struct Camera {
    glm::mat4 world_from_view{1.0F};  ///< Rotation and translation only.
    float vertical_fov = 0.8F;
    float near = 0.1F;
    float far = 100.0F;
};

/// Six square images of one size, in OpenGL's order and orientation: +x -x +y -y +z -z, each looked
/// up by the world direction. Seen from inside, OpenGL's faces are those of a left-handed world:
/// sets drawn for a right-handed world appear mirrored unless left_handed is set.
struct CubeFaces {
    std::array<ImageSource, 6> faces;
    bool left_handed = false;  ///< Drawn for a left-handed world: x is reversed.
};

/// Six faces in one image, as a horizontal (4:3) or vertical (3:4) cross, recognized by its shape.
struct CubeCross {
    ImageSource image;
};

/// A panorama by longitude and latitude: its center is -z, its top row +y.
struct Equirectangular {
    ImageSource image;
};

/// A light probe: the view into a mirrored ball, by angle. The center is -z, the rim +z, up is +y.
struct AngularMap {
    ImageSource image;
};

/// An environment map: light from all directions.
struct Environment {
    std::variant<CubeFaces, CubeCross, Equirectangular, AngularMap> source;
    float intensity = 1.0F;
    bool skybox = true;   ///< The environment is visible behind the model.
    bool lights = false;  ///< Surfaces scatter its light, by spherical harmonics of order 2.
};

/// The curve from radiance times exposure to the picture, by channel.
enum class ToneMapping {
    none,      ///< Values above 1 are clamped.
    reinhard,  ///< x / (1 + x)
    aces,      ///< A fit to the film curve of the ACES reference rendering.
};

/// A mesh in the world. Its material ranges refer to Scene::materials, or to the default material.
struct Instance {
    std::size_t mesh = 0;
    glm::mat4 world_from_object{1.0F};
    std::string name;
};

struct Scene {
    std::vector<Shared<Mesh>> meshes;  ///< Copies of a scene share them.
    std::vector<Material> materials;
    std::vector<ImageSource> images;
    std::vector<Instance> instances;
    glm::vec3 ambient{0.0F};  ///< Constant radiance from all directions.
    std::vector<DirectionalLight> directional_lights;
    std::vector<PointLight> point_lights;
    std::vector<SpotLight> spot_lights;
    std::optional<Environment> environment;
    std::optional<Camera> camera;  ///< If absent, framed() decides.
    glm::vec4 background{0.0F};    ///< Linear, alpha not multiplied in; visible without a skybox.
                                   ///< Neither exposed nor tone-mapped.
    float exposure = 1.0F;         ///< Multiplies radiance before tone mapping.
    ToneMapping tone_mapping = ToneMapping::none;  ///< For pictures with sRGB codes only.
};

/// Returns the bounding box of all instances in world space.
Bounds world_bounds(const Scene& scene);

/// Computes a camera that sees a whole box, for any aspect ratio.
///
/// \param azimuth  radians from +z towards +x, to the position of the camera
/// \param elevation  radians above the horizon
/// \param aspect  width / height of the picture
/// \return near and far enclose the box closely; for an empty box or one without extent, a camera
///         at distance 1 from its center (the origin for an empty box)
/// \throws InvalidInput if an angle or the aspect is not finite, the aspect is not positive, or the
///         field of view is not within (0, pi)
Camera framed(const Bounds& world, float azimuth, float elevation, float vertical_fov,
              float aspect);

/// Checks every index and number that drawing relies on: indices exist, numbers are finite and
/// within the ranges of scene_fields.h, directions have a length, the inner cones of spots are
/// smaller than the outer ones, the camera has a depth range, meshes are valid. Vertex data may
/// hold any value, NaN included; matrices may be singular. \throws InvalidInput naming the first
/// error
void validate(const Scene& scene);

/// Checks only what animations move: instances and lights. Meshes are skipped, so the cost is
/// negligible beside a frame.
void validate_transforms(const Scene& scene);

/// Checks a camera alone.
void validate(const Camera& camera);

}  // namespace relief
