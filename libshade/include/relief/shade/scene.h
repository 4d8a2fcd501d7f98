// SPDX-License-Identifier: Apache-2.0
/// \file
/// What to draw, as plain data: meshes, materials (material.h), lights (lights.h), a camera, an
/// environment. No OpenGL.
///
/// World space is right-handed, y up. Colours are linear. Angles are radians. Images are named here
/// and decoded only when the effect plan (effects.h) calls for them.
/// Tests: tests/shade/scene/scene_test.cpp.
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

/// Where an image comes from: a file, an encoded file in memory, or decoded already.
struct ImageSource {
    std::string name;  ///< For messages.
    std::variant<std::filesystem::path, Shared<std::vector<std::byte>>, Shared<Image>> source;
    std::string origin{};  ///< The file that names the image, for messages; empty: none.
    /// Why there is nothing to decode; empty: there is.
    std::string fault{};
    /// Whether a Renderer that cannot decode the image throws. Else it draws without the texture
    /// and reports that.
    bool is_required = false;
};

/// The largest value of a material's colour.
inline constexpr float max_reflectance = 1e9F;

/// A perspective camera that looks along its own -z.
struct Camera {
    glm::mat4 world_from_view{1.0F};  ///< Rotation and translation only.
    float vertical_fov = 0.8F;
    float near = 0.1F;
    float far = 100.0F;
};

/// Six square images of one size, in OpenGL's order and orientation: +x -x +y -y +z -z, each
/// looked up by the world direction as it is. Seen from inside, OpenGL's faces are those of a
/// left-handed world: sets drawn for the right-handed eye show mirrored unless they say so.
struct CubeFaces {
    std::array<ImageSource, 6> faces;
    bool left_handed = false;  ///< Drawn for a left-handed world: x is turned round.
};

/// Six faces in one image, as a horizontal (4:3) or vertical (3:4) cross, told by its shape.
struct CubeCross {
    ImageSource image;
};

/// A panorama by longitude and latitude: its centre is -z, its top row +y.
struct Equirectangular {
    ImageSource image;
};

/// A light probe: the view into a mirrored ball, by angle. The centre is -z, the rim +z, up is +y.
struct AngularMap {
    ImageSource image;
};

/// Light from everywhere, as a picture of the surroundings.
struct Environment {
    std::variant<CubeFaces, CubeCross, Equirectangular, AngularMap> source;
    float intensity = 1.0F;
    bool skybox = true;   ///< Drawn behind the model.
    bool lights = false;  ///< Surfaces scatter its light, by spherical harmonics of order 2.
};

/// How radiance, times the exposure, becomes a picture; by channel.
enum class ToneMapping {
    none,      ///< What is above 1 is 1.
    reinhard,  ///< x / (1 + x)
    aces,      ///< A fit to the film curve of the ACES reference rendering.
};

/// A mesh at its place. Its material ranges name Scene::materials; none means the default material.
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
    glm::vec3 ambient{0.0F};  ///< Radiance from everywhere, reaching every point alike.
    std::vector<DirectionalLight> directional_lights;
    std::vector<PointLight> point_lights;
    std::vector<SpotLight> spot_lights;
    std::optional<Environment> environment;
    std::optional<Camera> camera;  ///< Absent: framed() decides.
    glm::vec4 background{0.0F};    ///< Linear, alpha not multiplied in; where no skybox shows. Not
                                   ///< exposed and not tone-mapped.
    float exposure = 1.0F;         ///< Multiplies radiance before tone mapping.
    ToneMapping tone_mapping = ToneMapping::none;  ///< Of pictures with sRGB codes only.
};

/// The box of all instances in world space.
Bounds world_bounds(const Scene& scene);

/// A camera that sees all of a box, whatever the picture's shape.
///
/// \param azimuth    radians from +z towards +x, from where the camera looks
/// \param elevation  radians above the horizon
/// \param aspect     width / height of the picture
/// \return near and far enclose the box's sphere closely; for an empty box or one without extent, a
///         camera at distance 1 from its centre (of an empty one: the origin)
/// \throws InvalidInput if an angle or the aspect is not finite, the aspect is not positive, or the
///         field of view is not within (0, pi)
Camera framed(const Bounds& world, float azimuth, float elevation, float vertical_fov,
              float aspect);

/// Checks every index and number that drawing relies on: indices name something, numbers are
/// finite, colours and lights are within [0, max_reflectance] and [0, max_light], directions have a
/// length, cones open, the camera has a depth range, meshes are valid. Vertex data may hold
/// anything (NaN included); matrices may be singular. \throws InvalidInput naming the first offence
void validate(const Scene& scene);

/// The same for what moves: where instances stand, and the lamps. Meshes are not looked at, so that
/// it costs nothing beside a frame.
void validate_places(const Scene& scene);

/// The same for a camera alone.
void validate(const Camera& camera);

}  // namespace relief
