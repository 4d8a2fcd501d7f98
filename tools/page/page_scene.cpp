// SPDX-License-Identifier: Apache-2.0
#include "page_scene.h"

#include <variant>

#include "relief/mesh/mesh.h"
#include "relief/shade/scene_graph.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

Json json_of(const glm::vec3& v) {
    return {v.x, v.y, v.z};
}
Json json_of(const glm::mat4& m) {
    Json numbers = Json::array();
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row)
            numbers.push_back(m[column][row]);
    }
    return numbers;
}

void add_carrier(Json& object, const Carried* carried) {
    if (carried == nullptr || !carried->node) return;
    object["node"] = *carried->node;
    object["fromObject"] = json_of(carried->node_from_object);
    if (carried->position_only) object["positionOnly"] = true;
}

const Carried* carrier_of(const std::vector<Carried>& carried, std::size_t i) {
    return i < carried.size() ? &carried[i] : nullptr;
}

Json point_json(const PointLight& light) {
    return {{"on", light.on},
            {"position", json_of(light.position_world)},
            {"color", json_of(light.intensity)},
            {"specular", light.highlight_intensity ? json_of(*light.highlight_intensity) : Json()},
            {"range", light.range ? Json(*light.range) : Json()},
            {"falloff", light.falloff == Falloff::inverse_square}};
}

Json light_json(const DirectionalLight& light) {
    return {
        {"on", light.on},
        {"direction", json_of(light.direction_world)},
        {"color", json_of(light.irradiance)},
        {"specular", light.highlight_irradiance ? json_of(*light.highlight_irradiance) : Json()}};
}
Json light_json(const PointLight& light) {
    return point_json(light);
}
Json light_json(const SpotLight& light) {
    Json json = point_json(light.point);
    json["direction"] = json_of(light.direction_world);
    json["inner_cone"] = light.inner_cone;
    json["outer_cone"] = light.outer_cone;
    return json;
}

template <typename Light>
Json lights_json(const std::vector<Light>& lights, const std::vector<Carried>& carried) {
    Json list = Json::array();
    for (std::size_t i = 0; i < lights.size(); ++i) {
        list.push_back(light_json(lights[i]));
        add_carrier(list.back(), carrier_of(carried, i));
    }
    return list;
}

Json node_json(const SceneNode& node) {
    Json json = {{"translation", json_of(node.translation)},
                 {"rotation", {node.rotation.x, node.rotation.y, node.rotation.z, node.rotation.w}},
                 {"scale", json_of(node.scale)}};
    if (node.parent) json["parent"] = *node.parent;
    if (node.matrix) json["matrix"] = json_of(*node.matrix);
    return json;
}

Json instance_json(const SceneGraph& graph, std::size_t i) {
    const Instance& instance = graph.scene.instances[i];
    Json json = {{"matrix", json_of(instance.world_from_object)}};
    add_carrier(json, carrier_of(graph.instances, i));
    if (instance.pose) {
        Json joints = Json::array();
        for (const glm::mat4& matrix : instance.pose->joint_matrices)
            joints.push_back(json_of(matrix));
        std::vector<float> weights = instance.pose->weights;
        weights.resize(instance.pose->deformation->targets.size(), 0.0F);
        json["pose"] = {{"weights", weights}, {"joints", joints}};
    }
    const Bounds box = bounds_of(graph.scene.meshes[instance.mesh]);
    json["min"] = json_of(box.empty() ? glm::vec3(0.0F) : box.min);
    json["max"] = json_of(box.empty() ? glm::vec3(0.0F) : box.max);
    return json;
}

/// The values of a channel without the components that its property does not have.
std::vector<float> values_of(const KeyChannel& channel, std::size_t components) {
    std::vector<float> values;
    for (const glm::vec4& value : channel.values) {
        for (std::size_t k = 0; k < components; ++k)
            values.push_back(value[static_cast<int>(k)]);
    }
    return values;
}

Json channel_json(const KeyChannel& channel, PageSections& sections) {
    const bool has_weights = channel.property == KeyChannel::Property::weights;
    const std::size_t keys =
        channel.times.size() * (channel.interpolation == KeyInterpolation::cubic_spline ? 3 : 1);
    std::size_t count = channel.property == KeyChannel::Property::translation ||
                                channel.property == KeyChannel::Property::scale
                            ? 3
                            : 4;
    if (has_weights) count = keys == 0 ? 0 : channel.weights.size() / keys;
    Json json = {
        {"node", channel.node},
        {"property", enum_name(channel.property)},
        {"interpolation", enum_name(channel.interpolation)},
        {"count", count},
        {"times", sections.add(channel.times)},
        {"values", sections.add(has_weights ? channel.weights : values_of(channel, count))}};
    if (channel.property == KeyChannel::Property::pointer) {
        json["pointer"] = channel.pointer;
        const bool is_positive =
            channel.pointer.ends_with("orthographic_height") || channel.pointer.ends_with("range");
        json["min"] = is_positive ? 1e-6 : channel.pointer.ends_with("fov") ? 1e-3 : 0.0;
        json["max"] = channel.pointer.ends_with("cone")  ? 1.5707963
                      : channel.pointer.ends_with("fov") ? 3.1405926
                                                         : 1e18;
    }
    return json;
}

Json animation_json(const Animation& animation, PageSections& sections) {
    if (const auto* keys = std::get_if<KeyAnimation>(&animation)) {
        Json channels = Json::array();
        for (const KeyChannel& channel : keys->channels) {
            const std::string& pointer = channel.pointer;
            if (pointer.starts_with("materials.") || pointer.ends_with("lights.ambient")) continue;
            channels.push_back(channel_json(channel, sections));
        }
        return {{"channels", channels}};
    }
    if (const auto* orbit = std::get_if<Orbit>(&animation)) {
        return {{"orbit", true},
                {"node", orbit->node},
                {"center", json_of(orbit->center)},
                {"radius", orbit->radius},
                {"azimuth", orbit->azimuth},
                {"elevation", orbit->elevation},
                {"azimuthSpeed", orbit->azimuth_speed},
                {"elevationSpeed", orbit->elevation_speed},
                {"facesCenter", orbit->faces_center}};
    }
    const auto& turntable = std::get<Turntable>(animation);
    return {{"turntable", true},
            {"node", turntable.node},
            {"axis", json_of(turntable.axis)},
            {"speed", turntable.speed},
            {"angle", turntable.angle}};
}

Json deformed_json(const DeformedInstance& deformed) {
    Json matrices = Json::array();
    for (const glm::mat4& matrix : deformed.joint_from_mesh)
        matrices.push_back(json_of(matrix));
    return {{"instance", deformed.instance},
            {"node", deformed.node},
            {"weights", deformed.weights},
            {"joints", deformed.joints},
            {"fromMesh", matrices}};
}

Json camera_json(const PageScene& page) {
    const Camera& camera = page.camera;
    Json json = {
        {"matrix", json_of(camera.world_from_view)},
        {"fov", camera.vertical_fov},
        {"near", camera.near},
        {"far", camera.far},
        {"height", camera.orthographic_height ? Json(*camera.orthographic_height) : Json()}};
    if (page.camera_follows_scene) {
        add_carrier(json, &page.graph->camera);
        if (page.graph->camera_sees_all) json["seesAll"] = true;
    }
    return json;
}

std::vector<double> clip_durations(const SceneGraph& graph) {
    std::vector<double> durations;
    SceneGraph copy;
    copy.animations = graph.animations;
    for (std::size_t i = 0; i < clip_names(graph).size(); ++i) {
        copy.clip = i;
        durations.push_back(duration(copy));
    }
    return durations;
}

}  // namespace

std::size_t PageSections::add(std::span<const std::byte> bytes) {
    places_.push_back({bytes_.size(), bytes.size()});
    bytes_.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    bytes_.resize((bytes_.size() + 3) / 4 * 4);
    return places_.size() - 1;
}

Json page_scene_json(const PageScene& page, double seconds, PageSections& sections) {
    const SceneGraph& graph = *page.graph;
    const Scene& scene = graph.scene;
    Json instances = Json::array();
    for (std::size_t i = 0; i < scene.instances.size(); ++i)
        instances.push_back(instance_json(graph, i));
    Json nodes = Json::array();
    Json animations = Json::array();
    Json deformed = Json::array();
    const bool moves = duration(graph) > 0.0;
    if (moves) {
        for (const SceneNode& node : graph.nodes)
            nodes.push_back(node_json(node));
        for (const Animation& animation : graph.animations)
            animations.push_back(animation_json(animation, sections));
        for (const DeformedInstance& each : graph.deformed)
            deformed.push_back(deformed_json(each));
    }
    const Bounds box = world_bounds(scene);
    const glm::vec3 center = box.empty() ? glm::vec3(0.0F) : 0.5F * (box.min + box.max);
    return {{"time", seconds},
            {"duration", duration(graph)},
            {"clip", graph.clip ? Json(*graph.clip) : Json()},
            {"clips", moves ? clip_names(graph) : std::vector<std::string>()},
            {"clipDurations", clip_durations(graph)},
            {"chosenCamera", graph.chosen_camera},
            {"center", json_of(center)},
            {"radius", box.empty() ? 1.0F : 0.5F * glm::distance(box.min, box.max)},
            {"camera", camera_json(page)},
            {"shadow", scene.shadow ? Json(scene.shadow->size) : Json()},
            {"instances", instances},
            {"lights",
             {{"directional", lights_json(scene.directional_lights, graph.directional_lights)},
              {"point", lights_json(scene.point_lights, graph.point_lights)},
              {"spot", lights_json(scene.spot_lights, graph.spot_lights)}}},
            {"nodes", nodes},
            {"animations", animations},
            {"deformed", deformed}};
}

}  // namespace relief::tools
