// SPDX-License-Identifier: Apache-2.0
// Scene files, version 1: a tree of nodes with models, shapes, lights and motions; materials by
// name; surroundings. World space, y up; degrees in the file, radians here. Unknown members, wrong
// types and missing files throw FileError with the place as a JSON pointer.
// Format: docs/scene-files.md. Tests: tests/shade/scene/scene_json_test.cpp.
#include "scene/scene_json.h"

#include <fmt/format.h>

#include "file_bytes.h"
#include "relief/mesh/error.h"
#include "relief/mesh/shapes.h"
#include "relief/shade/name_materials.h"
#include "scene/append_graph.h"
#include "scene/json_lights.h"

namespace relief {

namespace {

constexpr int version = 1;
constexpr int most_pixels = 16384;
/// Nodes below nodes: more than any scene needs, and less than a stack holds.
constexpr int most_levels = 200;

/// "sphere", or {"sphere": {"slices": 12}}.
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
        // The shapes' own limits, at this place; a place that is named already stays.
        if (std::string_view(error.what()).starts_with('/')) throw;
        cursor.fail(error.what());
    }
    cursor.fail_unknown(name, known);
}

/// [x, y, z, w], or {"axis": [0, 1, 0], "angle": 90}.
glm::quat rotation_from(const JsonCursor& cursor) {
    if (cursor.is_array()) {
        const std::vector<float> q = cursor.numbers(4);
        if (q[0] == 0.0F && q[1] == 0.0F && q[2] == 0.0F && q[3] == 0.0F)
            cursor.fail("must have a length");
        return {q[3], q[0], q[1], q[2]};
    }
    cursor.allow({"axis", "angle"});
    const glm::vec3 axis = cursor.at("axis").vector();
    if (axis == glm::vec3(0.0F)) cursor.at("axis").fail("must have a length");
    return glm::angleAxis(glm::radians(cursor.at("angle").number()), glm::normalize(axis));
}

SceneNode place_from(const JsonCursor& object) {
    SceneNode node;
    if (const auto name = object.find("name")) node.name = name->text();
    if (const auto matrix = object.find("matrix")) {
        for (const char* key : {"translation", "rotation", "scale"}) {
            if (const auto part = object.find(key)) part->fail("says what 'matrix' says already");
        }
        const std::vector<float> values = matrix->numbers(16);
        node.matrix.emplace();
        for (std::size_t i = 0; i < 16; ++i)
            (*node.matrix)[static_cast<int>(i / 4)][static_cast<int>(i % 4)] = values[i];
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
        : folder_(file.parent_path()),
          options_(options),
          report_(report),
          images_(file, graph_.scene.images) {}

    SceneGraph read(const JsonCursor& root) {
        root.allow({"relief_scene", "description", "materials", "nodes", "lights", "camera",
                    "ambient", "environment", "background", "exposure", "tone_mapping",
                    "light_markers", "picture", "material_edits", "only_lights"});
        if (root.at("relief_scene").whole_number(0, 1000000) != version)
            root.at("relief_scene").fail(fmt::format("must be {}, the only version", version));
        if (const auto description = root.find("description")) (void)description->text();
        read_materials(root);
        read_surroundings(root);
        if (const auto nodes = root.find("nodes")) {
            for (const JsonCursor& node : nodes->elements())
                read_node(node, std::nullopt, 1);
        }
        if (const auto lights = root.find("lights")) {
            for (const JsonCursor& light : lights->elements())
                add_light(light, std::nullopt, graph_);
        }
        read_only_lights(root);
        read_material_edits(root);
        pose(graph_, 0.0);
        read_camera(root);
        if (const auto radius = root.find("light_markers"))
            add_light_markers(graph_, radius->number(1e-30F));
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

    /// One of the file's, one of the classic table, or one written here.
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

    /// What an editor has changed of all materials, in their order.
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

    /// Lights that take the place of all others; of ambient light, only the file's own stays.
    void read_only_lights(const JsonCursor& root) {
        const auto lights = root.find("only_lights");
        if (!lights) return;
        Scene& scene = graph_.scene;
        scene.directional_lights.clear();
        scene.point_lights.clear();
        scene.spot_lights.clear();
        graph_.directional_lights.clear();
        graph_.point_lights.clear();
        graph_.spot_lights.clear();
        const auto ambient = root.find("ambient");
        scene.ambient = ambient ? color_in(*ambient) : glm::vec3(0.0F);
        for (const JsonCursor& light : lights->elements())
            add_light(light, std::nullopt, graph_);
    }

    void read_surroundings(const JsonCursor& root) {
        Scene& scene = graph_.scene;
        if (const auto ambient = root.find("ambient")) scene.ambient = color_in(*ambient);
        if (const auto environment = root.find("environment"))
            scene.environment = environment_from(*environment, images_);
        if (const auto background = root.find("background")) {
            const bool has_alpha = background->is_array() && background->elements().size() == 4;
            if (has_alpha) {
                const std::vector<float> c = background->numbers(4);
                scene.background = {c[0], c[1], c[2], c[3]};
            } else {
                scene.background = glm::vec4(color_in(*background), 1.0F);
            }
        }
        if (const auto exposure = root.find("exposure"))
            scene.exposure = exposure->number(0.0F, max_reflectance);
        if (const auto mapping = root.find("tone_mapping"))
            scene.tone_mapping = one_of(*mapping, tone_mapping_words);
        if (const auto picture = root.find("picture")) {
            picture->allow({"width", "height"});
            graph_.picture_size = glm::ivec2(picture->at("width").whole_number(1, most_pixels),
                                             picture->at("height").whole_number(1, most_pixels));
        }
    }

    void read_node(const JsonCursor& object, std::optional<std::size_t> parent, int level) {
        if (level > most_levels)
            object.fail(fmt::format("lies more than {} levels deep", most_levels));
        object.allow({"name", "translation", "rotation", "scale", "matrix", "model", "shape",
                      "material", "material_changes", "light", "camera", "orbit", "turntable",
                      "children"});
        const std::size_t index = graph_.nodes.size();
        graph_.nodes.push_back(place_from(object));
        graph_.nodes.back().parent = parent;
        read_meshes(object, index);
        if (const auto light = object.find("light")) add_light(*light, index, graph_);
        if (const auto camera = object.find("camera")) read_node_camera(*camera, index);
        read_motions(object, index);
        if (const auto children = object.find("children")) {
            for (const JsonCursor& child : children->elements())
                read_node(child, index, level + 1);
        }
    }

    void read_meshes(const JsonCursor& object, std::size_t node) {
        const auto model = object.find("model");
        const auto shape = object.find("shape");
        if (model && shape) shape->fail("stands beside 'model': a node has one of them");
        if (!model && !shape) {
            for (const char* key : {"material", "material_changes"}) {
                if (const auto extra = object.find(key))
                    extra->fail("needs a 'model' or a 'shape' beside it");
            }
            return;
        }
        const std::size_t first_mesh = graph_.scene.meshes.size();
        const std::size_t first_material = graph_.scene.materials.size();
        if (model) {
            append(graph_, model_from(*model), node);
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

    SceneGraph model_from(const JsonCursor& cursor) {
        const std::filesystem::path file = images_.file(cursor);
        if (file.extension() == ".json") cursor.fail("is a scene file, which scenes do not nest");
        try {
            return load_scene_graph(file, options_, report_);
        } catch (const FileError& error) {
            cursor.fail(error.what());
        }
    }

    /// Puts one material on all meshes from this one on.
    void use_material(std::size_t first_mesh, std::uint32_t material) {
        for (std::size_t i = first_mesh; i < graph_.scene.meshes.size(); ++i) {
            Mesh& mesh = graph_.scene.meshes[i].edit();
            mesh.material_ranges = {
                {0, static_cast<std::uint32_t>(mesh.triangles.size()), material}};
        }
    }

    void read_node_camera(const JsonCursor& object, std::size_t node) {
        if (graph_.scene.camera) object.fail("is the second camera of the scene");
        graph_.scene.camera = node_camera_from(object, graph_.camera_sees_all);
        graph_.camera = Carried{node};
    }

    void read_camera(const JsonCursor& root) {
        const auto camera = root.find("camera");
        if (!camera) return;
        if (graph_.scene.camera) camera->fail("is the second camera: a node has one already");
        const glm::vec2 size(graph_.picture_size.value_or(glm::ivec2(1)));
        graph_.scene.camera =
            camera_from(*camera, graph_.scene, size.x / size.y, graph_.camera_sees_all);
    }

    void read_motions(const JsonCursor& object, std::size_t node) {
        if (const auto orbit = object.find("orbit")) {
            orbit->allow({"center", "radius", "azimuth", "elevation", "azimuth_speed",
                          "elevation_speed", "faces_center"});
            Orbit motion{.node = node};
            motion.center = vector_in(*orbit, "center", motion.center);
            if (const auto radius = orbit->find("radius")) motion.radius = radius->number(0.0F);
            motion.azimuth = degrees_in(*orbit, "azimuth", motion.azimuth);
            motion.elevation = degrees_in(*orbit, "elevation", motion.elevation);
            motion.azimuth_speed = degrees_in(*orbit, "azimuth_speed", motion.azimuth_speed);
            motion.elevation_speed = degrees_in(*orbit, "elevation_speed", motion.elevation_speed);
            if (const auto faces = orbit->find("faces_center"))
                motion.faces_center = faces->boolean();
            graph_.animations.emplace_back(motion);
        }
        if (const auto turntable = object.find("turntable")) {
            turntable->allow({"axis", "speed", "angle"});
            Turntable motion{.node = node};
            motion.axis = vector_in(*turntable, "axis", motion.axis);
            motion.speed = degrees_in(*turntable, "speed", motion.speed);
            motion.angle = degrees_in(*turntable, "angle", motion.angle);
            if (motion.axis == glm::vec3(0.0F)) turntable->at("axis").fail("must have a length");
            graph_.animations.emplace_back(motion);
        }
    }

    std::filesystem::path folder_;
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

}  // namespace relief
