// SPDX-License-Identifier: Apache-2.0
// From a glTF document to a scene graph: primitives become meshes (one for each, however often
// placed) with the texture coordinates that their material uses, light units become irradiance over
// pi, node animations become key frames. World space is glTF's. What cannot be drawn as meant is
// counted in the report; see scene_file.h for the list.
// Tests: tests/shade/scene/scene_file_test.cpp.
#include "scene/gltf_scene.h"

#include <fmt/format.h>

#include <map>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

#include "progress_stage.h"
#include "relief/mesh/frames.h"
#include "scene/gltf_materials.h"

namespace relief {

namespace {

/// A primitive with the texture coordinates at which its material looks its images up, and its own
/// tangents, which belong to the coordinates as stored, turned as these are.
Mesh mesh_from(const GltfDocument& document, GltfPrimitiveId id,
               const std::vector<GltfMaterial>& materials) {
    Mesh mesh = document.mesh(id);
    if (mesh.material_ranges.empty() || !mesh.material_ranges.front().material) return mesh;
    const TexcoordSource source =
        texcoord_source(materials[*mesh.material_ranges.front().material]);
    if (source.set != 0) mesh = document.mesh(id, source.set);
    if (source.transform == GltfTextureTransform{}) return mesh;
    for (glm::vec2& texcoord : mesh.texcoords)
        texcoord = transformed(source.transform, texcoord);
    if (mesh.normals.empty()) return mesh;  // Its tangents do not count.
    for (std::size_t v = 0; v < mesh.tangents.size(); ++v)
        mesh.tangents[v] = transformed(source.transform, mesh.tangents[v], mesh.normals[v]);
    return mesh;
}

/// Counts, once a node, meshes that would bend.
void report_rest(const GltfView& view, Report& report) {
    std::set<std::size_t> told;
    for (const auto& placed : view.primitives) {
        if (!told.insert(placed.node).second) continue;
        const GltfNode& node = view.nodes[placed.node];
        if (node.has_skin) report.add("skinned mesh", "node", placed.node, "drawn at rest");
        if (node.has_morph_targets)
            report.add("morph targets", "node", placed.node, "drawn without");
    }
}

/// Meshes and their places; a primitive that stands in several places is read once.
void add_instances(const GltfDocument& document, const GltfView& view, SceneGraph& graph,
                   Report& report) {
    // Without normals, glTF asks for flat ones and says that tangents given do not count; new ones
    // are left to the effect plan.
    FrameOptions options;
    options.if_missing = NormalMode::flat;
    options.tangents = TangentMode::none;
    Scene& scene = graph.scene;
    std::map<std::pair<std::size_t, std::size_t>, std::size_t> mesh_of;
    ProgressStage stage("meshes", view.primitives.size());
    for (const auto& placed : view.primitives) {
        const auto key = std::pair(placed.what.mesh, placed.what.primitive);
        const auto [entry, is_new] = mesh_of.try_emplace(key, scene.meshes.size());
        if (is_new) {
            Mesh mesh = mesh_from(document, placed.what, view.materials);
            if (mesh.normals.empty()) mesh = with_frames(std::move(mesh), options, report).mesh;
            scene.meshes.push_back(std::move(mesh));
        }
        scene.instances.push_back({entry->second, placed.world_from_object, placed.name});
        graph.instances.push_back({placed.node, placed.node_from_object});
        stage.advance(1);
    }
    report_rest(view, report);
}

void add_lights(const GltfView& view, SceneGraph& graph) {
    Scene& scene = graph.scene;
    for (const auto& placed : view.lights) {
        const GltfLight& light = placed.what;
        const glm::vec3 power = light.color * light.intensity * std::numbers::inv_pi_v<float>;
        const PointLight point{glm::vec3(0.0F), power, light.range};
        const Carried carried{placed.node};
        switch (light.type) {
            case GltfLight::Type::directional:
                scene.directional_lights.push_back({glm::vec3(0.0F, 0.0F, -1.0F), power});
                graph.directional_lights.push_back(carried);
                break;
            case GltfLight::Type::point:
                scene.point_lights.push_back(point);
                graph.point_lights.push_back(carried);
                break;
            case GltfLight::Type::spot:
                scene.spot_lights.push_back(
                    {point, glm::vec3(0.0F, 0.0F, -1.0F), light.inner_cone, light.outer_cone});
                graph.spot_lights.push_back(carried);
                break;
        }
    }
}

/// The first camera.
void add_camera(const GltfView& view, SceneGraph& graph, Report& report) {
    if (view.cameras.empty()) return;
    const auto& placed = view.cameras.front();
    const glm::mat3 axes(placed.world_from_object);
    if (!(glm::length(glm::cross(axes[1], axes[2])) > 0.0F)) {
        report.add("camera without a direction", "camera", 0, "left out");
        return;
    }
    Camera& camera = graph.scene.camera.emplace();
    camera.vertical_fov = placed.what.vertical_fov;
    camera.near = placed.what.near;
    camera.far = placed.what.far.value_or(2.0F * camera.near);
    graph.camera_sees_all = !placed.what.far;
    graph.camera = Carried{placed.node};
}

void add_nodes(const GltfView& view, SceneGraph& graph, Report& report) {
    for (std::size_t i = 0; i < view.nodes.size(); ++i) {
        const GltfNode& node = view.nodes[i];
        const glm::vec4& q = node.rotation;
        SceneNode& result = graph.nodes.emplace_back();
        result.name = node.name;
        result.parent = node.parent;
        result.translation = node.translation;
        result.scale = node.scale;
        result.matrix = node.matrix;
        if (glm::length(q) > 0.0F) {
            result.rotation = glm::quat(q.w, q.x, q.y, q.z);
        } else {
            report.add("rotation without a length", "node", i, "counts as none");
        }
    }
}

KeyChannel channel_from(const GltfChannel& channel) {
    KeyChannel result;
    result.node = channel.node;
    result.property = channel.path == GltfChannel::Path::translation
                          ? KeyChannel::Property::translation
                      : channel.path == GltfChannel::Path::rotation ? KeyChannel::Property::rotation
                                                                    : KeyChannel::Property::scale;
    result.interpolation = channel.interpolation == GltfChannel::Interpolation::step
                               ? KeyInterpolation::step
                           : channel.interpolation == GltfChannel::Interpolation::linear
                               ? KeyInterpolation::linear
                               : KeyInterpolation::cubic_spline;
    result.times = channel.times;
    result.values = channel.values;
    return result;
}

/// Animations that move a node; those of skins and morphs alone would only take time.
void add_animations(const GltfDocument& document, SceneGraph& graph, Report& report) {
    for (const GltfAnimation& animation : document.animations(report)) {
        if (animation.channels.empty()) continue;
        KeyAnimation keys{animation.name, {}};
        for (const GltfChannel& channel : animation.channels)
            keys.channels.push_back(channel_from(channel));
        graph.animations.emplace_back(std::move(keys));
    }
}

}  // namespace

SceneGraph graph_from(const GltfDocument& document, const std::filesystem::path& model,
                      const SceneOptions& options, Report& report) {
    const GltfView view = document.view();
    SceneGraph graph;
    for (std::size_t i = 0; i < view.images.size(); ++i) {
        const GltfImage& image = view.images[i];
        ImageSource source;
        const auto* path = std::get_if<std::filesystem::path>(&image.source);
        source.name = !image.name.empty() ? image.name
                      : path != nullptr   ? path->filename().string()
                                          : fmt::format("images[{}]", i);
        std::visit([&](const auto& encoded) { source.source = encoded; }, image.source);
        source.origin = model.string();
        source.fault = image.fault;
        graph.scene.images.push_back(std::move(source));
    }
    graph.scene.materials = materials_from(view, options, graph.scene.images, report);
    add_nodes(view, graph, report);
    add_instances(document, view, graph, report);
    add_lights(view, graph);
    add_camera(view, graph, report);
    add_animations(document, graph, report);
    return graph;
}

}  // namespace relief
