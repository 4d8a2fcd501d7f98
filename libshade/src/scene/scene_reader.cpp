// SPDX-License-Identifier: Apache-2.0
// Reads scene files, version 1: a tree of nodes with models, shapes, lights and motions; materials
// by name; an environment, a camera. World space, y up; degrees in the file, radians here. Unknown
// members, wrong types and missing files throw FileError with the place as a JSON pointer.
// docs/scene-files.md describes the format.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numbers>

#include "files.h"
#include "portable_math.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"
#include "relief/shade/scene.h"
#include "relief/shade/scene_graph.h"
#include "scene/json_fields.h"
#include "scene/scene_parts.h"

namespace relief::shade::detail {
using namespace relief::detail;

namespace {

constexpr int format_version = 1;
constexpr int max_picture_side = 16384;
/// The depth of nested nodes: more than any scene needs, and less than the stack holds.
constexpr int max_node_levels = 200;
constexpr double radians_per_degree = std::numbers::pi / 180.0;

float number_in(const JsonCursor& object, const char* key, float absent) {
    const auto found = object.find(key);
    return found ? found->number() : absent;
}

float degrees_in(const JsonCursor& object, const char* key, float absent_radians) {
    const auto found = object.find(key);
    return found ? radians_from(*found) : absent_radians;
}

glm::vec3 vector_in(const JsonCursor& object, const char* key, const glm::vec3& absent) {
    const auto found = object.find(key);
    return found ? found->vector() : absent;
}

// Lights and cameras

/// Refuses members that this type of light does not have.
template <typename Light>
void check_light_members(const JsonCursor& object) {
    allow_fields<Light>(object, {"type", "intensity", "diffuse"});
    if (object.find("color") && object.find("diffuse"))
        object.at("diffuse").fail("means the same as 'color': give one of them");
}

/// Completes the colors of a light whose fields have been read: "diffuse" is another name of
/// "color", and "intensity" multiplies all colors.
void finish_colors(const JsonCursor& object, glm::vec3& diffuse, std::optional<glm::vec3>& specular,
                   glm::vec3& ambient) {
    const float intensity = number_in(object, "intensity", 1.0F);
    if (const auto color = object.find("diffuse")) diffuse = color_in(*color);
    diffuse *= intensity;
    if (specular) specular = intensity * *specular;
    ambient *= intensity;
}

/// A light without "direction" shines along its node's -z.
void check_direction(const JsonCursor& object, bool is_on_node, glm::vec3& direction) {
    if (object.find("direction")) return;
    if (!is_on_node) object.fail("has no 'direction', which a light without a node needs");
    direction = {0.0F, 0.0F, -1.0F};
}

void hang(std::vector<Carried>& carried, std::size_t index, std::optional<std::size_t> node,
          const glm::mat4& node_from_light) {
    carried.resize(index);
    carried.push_back({node, node_from_light});
}

/// Adds a light on a node, or without one in the world.
void add_light(const JsonCursor& object, std::optional<std::size_t> node, JsonImages& images,
               SceneGraph& graph) {
    const LightType type = one_of(object.at("type"), enum_names<LightType>);
    Scene& scene = graph.scene;
    if (type == LightType::directional) {
        check_light_members<DirectionalLight>(object);
        DirectionalLight light;
        check_direction(object, node.has_value(), light.direction_world);
        read_fields(object, images, light);
        finish_colors(object, light.irradiance, light.highlight_irradiance, light.ambient);
        hang(graph.directional_lights, scene.directional_lights.size(), node,
             looking_along(glm::vec3(0.0F), light.direction_world));
        scene.directional_lights.push_back(light);
    } else if (type == LightType::point) {
        check_light_members<PointLight>(object);
        PointLight light;
        read_fields(object, images, light);
        finish_colors(object, light.intensity, light.highlight_intensity, light.ambient);
        hang(graph.point_lights, scene.point_lights.size(), node,
             looking_along(light.position_world, {0.0F, 0.0F, -1.0F}));
        scene.point_lights.push_back(light);
    } else {
        check_light_members<SpotLight>(object);
        SpotLight light;
        check_direction(object, node.has_value(), light.direction_world);
        read_fields(object, images, light);
        finish_colors(object, light.point.intensity, light.point.highlight_intensity,
                      light.point.ambient);
        hang(graph.spot_lights, scene.spot_lights.size(), node,
             looking_along(light.point.position_world, light.direction_world));
        scene.spot_lights.push_back(light);
    }
}

/// Sets the field of view and the depth range. \param sees_all  set where "far" is absent
Camera node_camera_from(const JsonCursor& object, JsonImages& images, bool& sees_all) {
    object.allow(field_names<Camera>());
    Camera camera;
    read_fields(object, images, camera);
    sees_all = !object.find("far");
    if (sees_all) camera.far = 2.0F * camera.near;
    return camera;
}

/// Returns a camera that save_scene() wrote: its matrix and depth range, without loss.
Camera camera_by_matrix(const JsonCursor& object, JsonImages& images, bool& sees_all) {
    for (const char* key : {"eye", "target", "azimuth", "elevation", "distance_factor"}) {
        if (const auto extra = object.find(key))
            extra->fail("sets the camera's transform, as 'matrix' does: give one of them");
    }
    Camera camera;
    camera.world_from_view = matrix_from(object.at("matrix"));
    camera.vertical_fov = default_vertical_fov;
    (void)object.at("near");
    (void)object.at("far");
    read_fields(object, images, camera);
    sees_all = false;
    return camera;
}

/// Returns the camera of the scene: from "eye" to "target", or framing the scene in its pose at
/// time 0.
/// \param aspect  of the picture
Camera camera_from(const JsonCursor& object, const Scene& scene, float aspect, JsonImages& images,
                   bool& sees_all) {
    allow_fields<Camera>(object,
                         {"eye", "target", "azimuth", "elevation", "distance_factor", "matrix"});
    if (object.find("matrix")) return camera_by_matrix(object, images, sees_all);
    Camera given;
    given.vertical_fov = default_vertical_fov;
    read_fields(object, images, given);
    Camera camera;
    float depth = 0.0F;  // From the eye to the target.
    if (object.find("eye") || object.find("target")) {
        for (const char* key : {"azimuth", "elevation", "distance_factor"}) {
            if (const auto extra = object.find(key))
                extra->fail("sets the camera's transform, as 'eye' does: give one of them");
        }
        const glm::vec3 eye = object.at("eye").vector();
        const glm::vec3 forward = vector_in(object, "target", glm::vec3(0.0F)) - eye;
        depth = glm::length(forward);
        if (!(depth > 0.0F)) object.at("eye").fail("is at the target");
        camera.world_from_view = looking_along(eye, forward);
    } else {
        camera = framed(scene, degrees_in(object, "azimuth", default_azimuth),
                        degrees_in(object, "elevation", default_elevation), given.vertical_fov,
                        aspect, number_in(object, "distance_factor", 1.0F));
        depth = 0.5F * (camera.near + camera.far);
    }
    camera.vertical_fov = given.vertical_fov;
    camera.orthographic_height = given.orthographic_height;
    // The near plane is close, since objects may move towards the eye later.
    camera.near = object.find("near") ? given.near : 0.01F * depth;
    sees_all = !object.find("far");
    camera.far = sees_all ? std::max(camera.far, 2.0F * camera.near) : given.far;
    return camera;
}

// Nodes

/// Reads "sphere", or {"sphere": {"slices": 12}}.
Mesh shape_from(const JsonCursor& cursor) {
    static const std::vector<std::string> known = {"quad", "sphere", "cube", "torus", "cylinder"};
    const std::vector<std::string> keys =
        cursor.is_object() ? cursor.keys() : std::vector{cursor.text()};
    if (keys.size() != 1) cursor.fail("must name one shape");
    const std::string& name = keys.front();
    const auto count = [&](const char* key, int absent) {
        if (!cursor.is_object()) return absent;
        const auto found = cursor.at(name).find(key);
        return found ? found->whole_number(1, 4096) : absent;
    };
    const auto allow = [&](std::initializer_list<const char*> members) {
        if (cursor.is_object()) cursor.at(name).allow(members);
    };
    try {
        if (name == "quad") {
            allow({"cells"});
            return make_quad(count("cells", 1));
        }
        if (name == "sphere") {
            allow({"slices", "stacks"});
            return make_sphere(count("slices", 64), count("stacks", 32));
        }
        if (name == "cube") {
            allow({});
            return make_cube();
        }
        if (name == "torus") {
            allow({"tube_radius", "slices", "sides"});
            const float radius =
                cursor.is_object() ? number_in(cursor.at(name), "tube_radius", 0.4F) : 0.4F;
            return make_torus(radius, count("slices", 96), count("sides", 48));
        }
        if (name == "cylinder") {
            allow({"slices"});
            return make_cylinder(count("slices", 64));
        }
    } catch (const InvalidInput& error) {
        // Limits of the shape functions get this place; an error that has a place keeps it.
        if (std::string_view(error.what()).starts_with('/')) throw;
        cursor.fail(error.what());
    }
    cursor.fail_unknown(name, known);
}

/// Reads [x, y, z, w], or {"axis": [0, 1, 0], "angle": 90}.
glm::quat rotation_from(const JsonCursor& cursor) {
    if (cursor.is_array()) {
        const std::vector<float> q = cursor.numbers(4);
        if (q[0] == 0.0F && q[1] == 0.0F && q[2] == 0.0F && q[3] == 0.0F)
            cursor.fail("must have a length");
        return {q[3], q[0], q[1], q[2]};
    }
    cursor.allow({"axis", "angle"});
    const glm::vec3 axis = direction_from(cursor.at("axis"));
    const double half = 0.5 * static_cast<double>(glm::radians(cursor.at("angle").number()));
    return {static_cast<float>(portable::cos(half)),
            static_cast<float>(portable::sin(half)) * glm::normalize(axis)};
}

/// Returns the name and the transform of a node.
SceneNode node_from(const JsonCursor& object) {
    SceneNode node;
    if (const auto name = object.find("name")) node.name = name->text();
    if (const auto matrix = object.find("matrix")) {
        for (const char* key : {"translation", "rotation", "scale"}) {
            if (const auto part = object.find(key)) part->fail("is already contained in 'matrix'");
        }
        node.matrix = matrix_from(*matrix);
    }
    node.translation = vector_in(object, "translation", node.translation);
    if (const auto rotation = object.find("rotation")) node.rotation = rotation_from(*rotation);
    if (const auto scale = object.find("scale"))
        node.scale = scale->is_number() ? glm::vec3(scale->number()) : scale->vector();
    return node;
}

/// Reads one file into a graph.
class SceneReader {
  public:
    SceneReader(const std::filesystem::path& file, const SceneOptions& options, Report& report)
        : options_(options), report_(report), images_(file, graph_.scene.images) {}

    SceneGraph read(const JsonCursor& root) {
        allow_fields<Scene>(
            root, {"relief_scene", "description", "materials", "nodes", "lights", "camera",
                   "light_markers", "picture", "material_edits", "only_lights"});
        if (root.at("relief_scene").whole_number(0, 1000000) != format_version) {
            root.at("relief_scene")
                .fail(fmt::format("must be {}, the only version", format_version));
        }
        if (const auto description = root.find("description")) (void)description->text();
        read_materials(root);
        read_fields(root, images_, graph_.scene);
        read_picture(root);
        if (const auto nodes = root.find("nodes")) {
            for (const JsonCursor& node : nodes->elements())
                read_node(node, std::nullopt, 1);
        }
        read_lights(root, "lights");
        read_only_lights(root);
        read_material_edits(root);
        pose(graph_, 0.0);
        read_camera(root);
        if (const auto radius = root.find("light_markers"))
            add_light_markers(graph_, radius->number(positive_range.min));
        return std::move(graph_);
    }

  private:
    void read_materials(const JsonCursor& root) {
        const auto materials = root.find("materials");
        if (!materials) return;
        for (const std::string& name : materials->keys())
            material_index_[name] = add_material(materials->at(name), name);
    }

    std::uint32_t add_material(const JsonCursor& object, const std::string& name) {
        Material material;
        read_material(object, images_, material);
        if (!object.find("name")) material.name = name;
        graph_.scene.materials.push_back(std::move(material));
        return static_cast<std::uint32_t>(graph_.scene.materials.size() - 1);
    }

    /// Returns a material of the file, of the classic table, or written at this place.
    std::uint32_t material_from(const JsonCursor& cursor) {
        if (cursor.is_object()) return add_material(cursor, "");
        const std::string& name = cursor.text();
        if (const auto known = material_index_.find(name); known != material_index_.end())
            return known->second;
        if (const auto classic = material_by_name(name)) {
            graph_.scene.materials.push_back(*classic);
            const auto index = static_cast<std::uint32_t>(graph_.scene.materials.size() - 1);
            material_index_[name] = index;
            return index;
        }
        std::vector<std::string> known = material_names();
        for (const auto& [own, index] : material_index_)
            known.push_back(own);
        cursor.fail_unknown(name, known);
    }

    /// Applies the changes of an editor to all materials, in their order.
    void read_material_edits(const JsonCursor& root) {
        const auto edits = root.find("material_edits");
        if (!edits) return;
        name_default_material(graph_.scene);
        std::vector<Material>& materials = graph_.scene.materials;
        const std::vector<JsonCursor> changes = edits->elements();
        if (changes.size() > materials.size()) {
            edits->fail(fmt::format("changes {} materials, but the scene has {}", changes.size(),
                                    materials.size()));
        }
        for (std::size_t i = 0; i < changes.size(); ++i) {
            if (!changes[i].is_null()) read_material(changes[i], images_, materials[i]);
        }
    }

    void read_lights(const JsonCursor& root, const char* key) {
        const auto lights = root.find(key);
        if (!lights) return;
        for (const JsonCursor& light : lights->elements())
            add_light(light, std::nullopt, images_, graph_);
    }

    /// Replaces all lights.
    void read_only_lights(const JsonCursor& root) {
        if (!root.find("only_lights")) return;
        Scene& scene = graph_.scene;
        scene.directional_lights.clear();
        scene.point_lights.clear();
        scene.spot_lights.clear();
        graph_.directional_lights.clear();
        graph_.point_lights.clear();
        graph_.spot_lights.clear();
        read_lights(root, "only_lights");
    }

    void read_picture(const JsonCursor& root) {
        const auto picture = root.find("picture");
        if (!picture) return;
        picture->allow({"width", "height"});
        graph_.picture_size = glm::ivec2(picture->at("width").whole_number(1, max_picture_side),
                                         picture->at("height").whole_number(1, max_picture_side));
    }

    void read_node(const JsonCursor& object, std::optional<std::size_t> parent, int level) {
        if (level > max_node_levels)
            object.fail(fmt::format("lies more than {} levels deep", max_node_levels));
        object.allow({"name", "translation", "rotation", "scale", "matrix", "model", "shape",
                      "material", "material_variant", "material_changes", "normals", "crease",
                      "light", "camera", "orbit", "turntable", "children"});
        const std::size_t index = graph_.nodes.size();
        graph_.nodes.push_back(node_from(object));
        graph_.nodes.back().parent = parent;
        read_meshes(object, index);
        if (const auto light = object.find("light")) add_light(*light, index, images_, graph_);
        if (const auto camera = object.find("camera")) read_node_camera(*camera, index);
        if (const auto motion = object.find("orbit")) read_motion<Orbit>(*motion, index);
        if (const auto motion = object.find("turntable")) read_motion<Turntable>(*motion, index);
        if (const auto children = object.find("children")) {
            for (const JsonCursor& child : children->elements())
                read_node(child, index, level + 1);
        }
    }

    void read_meshes(const JsonCursor& object, std::size_t node) {
        const auto model = object.find("model");
        const auto shape = object.find("shape");
        if (model && shape) shape->fail("cannot be combined with 'model'");
        if (!model && !shape) {
            for (const char* key :
                 {"material", "material_variant", "material_changes", "normals", "crease"}) {
                if (const auto extra = object.find(key))
                    extra->fail("needs a 'model' or a 'shape'");
            }
            return;
        }
        const std::size_t first_mesh = graph_.scene.meshes.size();
        const std::size_t first_material = graph_.scene.materials.size();
        for (const char* key : {"normals", "crease", "material_variant"}) {
            const auto extra = object.find(key);
            if (extra && !model) extra->fail("needs a 'model'");
        }
        if (model) {
            append(graph_, model_from(object, *model), node);
        } else {
            graph_.instances.resize(graph_.scene.instances.size());
            graph_.scene.instances.push_back(
                {graph_.scene.meshes.size(), glm::mat4(1.0F), graph_.nodes[node].name});
            graph_.instances.push_back({node});
            graph_.scene.meshes.push_back(shape_from(*shape));
        }
        if (const auto changes = object.find("material_changes")) {
            if (!model || object.find("material"))
                changes->fail(
                    "changes the materials of a 'model', so 'material' must not be there");
            for (std::size_t i = first_material; i < graph_.scene.materials.size(); ++i)
                read_material(*changes, images_, graph_.scene.materials[i]);
        }
        if (const auto material = object.find("material"))
            use_material(first_mesh, material_from(*material));
    }

    SceneGraph model_from(const JsonCursor& node, const JsonCursor& cursor) {
        const std::filesystem::path file = images_.file(cursor);
        SceneOptions options = options_;
        options.up = UpAxis::y;
        if (const auto variant = node.find("material_variant")) {
            if (file.extension() != ".gltf" && file.extension() != ".glb")
                variant->fail("needs a glTF model");
            options.material_variant = variant->text();
        }
        if (const auto normals = node.find("normals"))
            options.normals = one_of(*normals, enum_names<NormalMode>);
        if (const auto crease = node.find("crease")) {
            (void)crease->number(0.0F, 180.0F);
            options.crease_angle = crease->exact_number() * radians_per_degree;
        }
        if (file.extension() == ".json") cursor.fail("is a scene file, which scenes do not nest");
        try {
            return load_scene_graph(file, options, report_);
        } catch (const FileError& error) {
            cursor.fail(error.what());
        }
    }

    /// Gives all meshes from this one on one material.
    void use_material(std::size_t first_mesh, std::uint32_t material) {
        for (std::size_t i = first_mesh; i < graph_.scene.meshes.size(); ++i) {
            Mesh& mesh = graph_.scene.meshes[i].edit();
            mesh.material_ranges = {
                {0, static_cast<std::uint32_t>(mesh.triangles.size()), material}};
        }
    }

    void read_node_camera(const JsonCursor& object, std::size_t node) {
        if (graph_.scene.camera) object.fail("is the second camera of the scene");
        graph_.scene.camera = node_camera_from(object, images_, graph_.camera_sees_all);
        graph_.camera = Carried{node};
    }

    void read_camera(const JsonCursor& root) {
        const auto camera = root.find("camera");
        if (!camera) return;
        if (graph_.scene.camera) camera->fail("is a second camera: a node has one already");
        const glm::vec2 size(graph_.picture_size.value_or(glm::ivec2(1)));
        graph_.scene.camera =
            camera_from(*camera, graph_.scene, size.x / size.y, images_, graph_.camera_sees_all);
    }

    template <typename Motion>
    void read_motion(const JsonCursor& object, std::size_t node) {
        object.allow(field_names<Motion>());
        Motion motion{.node = node};
        read_fields(object, images_, motion);
        graph_.animations.emplace_back(motion);
    }

    const SceneOptions& options_;
    Report& report_;
    SceneGraph graph_;
    JsonImages images_;
    std::map<std::string, std::uint32_t> material_index_;
};

}  // namespace

SceneGraph read_scene_json(const std::filesystem::path& file, const SceneOptions& options,
                           Report& report) {
    const std::string text = read_file(file);
    try {
        return SceneReader(file, options, report).read(JsonCursor::parse(text));
    } catch (const InvalidInput& error) {
        throw FileError(file, error.what());
    }
}

}  // namespace relief::shade::detail
