// SPDX-License-Identifier: Apache-2.0
// One scene graph into another: lists are joined, and indices of the part moved up by what was
// there. Tests: tests/shade/scene/scene_json_test.cpp.
#include "scene/append_graph.h"

#include <iterator>
#include <utility>

namespace relief {

namespace {

template <typename T>
void join(std::vector<T>& all, std::vector<T>&& more) {
    all.insert(all.end(), std::make_move_iterator(more.begin()),
               std::make_move_iterator(more.end()));
}

void shift(std::optional<Texture>& texture, std::size_t by) {
    if (texture) texture->image += by;
}

void shift_images(Material& material, std::size_t by) {
    shift(material.diffuse_texture, by);
    shift(material.specular_texture, by);
    shift(material.emission_texture, by);
    shift(material.occlusion_texture, by);
    shift(material.opacity_texture, by);
    if (material.normal_map) material.normal_map->texture.image += by;
    if (material.bump_map) material.bump_map->texture.image += by;
    if (material.metallic_roughness) shift(material.metallic_roughness->texture, by);
}

void shift_node(Animation& animation, std::size_t by) {
    if (auto* keys = std::get_if<KeyAnimation>(&animation)) {
        for (KeyChannel& channel : keys->channels)
            channel.node += by;
    } else if (auto* orbit = std::get_if<Orbit>(&animation)) {
        orbit->node += by;
    } else if (auto* turntable = std::get_if<Turntable>(&animation)) {
        turntable->node += by;
    }
}

/// Where the part's things hang now; those that stood in its world hang on the node.
class Carriers {
  public:
    Carriers(std::size_t node, std::size_t first_node) : node_(node), first_node_(first_node) {}

    /// \param place_of  where a thing of the part stands in the part's world
    template <typename Thing, typename PlaceOf>
    void join_all(std::vector<Thing>& all, std::vector<Carried>& carried, std::vector<Thing>&& more,
                  const std::vector<Carried>& more_carried, const PlaceOf& place_of) const {
        carried.resize(all.size());
        for (std::size_t i = 0; i < more.size(); ++i) {
            const bool hangs = i < more_carried.size() && more_carried[i].node;
            Carried& result = carried.emplace_back(hangs ? more_carried[i] : Carried{});
            if (hangs) {
                *result.node += first_node_;
            } else {
                result = Carried{node_, place_of(more[i])};
            }
        }
        join(all, std::move(more));
    }

  private:
    std::size_t node_;
    std::size_t first_node_;
};

void append_things(SceneGraph& graph, SceneGraph& part, const Carriers& carriers) {
    carriers.join_all(graph.scene.instances, graph.instances, std::move(part.scene.instances),
                      part.instances,
                      [](const Instance& instance) { return instance.world_from_object; });
    carriers.join_all(graph.scene.directional_lights, graph.directional_lights,
                      std::move(part.scene.directional_lights), part.directional_lights,
                      [](const DirectionalLight& light) {
                          return looking_along(glm::vec3(0.0F), light.direction_world);
                      });
    carriers.join_all(graph.scene.point_lights, graph.point_lights,
                      std::move(part.scene.point_lights), part.point_lights,
                      [](const PointLight& light) {
                          return looking_along(light.position_world, glm::vec3(0.0F, 0.0F, -1.0F));
                      });
    carriers.join_all(graph.scene.spot_lights, graph.spot_lights, std::move(part.scene.spot_lights),
                      part.spot_lights, [](const SpotLight& light) {
                          return looking_along(light.point.position_world, light.direction_world);
                      });
}

}  // namespace

void append(SceneGraph& graph, SceneGraph part, std::size_t node) {
    const std::size_t first_image = graph.scene.images.size();
    const std::size_t first_mesh = graph.scene.meshes.size();
    const auto first_material = static_cast<std::uint32_t>(graph.scene.materials.size());
    const std::size_t first_node = graph.nodes.size();
    for (Material& material : part.scene.materials)
        shift_images(material, first_image);
    for (Shared<Mesh>& mesh : part.scene.meshes) {
        for (MaterialRange& range : mesh.edit().material_ranges) {
            if (range.material) *range.material += first_material;
        }
    }
    for (Instance& instance : part.scene.instances)
        instance.mesh += first_mesh;
    for (SceneNode& own : part.nodes)
        own.parent = own.parent ? *own.parent + first_node : node;
    for (Animation& animation : part.animations)
        shift_node(animation, first_node);
    append_things(graph, part, Carriers(node, first_node));
    join(graph.scene.images, std::move(part.scene.images));
    join(graph.scene.materials, std::move(part.scene.materials));
    join(graph.scene.meshes, std::move(part.scene.meshes));
    join(graph.nodes, std::move(part.nodes));
    join(graph.animations, std::move(part.animations));
    graph.scene.ambient += part.scene.ambient;
}

}  // namespace relief
