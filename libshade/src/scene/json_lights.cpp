// SPDX-License-Identifier: Apache-2.0
// What shines and what looks, in scene files. A course's lamp has an ambient, a diffuse and a
// specular colour: the first adds to the scene's ambient light, the others are irradiance over pi,
// for scattering and for highlights. Offences throw InvalidInput with their place.
// Tests: tests/shade/scene/scene_json_test.cpp.
#include "scene/json_lights.h"

#include <fmt/format.h>

#include <algorithm>

#include "relief/mesh/error.h"
#include "relief/shade/default_view.h"
#include "relief/shade/environment_files.h"
#include "relief/shade/framing.h"

namespace relief {

namespace {

enum class LightType { directional, point, spot };
constexpr Named<LightType> light_types[] = {{"directional", LightType::directional},
                                            {"point", LightType::point},
                                            {"spot", LightType::spot}};

/// The colours of a lamp, each times its intensity.
struct LampColors {
    glm::vec3 diffuse{1.0F};
    std::optional<glm::vec3> specular;
    glm::vec3 ambient{0.0F};
};

LampColors colors_from(const JsonCursor& object) {
    if (object.find("color") && object.find("diffuse"))
        object.at("diffuse").fail("says the same as 'color': give one of them");
    const float intensity = number_in(object, "intensity", 1.0F);
    LampColors colors;
    for (const char* key : {"color", "diffuse"}) {
        if (const auto color = object.find(key)) colors.diffuse = color_in(*color);
    }
    colors.diffuse *= intensity;
    if (const auto specular = object.find("specular"))
        colors.specular = intensity * color_in(*specular);
    if (const auto ambient = object.find("ambient"))
        colors.ambient = intensity * color_in(*ambient);
    return colors;
}

/// Refuses what this type of light does not have.
void check_members(const JsonCursor& object, LightType type) {
    std::vector<std::string> known = {"type",    "color",    "intensity",
                                      "diffuse", "specular", "ambient"};
    const auto add = [&](std::initializer_list<const char*> more) {
        known.insert(known.end(), more.begin(), more.end());
    };
    if (type != LightType::point) add({"direction"});
    if (type != LightType::directional) add({"position", "range", "falloff"});
    if (type == LightType::spot) add({"inner_cone", "outer_cone"});
    object.allow(known);
}

PointLight point_from(const JsonCursor& object, const LampColors& colors) {
    PointLight light;
    light.intensity = colors.diffuse;
    light.highlight_intensity = colors.specular;
    light.position_world = vector_in(object, "position", glm::vec3(0.0F));
    if (const auto range = object.find("range")) light.range = range->number(1e-30F);
    if (const auto falloff = object.find("falloff"))
        light.falloff = one_of(*falloff, falloff_words);
    return light;
}

glm::vec3 direction_from(const JsonCursor& object, bool on_node) {
    const auto direction = object.find("direction");
    if (!direction) {
        if (!on_node) object.fail("has no 'direction', which a light without a node needs");
        return {0.0F, 0.0F, -1.0F};
    }
    const glm::vec3 vector = direction->vector();
    if (vector == glm::vec3(0.0F)) direction->fail("must have a length");
    return vector;
}

void hang(std::vector<Carried>& carried, std::size_t index, std::optional<std::size_t> node,
          const glm::mat4& node_from_light) {
    carried.resize(index);
    carried.push_back({node, node_from_light});
}

}  // namespace

float number_in(const JsonCursor& object, const char* key, float absent) {
    const auto found = object.find(key);
    return found ? found->number() : absent;
}

float degrees_in(const JsonCursor& object, const char* key, float absent_radians) {
    const auto found = object.find(key);
    // In double: angles that were written come back bit for bit.
    return found ? static_cast<float>(glm::radians(found->exact_number())) : absent_radians;
}

glm::vec3 vector_in(const JsonCursor& object, const char* key, const glm::vec3& absent) {
    const auto found = object.find(key);
    return found ? found->vector() : absent;
}

void add_light(const JsonCursor& object, std::optional<std::size_t> node, SceneGraph& graph) {
    const LightType type = one_of(object.at("type"), light_types);
    check_members(object, type);
    const LampColors colors = colors_from(object);
    Scene& scene = graph.scene;
    scene.ambient += colors.ambient;
    const bool on_node = node.has_value();
    if (type == LightType::directional) {
        const glm::vec3 direction = direction_from(object, on_node);
        scene.directional_lights.push_back({direction, colors.diffuse, colors.specular});
        hang(graph.directional_lights, scene.directional_lights.size() - 1, node,
             looking_along(glm::vec3(0.0F), direction));
    } else if (type == LightType::point) {
        const PointLight light = point_from(object, colors);
        scene.point_lights.push_back(light);
        hang(graph.point_lights, scene.point_lights.size() - 1, node,
             looking_along(light.position_world, {0.0F, 0.0F, -1.0F}));
    } else {
        SpotLight light{point_from(object, colors), direction_from(object, on_node)};
        light.inner_cone = degrees_in(object, "inner_cone", light.inner_cone);
        light.outer_cone = degrees_in(object, "outer_cone", light.outer_cone);
        scene.spot_lights.push_back(light);
        hang(graph.spot_lights, scene.spot_lights.size() - 1, node,
             looking_along(light.point.position_world, light.direction_world));
    }
}

Environment environment_from(const JsonCursor& object, const JsonImages& images) {
    object.allow({"faces", "folder", "cross", "panorama", "angular_map", "intensity", "skybox",
                  "lights", "left_handed"});
    Environment environment;
    int sources = 0;
    if (const auto faces = object.find("faces")) {
        const std::vector<JsonCursor> files = faces->elements();
        if (files.size() != 6) faces->fail("must be six images: +x -x +y -y +z -z");
        CubeFaces cube;
        std::transform(files.begin(), files.end(), cube.faces.begin(),
                       [&](const JsonCursor& file) { return images.source(file); });
        environment.source = std::move(cube);
        ++sources;
    }
    if (const auto folder = object.find("folder")) {
        try {
            environment.source = cube_faces_in(images.folder(*folder));
        } catch (const FileError& error) {
            folder->fail(error.what());
        }
        ++sources;
    }
    const auto single = [&]<typename Source>(const char* key, Source) {
        const auto image = object.find(key);
        if (!image) return;
        environment.source = Source{images.source(*image)};
        ++sources;
    };
    single("cross", CubeCross{});
    single("panorama", Equirectangular{});
    single("angular_map", AngularMap{});
    if (sources != 1)
        object.fail("must have one of 'faces', 'folder', 'cross', 'panorama' and 'angular_map'");
    if (const auto intensity = object.find("intensity"))
        environment.intensity = intensity->number(0.0F, max_reflectance);
    if (const auto skybox = object.find("skybox")) environment.skybox = skybox->boolean();
    if (const auto lights = object.find("lights")) environment.lights = lights->boolean();
    if (const auto left_handed = object.find("left_handed")) {
        auto* cube = std::get_if<CubeFaces>(&environment.source);
        if (cube == nullptr) left_handed->fail("says something of six faces only");
        cube->left_handed = left_handed->boolean();
    }
    return environment;
}

Camera node_camera_from(const JsonCursor& object, bool& sees_all) {
    object.allow({"fov", "near", "far"});
    Camera camera;
    camera.vertical_fov = degrees_in(object, "fov", camera.vertical_fov);
    camera.near = number_in(object, "near", camera.near);
    sees_all = !object.find("far");
    camera.far = number_in(object, "far", 2.0F * camera.near);
    return camera;
}

namespace {

/// A camera as it was, number by number.
Camera camera_by_matrix(const JsonCursor& object, bool& sees_all) {
    for (const char* key : {"eye", "target", "azimuth", "elevation", "distance_factor"}) {
        if (const auto extra = object.find(key))
            extra->fail("says where the camera stands, and so does 'matrix'");
    }
    Camera camera;
    const std::vector<float> values = object.at("matrix").numbers(16);
    for (std::size_t i = 0; i < 16; ++i)
        camera.world_from_view[static_cast<int>(i / 4)][static_cast<int>(i % 4)] = values[i];
    camera.vertical_fov = degrees_in(object, "fov", default_vertical_fov);
    camera.near = object.at("near").number();
    camera.far = object.at("far").number();
    sees_all = false;
    return camera;
}

}  // namespace

Camera camera_from(const JsonCursor& object, const Scene& scene, float aspect, bool& sees_all) {
    object.allow({"eye", "target", "azimuth", "elevation", "distance_factor", "matrix", "fov",
                  "near", "far"});
    if (object.find("matrix")) return camera_by_matrix(object, sees_all);
    const float fov = degrees_in(object, "fov", default_vertical_fov);
    Camera camera;
    float depth = 0.0F;  // From the eye to what it looks at.
    if (object.find("eye") || object.find("target")) {
        for (const char* key : {"azimuth", "elevation", "distance_factor"}) {
            if (const auto extra = object.find(key))
                extra->fail("says where the camera stands, and so does 'eye'");
        }
        const glm::vec3 eye = object.at("eye").vector();
        const glm::vec3 forward = vector_in(object, "target", glm::vec3(0.0F)) - eye;
        depth = glm::length(forward);
        if (!(depth > 0.0F)) object.at("eye").fail("is where the target is");
        camera.world_from_view = looking_along(eye, forward);
    } else {
        camera = framed(scene, degrees_in(object, "azimuth", 0.523598776F),
                        degrees_in(object, "elevation", 0.34906585F), fov, aspect,
                        number_in(object, "distance_factor", 1.0F));
        depth = 0.5F * (camera.near + camera.far);
    }
    camera.vertical_fov = fov;
    // Things may move towards the eye later.
    camera.near = number_in(object, "near", 0.01F * depth);
    sees_all = !object.find("far");
    camera.far = number_in(object, "far", std::max(camera.far, 2.0F * camera.near));
    return camera;
}

}  // namespace relief
