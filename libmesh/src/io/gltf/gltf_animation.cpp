// SPDX-License-Identifier: Apache-2.0
// Animation channels of a glTF document as arrays of keys: seconds and values as floats. A channel
// that cannot be used is left out and counted; the others are kept.
// Source: glTF 2.0 (ISO/IEC 12113), section 3.11. Tests:
// tests/mesh/io/gltf/gltf_animation_test.cpp.
#include "io/gltf/gltf_animation.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "geometry/direction.h"
#include "io/gltf/gltf_accessor.h"
#include "relief/mesh/error.h"

namespace relief {
namespace {

std::optional<GltfChannel::Path> path_from(const std::string& path) {
    if (path == "translation") return GltfChannel::Path::translation;
    if (path == "rotation") return GltfChannel::Path::rotation;
    if (path == "scale") return GltfChannel::Path::scale;
    return std::nullopt;
}

GltfChannel::Interpolation interpolation_from(const std::string& name) {
    if (name == "STEP") return GltfChannel::Interpolation::step;
    if (name == "CUBICSPLINE") return GltfChannel::Interpolation::cubic_spline;
    return GltfChannel::Interpolation::linear;
}

std::vector<glm::vec4> values_of(const GltfContents& contents, std::size_t accessor,
                                 GltfChannel::Path path) {
    if (path == GltfChannel::Path::rotation) return float_elements<glm::vec4>(contents, accessor);
    std::vector<glm::vec4> values;
    for (const glm::vec3& value : float_elements<glm::vec3>(contents, accessor))
        values.emplace_back(value, 0.0F);
    return values;
}

bool is_usable(const GltfChannel& channel) {
    const bool cubic = channel.interpolation == GltfChannel::Interpolation::cubic_spline;
    const std::size_t per_key = cubic ? 3 : 1;
    if (channel.times.empty() || channel.values.size() != per_key * channel.times.size())
        return false;
    const auto no_order =
        std::adjacent_find(channel.times.begin(), channel.times.end(), std::greater_equal<float>());
    if (no_order != channel.times.end() || !(channel.times.front() >= 0.0F) ||
        !std::isfinite(channel.times.back())) {
        return false;
    }
    if (!std::all_of(channel.values.begin(), channel.values.end(), is_finite<4, float>))
        return false;
    if (channel.path != GltfChannel::Path::rotation) return true;
    for (std::size_t key = 0; key < channel.times.size(); ++key) {
        if (channel.values[key * per_key + per_key / 2] == glm::vec4(0.0F)) return false;
    }
    return true;
}

/// The keys, or nothing if their accessors hold something else.
std::optional<GltfChannel> keys_from(const GltfContents& contents, const Json& sampler,
                                     std::size_t node, GltfChannel::Path path) {
    GltfChannel channel{.node = node, .path = path, .times = {}, .values = {}};
    channel.interpolation = interpolation_from(text_in(sampler, "interpolation"));
    try {
        for (const auto& time : float_elements<glm::vec1>(contents, size_in(sampler, "input")))
            channel.times.push_back(time.x);
        channel.values = values_of(contents, size_in(sampler, "output"), path);
    } catch (const InvalidInput&) {
        return std::nullopt;
    }
    if (!is_usable(channel)) return std::nullopt;
    return channel;
}

void add_channel(const GltfContents& contents, const Json& animation, const Json& json,
                 std::size_t number, GltfAnimation& result, Report& report) {
    const Json& target = json["target"];
    const auto node = index_in(target, "node");
    const std::string name = text_in(target, "path");
    const auto path = path_from(name);
    if (!path) {
        report.add(name == "weights" ? "animated morph weights" : "animation of an extension",
                   "channel", number, "left out");
        return;
    }
    if (!node) return;  // glTF's own way to say that a channel is to be ignored.
    if (contents.root["nodes"][*node].contains("matrix")) {
        report.add("animated node with a matrix", "channel", number, "left out");
        return;
    }
    const Json& sampler = animation["samplers"][size_in(json, "sampler")];
    if (auto channel = keys_from(contents, sampler, *node, *path)) {
        result.channels.push_back(std::move(*channel));
    } else {
        report.add("animation channel with unusable keys", "channel", number,
                   "left out: its node stays at rest");
    }
}

}  // namespace

std::vector<GltfAnimation> animations_of(const GltfContents& contents, Report& report) {
    std::vector<GltfAnimation> result;
    std::size_t number = 0;  // Counts channels through all animations.
    for (const Json& json : array_in(contents.root, "animations")) {
        GltfAnimation& animation = result.emplace_back();
        animation.name = text_in(json, "name");
        for (const Json& channel : json["channels"])
            add_channel(contents, json, channel, number++, animation, report);
    }
    return result;
}

}  // namespace relief
