// SPDX-License-Identifier: Apache-2.0
/// \file
/// What to draw, as plain data: meshes, Phong materials, lights, a camera, an environment. No
/// OpenGL.
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

#include "relief/mesh/gltf_document.h"
#include "relief/mesh/image.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/normal_map.h"

namespace relief {

/// Where an image comes from: a file, an encoded file in memory, or decoded already.
struct ImageSource {
    std::string name;  ///< For messages.
    std::variant<std::filesystem::path, std::vector<std::byte>, Image> source;
};

/// A use of an image as a texture.
struct Texture {
    std::size_t image = 0;  ///< Index into Scene::images.
    TextureWrap wrap_u = TextureWrap::repeat;
    TextureWrap wrap_v = TextureWrap::repeat;
    TextureFilter filter = TextureFilter::linear;
};

enum class SpecularModel {
    phong,        ///< (reflect . view)^shininess
    blinn_phong,  ///< (half . normal)^shininess
};

/// A tangent-space normal map and how to read it (normal_map.h).
struct NormalMap {
    Texture texture;
    float scale = 1.0F;  ///< Multiplies x and y before normalising.
    Green green = Green::up;
    /// Absent: decided from the image by detect_flat_code.
    std::optional<FlatCode> flat = std::nullopt;
};

/// A Phong material. Everything happens in world space, with unit vectors n (the normal, bent by
/// the normal map), v (to the eye), and for every light i: l (to the light), h = (l + v) / |l + v|,
/// r = 2 (n.l) n - l, and L its irradiance at normal incidence. Products of colours are by channel.
///
///     radiance = (1 - F) (ambient * tint * scene.ambient + sum_i L diffuse * tint max(n.l, 0))
///              + sum_i L specular s [n.l > 0]
///              + F * environment(2 (n.v) n - v)
///              + emission * emission_texture
///
///     tint = diffuse_texture * vertex colour
///     s    = max(n.h, 0)^shininess (Blinn-Phong) or max(r.v, 0)^shininess (Phong); x^0 is 1
///     F    = reflectivity + (grazing_reflectivity - reflectivity) (1 - n.v)^5, n.v within [0,1];
///            0 where reflectivity is zero or the scene has no environment
///
/// A highlight is the mirror image of its light, so F does not dim it. An unlit material shows
/// diffuse * tint and nothing else.
/// Source: [Phong 1975], [Blinn 1977], [Schlick 1994]; the CPU twin is in
/// tests/shade/render/phong_reference.h.
struct Material {
    std::string name;
    glm::vec3 ambient{0.8F};  ///< Share of scene.ambient that is scattered.
    glm::vec3 diffuse{0.8F};
    glm::vec3 specular{0.0F};
    glm::vec3 emission{0.0F};
    float shininess = 32.0F;  ///< 0 to 1e6.
    SpecularModel specular_model = SpecularModel::blinn_phong;
    glm::vec3 reflectivity{0.0F};  ///< At normal incidence; zero: no environment reflection at all.
    glm::vec3 grazing_reflectivity{1.0F};     ///< Equal to reflectivity: no Fresnel effect.
    std::optional<Texture> diffuse_texture;   ///< sRGB colour.
    std::optional<Texture> emission_texture;  ///< sRGB colour.
    std::optional<NormalMap> normal_map;
    bool double_sided = false;  ///< Else back faces are not drawn.
    bool unlit = false;         ///< The diffuse colour as it is, without any light.
};

/// Light from infinitely far away.
struct DirectionalLight {
    glm::vec3 direction_world{0.0F, -1.0F, 0.0F};  ///< The way the light travels; any length but 0.
    /// Of a surface facing it, over pi: a white one then shows this radiance.
    glm::vec3 irradiance{1.0F};
};

/// Light from a point, falling off with the squared distance. It does not reach a point that it
/// touches, and no surface gets more than max_light from it.
struct PointLight {
    glm::vec3 position_world{0.0F};
    glm::vec3 intensity{1.0F};                  ///< Irradiance (over pi, as above) at distance 1.
    std::optional<float> range = std::nullopt;  ///< Fades to 0 there, as KHR_lights_punctual says.
};

/// A point light within a cone.
struct SpotLight {
    PointLight point;
    glm::vec3 direction_world{0.0F, -1.0F, 0.0F};  ///< The cone's axis; any length but 0.
    float inner_cone = 0.0F;          ///< Full intensity within, radians from the axis.
    float outer_cone = 0.785398163F;  ///< None beyond; larger than inner_cone, at most pi / 2.
};

/// The most irradiance, intensity or ambient radiance that a scene may name, and that a surface
/// gets from one light however close: products with it stay finite.
inline constexpr float max_light = 1e18F;
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
/// left-handed world: sets drawn for the right-handed eye show mirrored.
struct CubeFaces {
    std::array<ImageSource, 6> faces;
};

/// A panorama by longitude and latitude: its centre is -z, its top row +y.
struct Equirectangular {
    ImageSource image;
};

/// Light from everywhere, as a picture of the surroundings.
struct Environment {
    std::variant<CubeFaces, Equirectangular> source;
    float intensity = 1.0F;
    bool skybox = true;  ///< Drawn behind the model.
};

/// A mesh at its place. Its material ranges name Scene::materials; none means the default material.
struct Instance {
    std::size_t mesh = 0;
    glm::mat4 world_from_object{1.0F};
    std::string name;
};

struct Scene {
    std::vector<Mesh> meshes;
    std::vector<Material> materials;
    std::vector<ImageSource> images;
    std::vector<Instance> instances;
    glm::vec3 ambient{0.0F};  ///< Radiance from everywhere, reaching every point alike.
    std::vector<DirectionalLight> directional_lights;
    std::vector<PointLight> point_lights;
    std::vector<SpotLight> spot_lights;
    std::optional<Environment> environment;
    std::optional<Camera> camera;  ///< Absent: framed() decides.
    glm::vec4 background{0.0F};    ///< Linear, alpha not multiplied in; where no skybox shows.
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

/// The same for a camera alone.
void validate(const Camera& camera);

}  // namespace relief
