// SPDX-License-Identifier: Apache-2.0
// Writes pages: the description and the scene as JSON, the sections behind it, and the runtime of
// page/. The data is a zlib stream in base64.
#include "page_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <type_traits>
#include <variant>

#include "common/html.h"
#include "common/text.h"
#include "relief/mesh/mesh.h"
#include "zlib_stream.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

// Numbers

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

// Sections: those of the description, and those of the animations.

class Sections {
  public:
    Sections(const PageDescription& page, const PageQuantization& codes) {
        for (std::size_t i = 0; i < page.sections.size(); ++i) {
            const auto quantized = codes.sections.find(i);
            if (quantized == codes.sections.end()) {
                add(page.sections[i]);
            } else {
                add(quantized->second.codes);
            }
        }
    }

    std::size_t add(std::span<const std::byte> bytes) {
        places_.push_back({bytes_.size(), bytes.size()});
        bytes_.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        bytes_.resize((bytes_.size() + 3) / 4 * 4);
        return places_.size() - 1;
    }
    template <typename T>
    std::size_t add(const std::vector<T>& values) {
        return add(std::as_bytes(std::span(values)));
    }

    [[nodiscard]] Json places() const { return places_; }
    [[nodiscard]] const std::string& bytes() const { return bytes_; }

  private:
    std::vector<std::array<std::size_t, 2>> places_;
    std::string bytes_;
};

// The description

Json json_of(const PageTexture& t) {
    return {{"kind", enum_name(t.kind)},
            {"t", enum_name(t.texels)},
            {"srgb", t.is_srgb},
            {"levels", t.has_levels},
            {"maxima", t.has_maxima},
            {"gray", t.is_gray},
            {"c", t.channels},
            {"w", t.width},
            {"h", t.height},
            {"d", t.section}};
}

Json json_of(const PageSampler& s) {
    return {{"u", s.wrap_u},
            {"v", s.wrap_v},
            {"min", s.minify},
            {"mag", s.magnify},
            {"anisotropy", s.anisotropy}};
}

Json json_of(const PageMesh& mesh) {
    Json streams = Json::array();
    for (const PageStream& stream : mesh.streams)
        streams.push_back(
            {{"attribute", stream.attribute}, {"c", stream.components}, {"d", stream.section}});
    return {{"streams", streams}, {"triangles", mesh.triangles}};
}

Json json_of(const PageSurface& surface) {
    Json textures = Json::object();
    for (const auto& [name, lookup] : surface.textures)
        textures[name] = {lookup.texture, lookup.sampler};
    return {{"values", surface.values}, {"textures", textures}};
}

Json json_of(const PageDraw& d) {
    Json json = {{"pass", enum_name(d.pass)},
                 {"program", d.program},
                 {"mesh", d.mesh},
                 {"surface", d.surface},
                 {"instance", d.instance},
                 {"first", d.first_triangle},
                 {"count", d.triangle_count},
                 {"bothSides", d.both_sides},
                 {"lights",
                  {{"directional", d.lights.directional},
                   {"point", d.lights.point},
                   {"spot", d.lights.spot},
                   {"colors", d.lights.highlight_colors}}},
                 {"rows", Json(d.rows)},
                 {"jointPairs", d.joint_pairs},
                 {"morphTexels", {d.morph_texels.x, d.morph_texels.y}}};
    if (d.shadow_program) json["shadowProgram"] = *d.shadow_program;
    if (d.rows.empty()) json["rows"] = Json::object();
    return json;
}

Json json_of(const PageScreenPass& pass) {
    Json json = json_of(pass.surface);
    json["program"] = pass.program;
    return json;
}

Json json_of(const PagePicture& p, const PagePictureName& name) {
    Json draws = Json::array();
    for (const PageDraw& draw : p.draws)
        draws.push_back(json_of(draw));
    return {{"view", name.view},
            {"variant", name.variant},
            {"draws", draws},
            {"skybox", p.skybox ? json_of(*p.skybox) : Json()},
            {"finishing", p.finishing ? json_of(*p.finishing) : Json()},
            {"samples", p.samples},
            {"shadowMaps", p.has_shadow_maps},
            {"copiesBehind", p.copies_behind},
            {"counts", p.counts_fragments},
            {"clear", {p.clear_color.r, p.clear_color.g, p.clear_color.b, p.clear_color.a}}};
}

template <typename T>
Json list_of(const std::vector<T>& values) {
    Json list = Json::array();
    for (const T& value : values)
        list.push_back(json_of(value));
    return list;
}

// The scene

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

Json channel_json(const KeyChannel& channel, Sections& sections) {
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

Json animation_json(const Animation& animation, Sections& sections) {
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

Json camera_json(const ComposedScene& composed) {
    const Camera& camera = composed.camera;
    Json json = {
        {"matrix", json_of(camera.world_from_view)},
        {"fov", camera.vertical_fov},
        {"near", camera.near},
        {"far", camera.far},
        {"height", camera.orthographic_height ? Json(*camera.orthographic_height) : Json()}};
    if (composed.camera_follows_scene) {
        add_carrier(json, &composed.graph.camera);
        if (composed.graph.camera_sees_all) json["seesAll"] = true;
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

Json scene_json(const ComposedScene& composed, double seconds, Sections& sections) {
    const SceneGraph& graph = composed.graph;
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
            {"camera", camera_json(composed)},
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

std::string_view part(std::string_view name) {
    for (const PagePart& each : page_parts()) {
        if (each.name == name) return each.text;
    }
    return {};
}

std::string filled(std::string_view text, const std::map<std::string, std::string>& values) {
    std::string result;
    while (true) {
        const std::size_t begin = text.find("{{");
        result += text.substr(0, begin);
        if (begin == std::string_view::npos) return result;
        const std::size_t end = text.find("}}", begin);
        result += values.at(std::string(text.substr(begin + 2, end - begin - 2)));
        text.remove_prefix(end + 2);
    }
}

}  // namespace

std::string without_comments(std::string_view code) {
    std::string result;
    bool is_comment = false;
    while (!code.empty()) {
        const std::size_t end = std::min(code.find('\n'), code.size());
        std::string_view line = code.substr(0, end);
        code.remove_prefix(std::min(end + 1, code.size()));
        line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
        if (const std::size_t comment = line.find("  // "); comment != std::string_view::npos)
            line = line.substr(0, comment);
        is_comment |= line.starts_with("/*");
        if (!is_comment && !line.empty() && !line.starts_with("//")) {
            result += line;
            result += '\n';
        }
        if (is_comment && line.ends_with("*/")) is_comment = false;
    }
    return result;
}

std::string page_script() {
    std::string script;
    for (const PagePart& each : page_parts()) {
        if (each.name.ends_with(".js")) script += without_comments(each.text);
    }
    return "(() => {\n'use strict';\n" + script + "})();\n";
}

std::string page_html(const PageDescription& page, const ComposedScene& composed,
                      const std::vector<PagePictureName>& names, const std::string& title,
                      double seconds, double aspect, const PageQuantization& codes) {
    Sections sections(page, codes);
    Json programs = Json::array();
    for (const PageProgram& program : page.programs)
        programs.push_back({{"vertex", without_comments(program.vertex)},
                            {"fragment", without_comments(program.fragment)}});
    Json pictures = Json::array();
    for (std::size_t i = 0; i < page.pictures.size(); ++i)
        pictures.push_back(json_of(page.pictures[i], names.at(i)));
    Json json = {{"scene", scene_json(composed, seconds, sections)},
                 {"aspect", aspect},
                 {"pictures", pictures},
                 {"surfaces", list_of(page.surfaces)},
                 {"meshes", list_of(page.meshes)},
                 {"textures", list_of(page.textures)},
                 {"samplers", list_of(page.samplers)},
                 {"programs", programs}};
    json["quantized"] = Json::object();
    for (const auto& [section, quantized] : codes.sections)
        json["quantized"][std::to_string(section)] = {{"min", quantized.min},
                                                      {"max", quantized.max}};
    json["sections"] = sections.places();
    const std::string text = json.dump();
    std::string bytes(4, '\0');
    const auto length = static_cast<std::uint32_t>(text.size());
    std::memcpy(bytes.data(), &length, sizeof(length));
    bytes += text + sections.bytes();
    const std::string stream =
        relief::detail::zlib_stream(std::as_bytes(std::span(bytes.data(), bytes.size())));
    return filled(part("page.html"), {{"title", html_escaped(title)},
                                      {"style", without_comments(part("page.css"))},
                                      {"script", page_script()},
                                      {"data", base64(stream)}});
}

}  // namespace relief::tools
