// SPDX-License-Identifier: Apache-2.0
// Key frames: the keys around a time, and the value between them. Seconds; translations and scales
// as they are, rotations as unit quaternions. Source: glTF 2.0, section 3.11 and appendix C.
// Keys of the wrong number or order throw InvalidInput. Tests:
// tests/shade/scene/scene_graph_test.cpp.
#include "scene/key_channel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "relief/mesh/error.h"

namespace relief {

namespace {

std::size_t values_per_key(const KeyChannel& channel) {
    return channel.interpolation == KeyInterpolation::cubic_spline ? 3 : 1;
}

/// The value of a key itself, without its tangents.
const glm::vec4& key_value(const KeyChannel& channel, std::size_t key) {
    const std::size_t per_key = values_per_key(channel);
    return channel.values[key * per_key + per_key / 2];
}

/// On the shortest arc between two unit quaternions.
glm::vec4 slerp(const glm::vec4& a, const glm::vec4& b, float share) {
    const glm::quat turned =
        glm::slerp(glm::quat(a.w, a.x, a.y, a.z), glm::quat(b.w, b.x, b.y, b.z), share);
    return {turned.x, turned.y, turned.z, turned.w};
}

/// Hermite's cubic between a key and the next, with tangents by seconds.
glm::vec4 hermite(const KeyChannel& channel, std::size_t key, float share) {
    const float span = channel.times[key + 1] - channel.times[key];
    const glm::vec4& from = channel.values[3 * key + 1];
    const glm::vec4& leaving = channel.values[3 * key + 2];
    const glm::vec4& arriving = channel.values[3 * key + 3];
    const glm::vec4& to = channel.values[3 * key + 4];
    const float s = share;
    const float s2 = s * s;
    const float s3 = s2 * s;
    return (2.0F * s3 - 3.0F * s2 + 1.0F) * from + span * (s3 - 2.0F * s2 + s) * leaving +
           (3.0F * s2 - 2.0F * s3) * to + span * (s3 - s2) * arriving;
}

/// Unit length, or the other where there is none.
glm::vec4 unit_or(const glm::vec4& quaternion, const glm::vec4& otherwise) {
    const float length = glm::length(quaternion);
    return length > 0.0F && std::isfinite(length) ? quaternion / length : otherwise;
}

glm::vec4 between(const KeyChannel& channel, std::size_t key, float share) {
    const bool rotates = channel.property == KeyChannel::Property::rotation;
    const glm::vec4 from =
        rotates ? glm::normalize(key_value(channel, key)) : key_value(channel, key);
    if (channel.interpolation == KeyInterpolation::step) return from;
    if (channel.interpolation == KeyInterpolation::cubic_spline) {
        const glm::vec4 value = hermite(channel, key, share);
        return rotates ? unit_or(value, from) : value;
    }
    const glm::vec4& to = key_value(channel, key + 1);
    return rotates ? slerp(from, glm::normalize(to), share) : glm::mix(from, to, share);
}

}  // namespace

void check_keys(const KeyChannel& channel) {
    const std::size_t keys = channel.times.size();
    if (keys == 0) throw InvalidInput("a channel has no keys");
    const std::size_t needed = keys * values_per_key(channel);
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

glm::vec4 value_at(const KeyChannel& channel, double seconds) {
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

}  // namespace relief
