// SPDX-License-Identifier: Apache-2.0
// Scene graphs: key frames, poses of nodes and of what hangs on them, and the union of two graphs.
// World space, radians, seconds. Angles grow in double, so that a rotation is as smooth after a day
// as at the start. Source of key frames: glTF 2.0, section 3.11 and appendix C.
#include "relief/shade/scene_graph.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <iterator>
#include <numbers>
#include <set>
#include <span>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

#include "portable_math.h"
#include "relief/mesh/report.h"
#include "relief/shade/scene_fields.h"
#include "scene/scene_parts.h"

namespace relief::shade {
using namespace relief::detail;
using namespace relief::shade::detail;

// Key frames

namespace {

std::size_t values_per_key(const KeyChannel& channel) {
    return channel.interpolation == KeyInterpolation::cubic_spline ? 3 : 1;
}

/// Returns the value of a key itself, without its tangents.
const glm::vec4& key_value(const KeyChannel& channel, std::size_t key) {
    const std::size_t per_key = values_per_key(channel);
    return channel.values[key * per_key + per_key / 2];
}

/// Interpolates two unit quaternions along the shortest arc.
glm::vec4 slerp(const glm::vec4& a, const glm::vec4& b, float t) {
    const glm::dvec4 from(a);
    const glm::dvec4 to = glm::dot(from, glm::dvec4(b)) < 0.0 ? -glm::dvec4(b) : glm::dvec4(b);
    const double angle = 2.0 * portable::atan2(glm::length(to - from), glm::length(to + from));
    const double sine = portable::sin(angle);
    const auto share = static_cast<double>(t);
    if (!(sine > 0.0)) return glm::vec4(glm::mix(from, to, share));
    return glm::vec4(
        (portable::sin((1.0 - share) * angle) * from + portable::sin(share * angle) * to) / sine);
}

/// Returns the Hermite interpolation between a key and the next one; tangents are per second.
glm::vec4 hermite(const KeyChannel& channel, std::size_t key, float t) {
    const float span = channel.times[key + 1] - channel.times[key];
    const glm::vec4& from = channel.values[3 * key + 1];
    const glm::vec4& out_tangent = channel.values[3 * key + 2];
    const glm::vec4& in_tangent = channel.values[3 * key + 3];
    const glm::vec4& to = channel.values[3 * key + 4];
    const float t2 = t * t;
    const float t3 = t2 * t;
    return (2.0F * t3 - 3.0F * t2 + 1.0F) * from + span * (t3 - 2.0F * t2 + t) * out_tangent +
           (3.0F * t2 - 2.0F * t3) * to + span * (t3 - t2) * in_tangent;
}

/// Returns the unit quaternion, or the fallback if the length is 0 or not finite.
glm::vec4 unit_or(const glm::vec4& quaternion, const glm::vec4& fallback) {
    const float length = glm::length(quaternion);
    return length > 0.0F && std::isfinite(length) ? quaternion / length : fallback;
}

glm::vec4 between(const KeyChannel& channel, std::size_t key, float t) {
    const bool rotates = channel.property == KeyChannel::Property::rotation;
    const glm::vec4 from =
        rotates ? glm::normalize(key_value(channel, key)) : key_value(channel, key);
    if (channel.interpolation == KeyInterpolation::step) return from;
    if (channel.interpolation == KeyInterpolation::cubic_spline) {
        const glm::vec4 value = hermite(channel, key, t);
        return rotates ? unit_or(value, from) : value;
    }
    const glm::vec4& to = key_value(channel, key + 1);
    return rotates ? slerp(from, glm::normalize(to), t) : glm::mix(from, to, t);
}

}  // namespace

void detail::check_keys(const KeyChannel& channel) {
    const std::size_t keys = channel.times.size();
    if (keys == 0) throw InvalidInput("a channel has no keys");
    const bool has_weights = channel.property == KeyChannel::Property::weights;
    if (has_weights && (channel.weights.empty() ||
                        channel.weights.size() % (keys * values_per_key(channel)) != 0)) {
        throw InvalidInput(fmt::format("a channel of {} keys has {} weights, not a multiple", keys,
                                       channel.weights.size()));
    }
    const std::size_t needed = has_weights ? 0 : keys * values_per_key(channel);
    if (channel.values.size() != needed) {
        throw InvalidInput(fmt::format("a channel of {} keys has {} values, but needs {}", keys,
                                       channel.values.size(), needed));
    }
    for (std::size_t i = 0; i < keys; ++i) {
        const float time = channel.times[i];
        if (!std::isfinite(time) || (i > 0 && !(time > channel.times[i - 1]))) {
            throw InvalidInput(fmt::format(
                "time {} of a channel is {}, but times must be finite and ascending", i, time));
        }
    }
    for (std::size_t i = 0; i < needed; ++i) {
        const glm::vec4& value = channel.values[i];
        const bool finite = std::isfinite(value.x) && std::isfinite(value.y) &&
                            std::isfinite(value.z) && std::isfinite(value.w);
        if (!finite) {
            throw InvalidInput(
                fmt::format("value {} of a channel is ({}, {}, {}, {}), but must be "
                            "finite",
                            i, value.x, value.y, value.z, value.w));
        }
    }
    if (channel.property != KeyChannel::Property::rotation) return;
    for (std::size_t i = 0; i < keys; ++i) {
        if (!(glm::length(key_value(channel, i)) > 0.0F))
            throw InvalidInput(fmt::format("rotation {} of a channel has no length", i));
    }
}

std::vector<float> detail::weights_at(const KeyChannel& channel, double seconds) {
    const std::vector<float>& times = channel.times;
    const std::size_t per_key = values_per_key(channel);
    if (times.empty() || channel.weights.size() % (per_key * times.size()) != 0)
        check_keys(channel);  // Throws.
    const std::size_t count = channel.weights.size() / (per_key * times.size());
    // The group of weights of a key: 0 is the in-tangent, 1 the value, 2 the out-tangent.
    const auto group = [&](std::size_t key, std::size_t part) {
        const std::size_t first = (per_key == 3 ? 3 * key + part : key) * count;
        return std::span(channel.weights).subspan(first, count);
    };
    const auto after =
        std::upper_bound(times.begin(), times.end(), seconds,
                         [](double t, float key) { return t < static_cast<double>(key); });
    const auto next = static_cast<std::size_t>(after - times.begin());
    const std::size_t key = next == 0 ? 0 : next - 1;
    std::vector<float> result(group(key, 1).begin(), group(key, 1).end());
    const bool is_held = next == 0 || next == times.size();
    if (is_held || channel.interpolation == KeyInterpolation::step) return result;
    const auto from = static_cast<double>(times[key]);
    const double span = static_cast<double>(times[next]) - from;
    const auto t = static_cast<float>((seconds - from) / span);
    for (std::size_t i = 0; i < count; ++i) {
        const float a = group(key, 1)[i];
        const float b = group(next, 1)[i];
        if (channel.interpolation == KeyInterpolation::linear) {
            result[i] = a + t * (b - a);
            continue;
        }
        const auto seconds_between = static_cast<float>(span);
        const float t2 = t * t;
        const float t3 = t2 * t;
        result[i] = (2.0F * t3 - 3.0F * t2 + 1.0F) * a +
                    seconds_between * (t3 - 2.0F * t2 + t) * group(key, 2)[i] +
                    (3.0F * t2 - 2.0F * t3) * b + seconds_between * (t3 - t2) * group(next, 0)[i];
    }
    return result;
}

glm::vec4 detail::value_at(const KeyChannel& channel, double seconds) {
    const std::vector<float>& times = channel.times;
    if (times.empty() || channel.values.size() != times.size() * values_per_key(channel))
        check_keys(channel);  // Throws.
    const auto after =
        std::upper_bound(times.begin(), times.end(), seconds,
                         [](double t, float key) { return t < static_cast<double>(key); });
    const auto next = static_cast<std::size_t>(after - times.begin());
    if (next == 0 || next == times.size()) {
        const glm::vec4& held = key_value(channel, next == 0 ? 0 : next - 1);
        return channel.property == KeyChannel::Property::rotation ? glm::normalize(held) : held;
    }
    const auto from = static_cast<double>(times[next - 1]);
    const double span = static_cast<double>(times[next]) - from;
    return between(channel, next - 1, static_cast<float>((seconds - from) / span));
}

// Poses

namespace {

/// The direction of an object whose node is scaled to 0.
constexpr glm::vec3 default_back{0.0F, 0.0F, 1.0F};

/// The transform of a node within its parent at one time.
struct LocalTransform {
    glm::vec3 translation{0.0F};
    glm::quat rotation{1.0F, 0.0F, 0.0F, 0.0F};
    glm::vec3 scale{1.0F};
    std::optional<glm::mat4> matrix;
    std::optional<glm::mat4> turntable;  ///< Applied first.
    std::vector<float> weights{};        ///< Of morph targets, if animated.
};

glm::vec3 unit_or(const glm::vec3& direction, const glm::vec3& fallback) {
    const glm::dvec3 precise(direction);
    const double length = glm::length(precise);
    return length > 0.0 && std::isfinite(length) ? glm::vec3(precise / length) : fallback;
}

/// Rotates by an angle about a unit vector, counter-clockwise seen from its tip.
glm::mat3 rotation_about(const glm::dvec3& axis, double angle) {
    const double cosine = portable::cos(angle);
    const glm::dvec3 s = portable::sin(angle) * axis;
    const glm::dvec3 c = (1.0 - cosine) * axis;
    return {glm::dvec3(c.x * axis.x + cosine, c.x * axis.y + s.z, c.x * axis.z - s.y),
            glm::dvec3(c.y * axis.x - s.z, c.y * axis.y + cosine, c.y * axis.z + s.x),
            glm::dvec3(c.z * axis.x + s.y, c.z * axis.y - s.x, c.z * axis.z + cosine)};
}

glm::mat4 matrix_of(const LocalTransform& transform) {
    glm::mat4 matrix(1.0F);
    if (transform.matrix) {
        matrix = *transform.matrix;
    } else {
        matrix = glm::translate(glm::mat4(1.0F), transform.translation) *
                 glm::mat4_cast(glm::normalize(transform.rotation)) *
                 glm::scale(glm::mat4(1.0F), transform.scale);
    }
    return transform.turntable ? matrix * *transform.turntable : matrix;
}

/// Returns the time within one run of an animation of this length.
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

/// Applies one animation at a time to the transforms of nodes at rest.
class Animator {
  public:
    Animator(std::vector<LocalTransform>& transforms, double seconds)
        : transforms_(transforms), seconds_(seconds) {}

    void operator()(const KeyAnimation& animation) const {
        const double now = wrapped(seconds_, length_of(animation));
        for (const KeyChannel& channel : animation.channels) {
            if (channel.property == KeyChannel::Property::pointer) continue;  // set_numbers()
            LocalTransform& transform = at(channel.node);
            if (channel.property == KeyChannel::Property::weights) {
                transform.weights = weights_at(channel, now);
                continue;
            }
            const glm::vec4 value = value_at(channel, now);
            switch (channel.property) {
                case KeyChannel::Property::translation:
                    transform.translation = glm::vec3(value);
                    break;
                case KeyChannel::Property::rotation:
                    transform.rotation = glm::quat(value.w, value.x, value.y, value.z);
                    break;
                case KeyChannel::Property::scale:
                    transform.scale = glm::vec3(value);
                    break;
                case KeyChannel::Property::weights:
                case KeyChannel::Property::pointer:
                    break;
            }
        }
    }

    void operator()(const Orbit& orbit) const {
        const glm::mat3 axes = orbit_axes(angle(orbit.azimuth, orbit.azimuth_speed),
                                          angle(orbit.elevation, orbit.elevation_speed));
        LocalTransform& transform = at(orbit.node);
        transform.translation = orbit.center + orbit.radius * axes[2];
        if (orbit.faces_center) transform.rotation = glm::quat_cast(axes);
    }

    void operator()(const Turntable& turntable) const {
        const double turned = angle(turntable.angle, turntable.speed);
        const glm::dvec3 axis = glm::normalize(glm::dvec3(turntable.axis));
        at(turntable.node).turntable = glm::mat4(rotation_about(axis, turned));
    }

  private:
    [[nodiscard]] LocalTransform& at(std::size_t node) const {
        if (node >= transforms_.size()) {
            throw InvalidInput(fmt::format("an animation names node {}, but there are only {}",
                                           node, transforms_.size()));
        }
        return transforms_[node];
    }

    [[nodiscard]] double angle(float start, float speed) const {
        return static_cast<double>(start) + static_cast<double>(speed) * seconds_;
    }

    std::vector<LocalTransform>& transforms_;
    double seconds_;
};

/// Calls visit(animation) for every animation that plays.
template <typename Visit>
void for_each_playing(const SceneGraph& graph, const Visit& visit) {
    std::size_t clip = 0;
    for (const Animation& animation : graph.animations) {
        const bool is_clip = std::holds_alternative<KeyAnimation>(animation);
        if (is_clip && graph.clip && *graph.clip != clip++) continue;
        visit(animation);
    }
}

/// Calls visit(value, range) for the number or color of this name, which may be part of a member:
/// "metallic_roughness.roughness". An absent optional number is made first, unless the owner is
/// const. \return whether there is one
template <typename Owner, typename Visit>
bool visit_number(Owner& owner, std::string_view name, const Visit& visit) {
    bool found = false;
    const auto rest_after = [&](std::string_view own) -> std::optional<std::string_view> {
        if (own.empty()) return name;
        if (!name.starts_with(own) || !name.substr(own.size()).starts_with('.'))
            return std::nullopt;
        return name.substr(own.size() + 1);
    };
    for_each_field<std::remove_const_t<Owner>>([&](const auto& field) {
        auto& member = owner.*field.member;
        using Value = std::remove_cvref_t<decltype(member)>;
        constexpr bool is_number = std::is_same_v<Value, float> || std::is_same_v<Value, glm::vec3>;
        const std::string_view own = field.name;
        if constexpr (is_number) {
            if (own != name) return;
            visit(member, field.range);
            found = true;
        } else if constexpr (std::is_same_v<Value, std::optional<float>> ||
                             std::is_same_v<Value, std::optional<glm::vec3>>) {
            if (own != name) return;
            found = true;
            if constexpr (!std::is_const_v<Owner>) {
                if (!member) member.emplace();
            }
            if (member) visit(*member, field.range);
        } else if constexpr (has_fields<Value>) {
            if (const auto rest = rest_after(own)) found |= visit_number(member, *rest, visit);
        } else if constexpr (is_optional_value<Value>) {
            if constexpr (has_fields<typename Value::value_type>) {
                const auto rest = rest_after(own);
                if (rest && member) found |= visit_number(*member, *rest, visit);
            }
        }
    });
    return found;
}

/// Calls visit(value, range) for the number or color that a channel moves. \return whether there
/// is one
template <typename Graph, typename Visit>
bool visit_moved(Graph& graph, const KeyChannel& channel, const Visit& visit) {
    const std::string_view pointer = channel.pointer;
    const std::size_t dot = std::min(pointer.find('.'), pointer.size());
    const std::string_view list = pointer.substr(0, dot);
    const std::string_view name = pointer.substr(std::min(dot + 1, pointer.size()));
    const auto in = [&](auto& objects) {
        return channel.node < objects.size() && visit_number(objects[channel.node], name, visit);
    };
    if (list == "materials") return in(graph.scene.materials);
    if (list == "directional_lights") return in(graph.scene.directional_lights);
    if (list == "point_lights") return in(graph.scene.point_lights);
    if (list == "spot_lights") return in(graph.scene.spot_lights);
    return list == "cameras" && channel.node < graph.cameras.size() &&
           visit_number(graph.cameras[channel.node].camera, name, visit);
}

float nearest(const glm::vec4& value, float /*as*/, const FieldRange& range) {
    return std::clamp(value.x, range.min, range.max);
}
glm::vec3 nearest(const glm::vec4& value, const glm::vec3& /*as*/, const FieldRange& range) {
    return glm::clamp(glm::vec3(value), range.min, range.max);
}

glm::vec4 as_vector(float number) {
    return {number, 0.0F, 0.0F, 0.0F};
}
glm::vec4 as_vector(const glm::vec3& color) {
    return {color, 0.0F};
}

/// Keeps what validate() demands beyond the ranges of fields.
void keep_valid(SceneGraph& graph, const KeyChannel& channel) {
    if (channel.pointer.starts_with("spot_lights.")) {
        SpotLight& spot = graph.scene.spot_lights[channel.node];
        spot.outer_cone = std::max(spot.outer_cone, 1e-3F);
        spot.inner_cone = std::min(spot.inner_cone, std::nextafter(spot.outer_cone, 0.0F));
    } else if (channel.pointer.starts_with("cameras.")) {
        Camera& camera = graph.cameras[channel.node].camera;
        camera.vertical_fov =
            std::clamp(camera.vertical_fov, 1e-3F, std::numbers::pi_v<float> - 1e-3F);
        if (!graph.scene.camera || graph.chosen_camera != channel.node) return;
        graph.scene.camera->vertical_fov = camera.vertical_fov;
        graph.scene.camera->orthographic_height = camera.orthographic_height;
    }
}

/// Calls visit(channel, seconds) for each channel of numbers and colors that plays.
template <typename Visit>
void for_each_pointer(const SceneGraph& graph, double seconds, const Visit& visit) {
    for_each_playing(graph, [&](const Animation& animation) {
        const auto* keys = std::get_if<KeyAnimation>(&animation);
        if (keys == nullptr) return;
        for (const KeyChannel& channel : keys->channels) {
            if (channel.property == KeyChannel::Property::pointer)
                visit(channel, wrapped(seconds, length_of(*keys)));
        }
    });
}

/// Sets the numbers and colors that animations move.
void set_numbers(SceneGraph& graph, double seconds) {
    for_each_pointer(graph, seconds, [&](const KeyChannel& channel, double now) {
        const glm::vec4 value = value_at(channel, now);
        const bool found = visit_moved(graph, channel, [&](auto& moved, const FieldRange& range) {
            moved = nearest(value, moved, range);
        });
        if (found) keep_valid(graph, channel);
    });
}

std::vector<LocalTransform> transforms_at(const SceneGraph& graph, double seconds) {
    std::vector<LocalTransform> transforms;
    transforms.reserve(graph.nodes.size());
    for (const SceneNode& node : graph.nodes)
        transforms.push_back(
            {node.translation, node.rotation, node.scale, node.matrix, std::nullopt, {}});
    for_each_playing(graph, [&](const Animation& animation) {
        std::visit(Animator(transforms, seconds), animation);
    });
    return transforms;
}

/// Returns the transform from each node to the world. Every chain of parents is walked once.
std::vector<glm::mat4> world_matrices(const SceneGraph& graph,
                                      const std::vector<LocalTransform>& transforms) {
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
            const glm::mat4 local = matrix_of(transforms[node]);
            world[node] = parent ? world[*parent] * local : local;
            is_done[node] = true;
        }
    }
    return world;
}

/// The world transforms of objects that nodes carry.
class NodeMatrices {
  public:
    explicit NodeMatrices(std::vector<glm::mat4> world_from_node)
        : world_from_node_(std::move(world_from_node)) {}

    /// Returns nothing if no node carries the object.
    [[nodiscard]] std::optional<glm::mat4> world_from_object(const Carried& carried) const {
        if (!carried.node) return std::nullopt;
        if (*carried.node >= world_from_node_.size()) {
            throw InvalidInput(
                fmt::format("an object is attached to node {}, but there are only {}",
                            *carried.node, world_from_node_.size()));
        }
        const glm::mat4& node = world_from_node_[*carried.node];
        if (!carried.position_only) return node * carried.node_from_object;
        glm::mat4 matrix = carried.node_from_object;
        matrix[3] = node * carried.node_from_object[3];
        return matrix;
    }

  private:
    std::vector<glm::mat4> world_from_node_;
};

/// Calls move(object, matrix) for every object of a list that hangs on a node.
template <typename Object, typename Move>
void move_all(std::vector<Object>& objects, const std::vector<Carried>& carried,
              const NodeMatrices& nodes, const Move& move) {
    for (std::size_t i = 0; i < std::min(objects.size(), carried.size()); ++i) {
        if (const auto matrix = nodes.world_from_object(carried[i])) move(objects[i], *matrix);
    }
}

glm::vec3 direction_of(const glm::mat4& world_from_light) {
    return -unit_or(glm::vec3(world_from_light[2]), default_back);
}

/// Returns the camera's matrix: rotation and translation without scale.
glm::mat4 camera_matrix(const glm::mat4& world_from_object) {
    const glm::vec3 back = unit_or(glm::vec3(world_from_object[2]), default_back);
    const glm::vec3 right =
        unit_or(glm::cross(unit_or(glm::vec3(world_from_object[1]), {0.0F, 1.0F, 0.0F}), back),
                glm::vec3(1.0F, 0.0F, 0.0F));
    return {glm::vec4(right, 0.0F), glm::vec4(glm::cross(back, right), 0.0F), glm::vec4(back, 0.0F),
            world_from_object[3]};
}

/// Returns a far distance behind the farthest corner of the boxes of all meshes.
float far_behind_all(SceneGraph& graph, const Camera& camera) {
    const Scene& scene = graph.scene;
    for (std::size_t i = graph.mesh_bounds.size(); i < scene.meshes.size(); ++i)
        graph.mesh_bounds.push_back(bounds_of(scene.meshes[i]));
    const glm::vec3 eye(camera.world_from_view[3]);
    float reach = 0.0F;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const Instance& instance = scene.instances[i];
        const Bounds box = is_deformed(instance) ? bounds_of(deformed_mesh(scene, i))
                                                 : graph.mesh_bounds.at(instance.mesh);
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

void pose_camera(SceneGraph& graph, const NodeMatrices& nodes) {
    if (!graph.scene.camera) return;
    Camera& camera = *graph.scene.camera;
    if (const auto matrix = nodes.world_from_object(graph.camera))
        camera.world_from_view = camera_matrix(*matrix);
    if (graph.camera_sees_all) camera.far = far_behind_all(graph, camera);
}

}  // namespace

void choose_camera(SceneGraph& graph, std::size_t index) {
    if (index >= graph.cameras.size()) {
        throw InvalidInput(fmt::format("no camera {}: there are {}", index, graph.cameras.size()));
    }
    const FileCamera& chosen = graph.cameras[index];
    graph.chosen_camera = index;
    graph.scene.camera = chosen.camera;
    graph.camera = chosen.carried;
    graph.camera_sees_all = chosen.sees_all;
}

std::vector<std::string> camera_names(const SceneGraph& graph) {
    std::vector<std::string> names;
    for (const FileCamera& camera : graph.cameras) {
        names.push_back(camera.name.empty() ? fmt::format("camera {}", names.size() + 1)
                                            : camera.name);
    }
    return names;
}

void pose(SceneGraph& graph, double seconds) {
    if (!std::isfinite(seconds))
        throw InvalidInput(fmt::format("the time is {}, but must be finite", seconds));
    std::vector<LocalTransform> transforms = transforms_at(graph, seconds);
    std::vector<glm::mat4> world_from_node = world_matrices(graph, transforms);
    std::vector<NodeWeights> weights;
    for (std::size_t i = 0; i < transforms.size(); ++i) {
        if (!transforms[i].weights.empty())
            weights.push_back({i, std::move(transforms[i].weights)});
    }
    const NodeMatrices nodes(world_from_node);
    Scene& scene = graph.scene;
    move_all(
        scene.instances, graph.instances, nodes,
        [](Instance& instance, const glm::mat4& matrix) { instance.world_from_object = matrix; });
    move_all(scene.directional_lights, graph.directional_lights, nodes,
             [](DirectionalLight& light, const glm::mat4& matrix) {
                 light.direction_world = direction_of(matrix);
             });
    move_all(scene.point_lights, graph.point_lights, nodes,
             [](PointLight& light, const glm::mat4& matrix) {
                 light.position_world = glm::vec3(matrix[3]);
             });
    move_all(scene.spot_lights, graph.spot_lights, nodes,
             [](SpotLight& light, const glm::mat4& matrix) {
                 light.point.position_world = glm::vec3(matrix[3]);
                 light.direction_world = direction_of(matrix);
             });
    set_poses(graph, world_from_node, weights);
    set_numbers(graph, seconds);
    pose_camera(graph, nodes);
}

bool moves_materials(const SceneGraph& graph) {
    bool moves = false;
    for_each_pointer(graph, 0.0, [&](const KeyChannel& channel, double /*now*/) {
        const std::string_view pointer = channel.pointer;
        moves |= pointer.starts_with("materials.") || pointer.ends_with("lights.ambient");
    });
    return moves;
}

void detail::check_pointer(const SceneGraph& graph, const KeyChannel& channel) {
    if (visit_moved(graph, channel, [](const auto& /*moved*/, const FieldRange& /*range*/) {}))
        return;
    throw InvalidInput(fmt::format("an animation moves '{}' of object {}, which does not exist",
                                   channel.pointer, channel.node));
}

bool detail::is_in_range(const SceneGraph& graph, const KeyChannel& channel) {
    bool is_in = true;
    SceneGraph copy;  // Of the objects, because an optional number may be absent.
    copy.scene.materials = graph.scene.materials;
    copy.scene.directional_lights = graph.scene.directional_lights;
    copy.scene.point_lights = graph.scene.point_lights;
    copy.scene.spot_lights = graph.scene.spot_lights;
    copy.cameras = graph.cameras;
    visit_moved(copy, channel, [&](auto& moved, const FieldRange& range) {
        for (std::size_t key = 0; key < channel.times.size(); ++key) {
            const glm::vec4& value = key_value(channel, key);
            moved = nearest(value, moved, range);
            const glm::vec4 kept = as_vector(moved);
            is_in &=
                kept.x == value.x && (std::is_same_v<std::remove_cvref_t<decltype(moved)>, float> ||
                                      (kept.y == value.y && kept.z == value.z));
        }
    });
    return is_in;
}

double duration(const SceneGraph& graph) {
    double longest = 0.0;
    const auto add_rotation = [&](float speed) {
        if (speed != 0.0F)
            longest =
                std::max(longest, 2.0 * std::numbers::pi / std::abs(static_cast<double>(speed)));
    };
    for_each_playing(graph, [&](const Animation& animation) {
        if (const auto* keys = std::get_if<KeyAnimation>(&animation)) {
            longest = std::max(longest, length_of(*keys));
        } else if (const auto* orbit = std::get_if<Orbit>(&animation)) {
            add_rotation(orbit->azimuth_speed);
            add_rotation(orbit->elevation_speed);
        } else if (const auto* turntable = std::get_if<Turntable>(&animation)) {
            add_rotation(turntable->speed);
        }
    });
    return longest;
}

std::vector<std::string> clip_names(const SceneGraph& graph) {
    std::vector<std::string> names;
    for (const Animation& animation : graph.animations) {
        const auto* keys = std::get_if<KeyAnimation>(&animation);
        if (keys == nullptr) continue;
        names.push_back(keys->name.empty() ? fmt::format("animation {}", names.size() + 1)
                                           : keys->name);
    }
    return names;
}

bool clips_exclude_each_other(const SceneGraph& graph) {
    using Moved = std::tuple<std::size_t, KeyChannel::Property, std::string>;
    std::set<Moved> moved;
    for (const Animation& animation : graph.animations) {
        const auto* keys = std::get_if<KeyAnimation>(&animation);
        if (keys == nullptr) continue;
        std::set<Moved> own;
        for (const KeyChannel& channel : keys->channels)
            own.emplace(channel.node, channel.property, channel.pointer);
        for (const auto& property : own) {
            if (!moved.insert(property).second) return true;
        }
    }
    return false;
}

glm::mat4 looking_along(const glm::vec3& position, const glm::vec3& direction) {
    const glm::vec3 back = -unit_or(direction, -default_back);
    // For a vertical direction the world's z replaces its y.
    const bool is_vertical = std::abs(back.y) > 0.9999F;
    const glm::vec3 up = is_vertical ? glm::vec3(0.0F, 0.0F, 1.0F) : glm::vec3(0.0F, 1.0F, 0.0F);
    const glm::vec3 right = glm::normalize(glm::cross(up, back));
    return {glm::vec4(right, 0.0F), glm::vec4(glm::cross(back, right), 0.0F), glm::vec4(back, 0.0F),
            glm::vec4(position, 1.0F)};
}

// The union of two graphs

namespace {

template <typename T>
void join(std::vector<T>& all, std::vector<T>&& more) {
    all.insert(all.end(), std::make_move_iterator(more.begin()),
               std::make_move_iterator(more.end()));
}

void shift_images(Material& material, std::size_t by) {
    for (const TextureSlotInfo& slot : texture_slots) {
        if (Texture* const texture = find_texture(material, slot.slot)) texture->image += by;
    }
}

void shift_node(Animation& animation, std::size_t by) {
    if (auto* keys = std::get_if<KeyAnimation>(&animation)) {
        for (KeyChannel& channel : keys->channels)
            if (channel.property != KeyChannel::Property::pointer) channel.node += by;
    } else if (auto* orbit = std::get_if<Orbit>(&animation)) {
        orbit->node += by;
    } else if (auto* turntable = std::get_if<Turntable>(&animation)) {
        turntable->node += by;
    }
}

/// Shifts the indices of materials and lights that an animation moves. Animations of cameras are
/// removed, because the part has no camera.
void shift_pointers(Animation& animation, const Scene& before) {
    auto* const keys = std::get_if<KeyAnimation>(&animation);
    if (keys == nullptr) return;
    std::erase_if(keys->channels, [](const KeyChannel& channel) {
        return channel.pointer.starts_with("cameras.");
    });
    for (KeyChannel& channel : keys->channels) {
        const auto is_in = [&](std::string_view list) { return channel.pointer.starts_with(list); };
        if (is_in("materials.")) channel.node += before.materials.size();
        if (is_in("directional_lights.")) channel.node += before.directional_lights.size();
        if (is_in("point_lights.")) channel.node += before.point_lights.size();
        if (is_in("spot_lights.")) channel.node += before.spot_lights.size();
    }
}

/// Moves the objects of the part to the nodes of the whole graph. Objects that stood in the part's
/// world hang on the given node.
class Carriers {
  public:
    Carriers(std::size_t node, std::size_t first_node) : node_(node), first_node_(first_node) {}

    /// \param matrix_in_part  the transform of an object from its own space to the part's world
    template <typename Object, typename MatrixInPart>
    void join_all(std::vector<Object>& all, std::vector<Carried>& carried,
                  std::vector<Object>&& more, const std::vector<Carried>& more_carried,
                  const MatrixInPart& matrix_in_part) const {
        carried.resize(all.size());
        for (std::size_t i = 0; i < more.size(); ++i) {
            const bool hangs = i < more_carried.size() && more_carried[i].node;
            Carried& result = carried.emplace_back(hangs ? more_carried[i] : Carried{});
            if (hangs) {
                *result.node += first_node_;
            } else {
                result = Carried{node_, matrix_in_part(more[i])};
            }
        }
        join(all, std::move(more));
    }

  private:
    std::size_t node_;
    std::size_t first_node_;
};

void append_objects(SceneGraph& graph, SceneGraph& part, const Carriers& carriers) {
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

void detail::append(SceneGraph& graph, SceneGraph part, std::size_t node) {
    const std::size_t first_image = graph.scene.images.size();
    const std::size_t first_mesh = graph.scene.meshes.size();
    const auto first_material = static_cast<std::uint32_t>(graph.scene.materials.size());
    const std::size_t first_node = graph.nodes.size();
    const std::size_t first_instance = graph.scene.instances.size();
    for (Material& material : part.scene.materials)
        shift_images(material, first_image);
    for (Shared<Mesh>& mesh : part.scene.meshes) {
        for (MaterialRange& range : mesh.edit().material_ranges) {
            if (range.material) *range.material += first_material;
        }
    }
    for (Instance& instance : part.scene.instances)
        instance.mesh += first_mesh;
    for (DeformedInstance& deformed : part.deformed) {
        deformed.instance += first_instance;
        deformed.node += first_node;
        for (std::size_t& joint : deformed.joints)
            joint += first_node;
    }
    std::size_t clip = 0;
    std::erase_if(part.animations, [&](const Animation& animation) {  // What does not play.
        return std::holds_alternative<KeyAnimation>(animation) && part.clip && *part.clip != clip++;
    });
    for (SceneNode& child : part.nodes)
        child.parent = child.parent ? *child.parent + first_node : node;
    for (Animation& animation : part.animations) {
        shift_node(animation, first_node);
        shift_pointers(animation, graph.scene);
    }
    append_objects(graph, part, Carriers(node, first_node));
    join(graph.scene.images, std::move(part.scene.images));
    join(graph.scene.materials, std::move(part.scene.materials));
    join(graph.scene.meshes, std::move(part.scene.meshes));
    join(graph.nodes, std::move(part.nodes));
    join(graph.animations, std::move(part.animations));
    join(graph.deformed, std::move(part.deformed));
    graph.scene.ambient += part.scene.ambient;
}

}  // namespace relief::shade
