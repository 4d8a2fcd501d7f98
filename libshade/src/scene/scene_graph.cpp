// SPDX-License-Identifier: Apache-2.0
// Poses: nodes at a time, then what hangs on them. World space, radians, seconds. Angles grow in
// double, so that a turn after a day is as smooth as the first. Nodes that form a cycle throw
// InvalidInput. Tests: tests/shade/scene/scene_graph_test.cpp.
#include "relief/shade/scene_graph.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "relief/mesh/error.h"
#include "scene/key_channel.h"
#include "scene/orbit_axes.h"

namespace relief {

namespace {

/// What stands for a direction where a scale of nothing leaves none.
constexpr glm::vec3 default_back{0.0F, 0.0F, 1.0F};

/// A node's own transform as its animations make it.
struct LocalPlace {
    glm::vec3 translation{0.0F};
    glm::quat rotation{1.0F, 0.0F, 0.0F, 0.0F};
    glm::vec3 scale{1.0F};
    std::optional<glm::mat4> matrix;
    std::optional<glm::mat4> turn;  ///< A turntable's, innermost.
};

glm::vec3 unit_or(const glm::vec3& direction, const glm::vec3& otherwise) {
    const glm::dvec3 precise(direction);
    const double length = glm::length(precise);
    return length > 0.0 && std::isfinite(length) ? glm::vec3(precise / length) : otherwise;
}

glm::mat4 matrix_of(const LocalPlace& place) {
    glm::mat4 matrix(1.0F);
    if (place.matrix) {
        matrix = *place.matrix;
    } else {
        matrix = glm::translate(glm::mat4(1.0F), place.translation) *
                 glm::mat4_cast(glm::normalize(place.rotation)) *
                 glm::scale(glm::mat4(1.0F), place.scale);
    }
    return place.turn ? matrix * *place.turn : matrix;
}

/// The time within one run of key frames that lasts so long.
double wrapped(double seconds, double length) {
    if (!(length > 0.0)) return 0.0;
    const double rest = std::fmod(seconds, length);
    return rest < 0.0 ? rest + length : rest;
}

double length_of(const KeyAnimation& animation) {
    double length = 0.0;
    for (const KeyChannel& channel : animation.channels) {
        if (!channel.times.empty())
            length = std::max(length, static_cast<double>(channel.times.back()));
    }
    return length;
}

/// Moves nodes at rest to where one kind of animation has them at a time.
class Mover {
  public:
    Mover(std::vector<LocalPlace>& places, double seconds) : places_(places), seconds_(seconds) {}

    void operator()(const KeyAnimation& animation) const {
        const double now = wrapped(seconds_, length_of(animation));
        for (const KeyChannel& channel : animation.channels) {
            const glm::vec4 value = value_at(channel, now);
            LocalPlace& place = at(channel.node);
            switch (channel.property) {
                case KeyChannel::Property::translation:
                    place.translation = glm::vec3(value);
                    break;
                case KeyChannel::Property::rotation:
                    place.rotation = glm::quat(value.w, value.x, value.y, value.z);
                    break;
                case KeyChannel::Property::scale:
                    place.scale = glm::vec3(value);
                    break;
            }
        }
    }

    void operator()(const Orbit& orbit) const {
        const glm::mat3 axes = orbit_axes(angle(orbit.azimuth, orbit.azimuth_speed),
                                          angle(orbit.elevation, orbit.elevation_speed));
        LocalPlace& place = at(orbit.node);
        place.translation = orbit.center + orbit.radius * axes[2];
        if (orbit.faces_center) place.rotation = glm::quat_cast(axes);
    }

    void operator()(const Turntable& turntable) const {
        const double turned = angle(turntable.angle, turntable.speed);
        const glm::dvec3 axis = glm::normalize(glm::dvec3(turntable.axis));
        at(turntable.node).turn = glm::mat4(glm::rotate(glm::dmat4(1.0), turned, axis));
    }

  private:
    [[nodiscard]] LocalPlace& at(std::size_t node) const {
        if (node >= places_.size()) {
            throw InvalidInput(fmt::format("an animation names node {}, but there are only {}",
                                           node, places_.size()));
        }
        return places_[node];
    }

    [[nodiscard]] double angle(float start, float speed) const {
        return static_cast<double>(start) + static_cast<double>(speed) * seconds_;
    }

    std::vector<LocalPlace>& places_;
    double seconds_;
};

std::vector<LocalPlace> places_at(const SceneGraph& graph, double seconds) {
    std::vector<LocalPlace> places;
    places.reserve(graph.nodes.size());
    for (const SceneNode& node : graph.nodes)
        places.push_back({node.translation, node.rotation, node.scale, node.matrix, std::nullopt});
    for (const Animation& animation : graph.animations)
        std::visit(Mover(places, seconds), animation);
    return places;
}

/// From each node's space to the world's; every chain of parents is walked once.
std::vector<glm::mat4> world_matrices(const SceneGraph& graph,
                                      const std::vector<LocalPlace>& places) {
    const std::size_t count = graph.nodes.size();
    std::vector<glm::mat4> world(count);
    std::vector<bool> is_done(count, false);
    std::vector<std::size_t> chain;
    for (std::size_t i = 0; i < count; ++i) {
        chain.clear();
        std::optional<std::size_t> next = i;
        while (next && !is_done.at(*next)) {
            chain.push_back(*next);
            if (chain.size() > count)
                throw InvalidInput(fmt::format("node {} is its own ancestor", *next));
            next = graph.nodes[*next].parent;
            if (next && *next >= count) {
                throw InvalidInput(fmt::format("node {} has parent {}, but there are only {} nodes",
                                               chain.back(), *next, count));
            }
        }
        for (; !chain.empty(); chain.pop_back()) {
            const std::size_t node = chain.back();
            const std::optional<std::size_t>& parent = graph.nodes[node].parent;
            const glm::mat4 local = matrix_of(places[node]);
            world[node] = parent ? world[*parent] * local : local;
            is_done[node] = true;
        }
    }
    return world;
}

/// Where what hangs on a node is, or nothing where it hangs on none.
class Places {
  public:
    explicit Places(std::vector<glm::mat4> world_from_node)
        : world_from_node_(std::move(world_from_node)) {}

    [[nodiscard]] std::optional<glm::mat4> world_from_object(const Carried& carried) const {
        if (!carried.node) return std::nullopt;
        if (*carried.node >= world_from_node_.size()) {
            throw InvalidInput(fmt::format("something hangs on node {}, but there are only {}",
                                           *carried.node, world_from_node_.size()));
        }
        const glm::mat4& node = world_from_node_[*carried.node];
        if (!carried.place_only) return node * carried.node_from_object;
        glm::mat4 matrix = carried.node_from_object;
        matrix[3] = node * carried.node_from_object[3];
        return matrix;
    }

  private:
    std::vector<glm::mat4> world_from_node_;
};

/// Calls move(thing, matrix) for everything in a list that hangs on a node.
template <typename Thing, typename Move>
void move_all(std::vector<Thing>& things, const std::vector<Carried>& carried, const Places& places,
              const Move& move) {
    for (std::size_t i = 0; i < std::min(things.size(), carried.size()); ++i) {
        if (const auto matrix = places.world_from_object(carried[i])) move(things[i], *matrix);
    }
}

glm::vec3 direction_of(const glm::mat4& world_from_light) {
    return -unit_or(glm::vec3(world_from_light[2]), default_back);
}

/// Rotation and translation alone.
glm::mat4 camera_matrix(const glm::mat4& world_from_object) {
    const glm::vec3 back = unit_or(glm::vec3(world_from_object[2]), default_back);
    const glm::vec3 right =
        unit_or(glm::cross(unit_or(glm::vec3(world_from_object[1]), {0.0F, 1.0F, 0.0F}), back),
                glm::vec3(1.0F, 0.0F, 0.0F));
    return {glm::vec4(right, 0.0F), glm::vec4(glm::cross(back, right), 0.0F), glm::vec4(back, 0.0F),
            world_from_object[3]};
}

/// A far plane behind the farthest corner of every mesh's box.
float far_behind_all(SceneGraph& graph, const Camera& camera) {
    for (std::size_t i = graph.mesh_bounds.size(); i < graph.scene.meshes.size(); ++i)
        graph.mesh_bounds.push_back(bounds_of(graph.scene.meshes[i]));
    const glm::vec3 eye(camera.world_from_view[3]);
    float reach = 0.0F;
    for (const Instance& instance : graph.scene.instances) {
        const Bounds& box = graph.mesh_bounds.at(instance.mesh);
        if (box.empty()) continue;
        for (int corner = 0; corner < 8; ++corner) {
            const glm::vec4 at((corner & 1) != 0 ? box.max.x : box.min.x,
                               (corner & 2) != 0 ? box.max.y : box.min.y,
                               (corner & 4) != 0 ? box.max.z : box.min.z, 1.0F);
            const float distance = glm::distance(glm::vec3(instance.world_from_object * at), eye);
            if (std::isfinite(distance)) reach = std::max(reach, distance);
        }
    }
    return std::max(2.0F * camera.near, 1.01F * reach);
}

void pose_camera(SceneGraph& graph, const Places& places) {
    if (!graph.scene.camera) return;
    Camera& camera = *graph.scene.camera;
    if (const auto matrix = places.world_from_object(graph.camera))
        camera.world_from_view = camera_matrix(*matrix);
    if (graph.camera_sees_all) camera.far = far_behind_all(graph, camera);
}

}  // namespace

void pose(SceneGraph& graph, double seconds) {
    if (!std::isfinite(seconds))
        throw InvalidInput(fmt::format("the time is {}, but must be finite", seconds));
    const Places places(world_matrices(graph, places_at(graph, seconds)));
    Scene& scene = graph.scene;
    move_all(
        scene.instances, graph.instances, places,
        [](Instance& instance, const glm::mat4& matrix) { instance.world_from_object = matrix; });
    move_all(scene.directional_lights, graph.directional_lights, places,
             [](DirectionalLight& light, const glm::mat4& matrix) {
                 light.direction_world = direction_of(matrix);
             });
    move_all(scene.point_lights, graph.point_lights, places,
             [](PointLight& light, const glm::mat4& matrix) {
                 light.position_world = glm::vec3(matrix[3]);
             });
    move_all(scene.spot_lights, graph.spot_lights, places,
             [](SpotLight& light, const glm::mat4& matrix) {
                 light.point.position_world = glm::vec3(matrix[3]);
                 light.direction_world = direction_of(matrix);
             });
    pose_camera(graph, places);
}

double duration(const SceneGraph& graph) {
    double longest = 0.0;
    const auto turn = [&](float speed) {
        if (speed != 0.0F)
            longest =
                std::max(longest, 2.0 * std::numbers::pi / std::abs(static_cast<double>(speed)));
    };
    for (const Animation& animation : graph.animations) {
        if (const auto* keys = std::get_if<KeyAnimation>(&animation)) {
            longest = std::max(longest, length_of(*keys));
        } else if (const auto* orbit = std::get_if<Orbit>(&animation)) {
            turn(orbit->azimuth_speed);
            turn(orbit->elevation_speed);
        } else if (const auto* turntable = std::get_if<Turntable>(&animation)) {
            turn(turntable->speed);
        }
    }
    return longest;
}

glm::mat4 looking_along(const glm::vec3& position, const glm::vec3& direction) {
    const glm::vec3 back = -unit_or(direction, -default_back);
    // Straight up or down, the world's z takes the place of its y.
    const bool is_vertical = std::abs(back.y) > 0.9999F;
    const glm::vec3 up = is_vertical ? glm::vec3(0.0F, 0.0F, 1.0F) : glm::vec3(0.0F, 1.0F, 0.0F);
    const glm::vec3 right = glm::normalize(glm::cross(up, back));
    return {glm::vec4(right, 0.0F), glm::vec4(glm::cross(back, right), 0.0F), glm::vec4(back, 0.0F),
            glm::vec4(position, 1.0F)};
}

}  // namespace relief
