// SPDX-License-Identifier: Apache-2.0
// Checks every index and number of a scene and of its graph that drawing and poses rely on, and
// names the first offence as thing, value and limit. The ranges of fields stand in scene_fields.h.
// Nothing is repaired.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "relief/mesh/report.h"
#include "relief/shade/frame_settings.h"
#include "relief/shade/scene_fields.h"
#include "scene/scene_parts.h"

namespace relief::shade {
using namespace relief::detail;
using namespace relief::shade::detail;

// Fields by their descriptions

namespace {

std::string text(const glm::vec3& v) {
    return fmt::format("({}, {}, {})", v.x, v.y, v.z);
}

void check_index(const std::string& thing, const char* names, std::size_t index, std::size_t size) {
    if (index >= size) {
        throw InvalidInput(
            fmt::format("{} names {} {}, but there are only {}", thing, names, index, size));
    }
}

void check_finite(const std::string& thing, const glm::mat4& matrix) {
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) {
            if (!std::isfinite(matrix[column][row])) {
                throw InvalidInput(fmt::format("{}: row {}, column {} is {}, but must be finite",
                                               thing, row, column, matrix[column][row]));
            }
        }
    }
}

/// Checks the fields of a value by their descriptions.
class FieldChecker {
  public:
    /// \param owner        begins every message: "material 'paint': "
    /// \param image_count  limits the images of textures
    FieldChecker(std::string owner, std::size_t image_count)
        : owner_(std::move(owner)), image_count_(image_count) {}

    template <typename Owner>
    void check(const Owner& value) const {
        for_each_field<Owner>([&](const auto& field) { check_value(field, value.*field.member); });
    }

    template <typename Field, typename Value>
    void check_value(const Field& field, const std::optional<Value>& value) const {
        if (value) check_value(field, *value);
    }

    template <typename Field>
    void check_value(const Field& field, float value) const {
        if (field.range == positive_range) {
            if (value > 0.0F && std::isfinite(value)) return;
            fail(field, value, "must be positive and finite");
        }
        if (value >= field.range.min && value <= field.range.max) return;
        constexpr FieldRange unlimited;
        fail(field, value,
             field.range == unlimited ? "must be finite"
             : field.range.max == unlimited.max
                 ? fmt::format("must be finite and at least {}", field.range.min)
                 : fmt::format("must be within [{}, {}]", field.range.min, field.range.max));
    }

    template <typename Field>
    void check_value(const Field& field, int value) const {
        check_value(field, static_cast<float>(value));
    }

    template <typename Field>
    void check_value(const Field& field, const glm::vec3& value) const {
        if (field.unit == FieldUnit::color) {
            for (int i = 0; i < 3; ++i) {
                if (value[i] >= field.range.min && value[i] <= field.range.max) continue;
                fail(field, text(value),
                     fmt::format("every channel must be within [{}, {}]", field.range.min,
                                 field.range.max));
            }
            return;
        }
        if (!is_finite(value)) fail(field, text(value), "must be finite");
        if (field.unit == FieldUnit::world_direction && value == glm::vec3(0.0F))
            fail(field, text(value), "must have a length");
    }

    template <typename Field>
    void check_value(const Field& field, const glm::vec4& value) const {
        check_value(field, glm::vec3(value));
        if (value.a >= 0.0F && value.a <= 1.0F) return;
        throw InvalidInput(fmt::format("{}{} alpha is {}, but must be within [0, 1]", owner_,
                                       field.label(), value.a));
    }

    template <typename Field>
    void check_value(const Field& field, const Texture& texture) const {
        check_index(owner_ + field.label(), "image", texture.image, image_count_);
    }

    /// A value with fields of its own; names, flags and enumerations are always valid.
    template <typename Field, typename Value>
    void check_value(const Field& /*field*/, const Value& value) const {
        if constexpr (has_fields<Value>) check(value);
    }

  private:
    template <typename Field, typename Value>
    [[noreturn]] void fail(const Field& field, const Value& value, const std::string& rule) const {
        throw InvalidInput(fmt::format("{}{} is {}, but {}", owner_, field.label(), value, rule));
    }

    std::string owner_;
    std::size_t image_count_;
};

}  // namespace

// Scenes

namespace {

/// Checks a material: its fields, and what contradicts another field.
void validate_material(const Scene& scene, std::size_t index) {
    const Material& material = scene.materials[index];
    const std::string thing = material_label(scene, index) + ": ";
    FieldChecker(thing, scene.images.size()).check(material);
    if (material.normal_map && material.bump_map)
        throw InvalidInput(thing + "has a normal map and a bump map, but one normal");
    if (!material.metallic_roughness) return;
    if (material.interpolation == Interpolation::gouraud) {
        throw InvalidInput(thing +
                           "is metallic-roughness, which varies by pixel, and asks for Gouraud "
                           "shading, which does not");
    }
    if (material.transmission > 0.0F) {
        throw InvalidInput(thing +
                           "is metallic-roughness and transmits, which only Phong's model does");
    }
}

void check_cones(const FieldChecker& checker, const std::string& thing, const SpotLight& light) {
    checker.check_value(outer_cone_field, light.outer_cone);
    if (light.inner_cone >= 0.0F && light.inner_cone < light.outer_cone) return;
    throw InvalidInput(
        fmt::format("{}inner cone is {}, but must be at least 0 and below its outer cone {}", thing,
                    light.inner_cone, light.outer_cone));
}

template <typename Light>
void validate_lights(const char* kind, const std::vector<Light>& lights) {
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const std::string thing = fmt::format("{} light {} ", kind, i);
        const FieldChecker checker(thing, 0);
        if constexpr (std::is_same_v<Light, SpotLight>) check_cones(checker, thing, lights[i]);
        checker.check(lights[i]);
    }
}

void check_count(const std::string& thing, std::size_t count, std::size_t allowed,
                 const char* what) {
    if (count == allowed) return;
    throw InvalidInput(fmt::format("{} has {} {}, but needs {}", thing, count, what, allowed));
}

/// Checks that the vertices of a mesh have all displacements and weights of its deformation.
void validate_deformation(const std::string& thing, const GltfDeformation& deformation,
                          std::size_t vertices) {
    for (const GltfMorphTarget& target : deformation.targets) {
        for (const auto* values : {&target.positions, &target.normals, &target.tangents}) {
            if (!values->empty()) check_count(thing, values->size(), vertices, "displacements");
        }
    }
    for (const GltfJoints& joints : deformation.joints) {
        check_count(thing, joints.joints.size(), vertices, "groups of joints");
        check_count(thing, joints.weights.size(), vertices, "groups of weights");
    }
}

void validate_instance(const Scene& scene, std::size_t index) {
    const Instance& instance = scene.instances[index];
    const std::string thing = instance_label(scene, index);
    check_index(thing, "mesh", instance.mesh, scene.meshes.size());
    check_finite(thing + " matrix", instance.world_from_object);
    if (instance.pose) {
        validate_deformation(thing, instance.pose->deformation,
                             scene.meshes[instance.mesh]->positions.size());
    }
    const std::vector<float>& shares = instance.open_shares;
    if (!shares.empty()) {
        check_count(thing, shares.size(), scene.meshes[instance.mesh]->positions.size(),
                    "open shares");
        const auto is_share = [](float share) { return share >= 0.0F && share <= 1.0F; };
        const auto wrong = std::find_if_not(shares.begin(), shares.end(), is_share);
        if (wrong != shares.end()) {
            throw InvalidInput(
                fmt::format("{}: the open share of vertex {} is {}, but must be within [0, 1]",
                            thing, wrong - shares.begin(), *wrong));
        }
    }
    for (const MaterialRange& range : scene.meshes[instance.mesh]->material_ranges) {
        if (range.material) {
            check_index(thing, "material", *range.material, scene.materials.size());
        }
    }
}

}  // namespace

void detail::check_field_of_view(const std::string& owner, float vertical_fov) {
    const SceneField field = field_of(&Camera::vertical_fov);
    if (vertical_fov > field.range.min && vertical_fov < field.range.max) return;
    throw InvalidInput(
        fmt::format("{}{} is {}, but must be within (0, pi)", owner, field.label(), vertical_fov));
}

void validate(const Camera& camera) {
    check_finite("camera matrix", camera.world_from_view);
    check_field_of_view("camera: ", camera.vertical_fov);
    if (!(camera.near > 0.0F && camera.near < camera.far && std::isfinite(camera.far))) {
        throw InvalidInput(
            fmt::format("camera: near is {} and far is {}, but must be 0 < near < "
                        "far and finite",
                        camera.near, camera.far));
    }
    if (!camera.orthographic_height) return;
    const float height = *camera.orthographic_height;
    if (!(height > 0.0F && std::isfinite(height))) {
        throw InvalidInput(fmt::format(
            "camera: orthographic_height is {}, but must be positive and finite", height));
    }
}

void validate_transforms(const Scene& scene) {
    for (std::size_t i = 0; i < scene.instances.size(); ++i)
        validate_instance(scene, i);
    FieldChecker("", 0).check_value(ambient_field, scene.ambient);
    validate_lights("directional", scene.directional_lights);
    validate_lights("point", scene.point_lights);
    validate_lights("spot", scene.spot_lights);
}

void validate(const Scene& scene) {
    for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
        try {
            validate(scene.meshes[i]);
        } catch (const InvalidInput& error) {
            throw InvalidInput(fmt::format("{}: {}", mesh_label(scene, i), error.what()));
        }
    }
    for (std::size_t i = 0; i < scene.materials.size(); ++i)
        validate_material(scene, i);
    validate_transforms(scene);
    if (scene.camera) validate(*scene.camera);
    FieldChecker("", 0).check(scene);
}

// Scene graphs

namespace {

std::string node_label(const SceneGraph& graph, std::size_t node) {
    const std::string& name = graph.nodes[node].name;
    return name.empty() ? fmt::format("node {}", node) : fmt::format("node '{}'", name);
}

void check_node(const SceneGraph& graph, const std::string& thing, std::size_t node) {
    if (node >= graph.nodes.size()) {
        throw InvalidInput(fmt::format("{} names node {}, but there are only {}", thing, node,
                                       graph.nodes.size()));
    }
}

void validate_node(const SceneGraph& graph, std::size_t index) {
    const SceneNode& node = graph.nodes[index];
    const std::string thing = node_label(graph, index);
    if (node.parent) check_node(graph, thing + "'s parent", *node.parent);
    const glm::quat& q = node.rotation;
    const bool finite = is_finite(node.translation) && is_finite(node.scale) &&
                        is_finite(glm::vec3(q.x, q.y, q.z)) && std::isfinite(q.w) &&
                        (!node.matrix || is_finite(*node.matrix));
    if (!finite) throw InvalidInput(thing + " has a transform that is not finite");
    if (!(glm::length(q) > 0.0F)) throw InvalidInput(thing + " has a rotation without a length");
}

/// Checks that every chain of parents ends. Each node is passed once.
void validate_parents(const SceneGraph& graph) {
    const std::size_t count = graph.nodes.size();
    std::vector<bool> ends(count, false);
    std::vector<std::size_t> chain;
    for (std::size_t i = 0; i < count; ++i) {
        chain.clear();
        for (std::optional<std::size_t> next = i; next && !ends[*next];
             next = graph.nodes[*next].parent) {
            if (chain.size() == count)
                throw InvalidInput(node_label(graph, i) + " is its own ancestor");
            chain.push_back(*next);
        }
        for (const std::size_t node : chain)
            ends[node] = true;
    }
}

void validate_carried(const SceneGraph& graph, const char* things,
                      const std::vector<Carried>& carried, std::size_t count) {
    if (carried.size() > count) {
        throw InvalidInput(
            fmt::format("nodes carry {} {}, but there are only {}", carried.size(), things, count));
    }
    for (std::size_t i = 0; i < carried.size(); ++i) {
        const std::string thing = fmt::format("number {} of the {}", i, things);
        if (carried[i].node) check_node(graph, thing, *carried[i].node);
        if (!is_finite(carried[i].node_from_object))
            throw InvalidInput(thing + " has a matrix that is not finite");
    }
}

/// An animation of translation, rotation or scale needs a node that has them.
void check_parts(const SceneGraph& graph, const std::string& thing, std::size_t node) {
    check_node(graph, thing, node);
    if (graph.nodes[node].matrix) {
        throw InvalidInput(
            fmt::format("{} moves {}, which has a matrix instead of translation, "
                        "rotation and scale",
                        thing, node_label(graph, node)));
    }
}

void validate_motion(const SceneGraph& graph, const std::string& thing,
                     const KeyAnimation& animation) {
    for (const KeyChannel& channel : animation.channels) {
        if (channel.property == KeyChannel::Property::weights) {
            check_node(graph, thing, channel.node);
        } else if (channel.property != KeyChannel::Property::pointer) {
            check_parts(graph, thing, channel.node);
        }
        try {
            if (channel.property == KeyChannel::Property::pointer) check_pointer(graph, channel);
            check_keys(channel);
        } catch (const InvalidInput& error) {
            throw InvalidInput(thing + ": " + error.what());
        }
    }
}

void validate_motion(const SceneGraph& graph, const std::string& thing, const Orbit& orbit) {
    check_parts(graph, thing, orbit.node);
    FieldChecker(thing + ": ", 0).check(orbit);
}

void validate_motion(const SceneGraph& graph, const std::string& thing,
                     const Turntable& turntable) {
    check_node(graph, thing, turntable.node);
    FieldChecker(thing + ": ", 0).check(turntable);
}

}  // namespace

namespace {

/// Checks that the instance can be deformed, and that joints are nodes.
void validate_deformed(const SceneGraph& graph, const DeformedInstance& deformed,
                       std::size_t number) {
    const std::string thing = fmt::format("deformed instance {}", number);
    const std::vector<Instance>& instances = graph.scene.instances;
    if (deformed.instance >= instances.size() || !instances[deformed.instance].pose)
        throw InvalidInput(thing + " has no instance with a pose in the scene");
    check_count(thing, deformed.joint_from_mesh.size(), deformed.joints.size(), "joint matrices");
    check_node(graph, thing, deformed.node);
    for (const std::size_t joint : deformed.joints)
        check_node(graph, thing, joint);
}

}  // namespace

void validate(const SceneGraph& graph) {
    for (std::size_t i = 0; i < graph.nodes.size(); ++i)
        validate_node(graph, i);
    validate_parents(graph);
    const Scene& scene = graph.scene;
    validate_carried(graph, "instances", graph.instances, scene.instances.size());
    validate_carried(graph, "directional lights", graph.directional_lights,
                     scene.directional_lights.size());
    validate_carried(graph, "point lights", graph.point_lights, scene.point_lights.size());
    validate_carried(graph, "spot lights", graph.spot_lights, scene.spot_lights.size());
    validate_carried(graph, "cameras", {graph.camera}, 1);
    for (std::size_t i = 0; i < graph.animations.size(); ++i) {
        const std::string thing = fmt::format("animation {}", i);
        std::visit([&](const auto& motion) { validate_motion(graph, thing, motion); },
                   graph.animations[i]);
    }
    for (std::size_t i = 0; i < graph.deformed.size(); ++i)
        validate_deformed(graph, graph.deformed[i], i);
    validate(scene);
}

}  // namespace relief::shade
