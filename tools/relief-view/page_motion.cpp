// SPDX-License-Identifier: Apache-2.0
#include "page_motion.h"

#include <algorithm>
#include <set>
#include <string>
#include <variant>

#include "effect_options.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

/// Each time is one more preparation of the scene.
constexpr std::size_t max_times = 64;

/// A step, or the end before a repetition, is between two times that are close.
constexpr double just_before = 1e-4;

/// Adds the keys of the materials of an animation, which repeats itself until an end.
void add_keys(std::set<double>& times, const KeyAnimation& animation, double end) {
    double length = 0.0;
    for (const KeyChannel& channel : animation.channels)
        length = std::max(length, static_cast<double>(channel.times.back()));
    if (!(length > 0.0)) return;
    const auto moves_material = [](const KeyChannel& channel) {
        return channel.pointer.starts_with("materials.") ||
               channel.pointer.ends_with("lights.ambient");
    };
    if (std::none_of(animation.channels.begin(), animation.channels.end(), moves_material)) return;
    for (double begin = 0.0; begin < end && times.size() <= max_times; begin += length) {
        times.insert(begin);
        times.insert(begin + length - just_before);
        for (const KeyChannel& channel : animation.channels) {
            if (!moves_material(channel)) continue;
            for (const float time : channel.times) {
                if (channel.interpolation == KeyInterpolation::step && time > 0.0F)
                    times.insert(begin + static_cast<double>(time) - just_before);
                times.insert(begin + static_cast<double>(time));
            }
        }
    }
}

}  // namespace

std::vector<double> material_times(const SceneGraph& graph) {
    if (!moves_materials(graph)) return {};
    const double end = duration(graph);
    std::set<double> keys;
    for (const Animation& animation : graph.animations) {
        if (const auto* each = std::get_if<KeyAnimation>(&animation)) add_keys(keys, *each, end);
    }
    std::vector<double> times;
    for (const double time : keys) {
        constexpr int parts = 4;
        if (!(time < end)) break;
        for (int i = 1; i < parts && !times.empty(); ++i)
            times.push_back(times.back() + (time - times.back()) / (parts + 1 - i));
        times.push_back(time);
    }
    return times.size() <= max_times ? times : std::vector<double>();
}

ComposedScene composed_at(const ComposedScene& composed, double seconds) {
    ComposedScene moved = composed;
    pose(moved.graph, seconds);
    return moved;
}

void force_moving_effects(ViewOptions& options, const FrameSettings& settings,
                          const ComposedScene& composed, const std::vector<double>& times) {
    std::set<std::string> always;
    std::set<std::string> sometimes;
    for (const double time : times) {
        const Scene scene = composed_at(composed, time).scene();
        const std::vector<std::string> names = effects_in(chosen_plan(options, scene, settings));
        const std::set<std::string> now(names.begin(), names.end());
        if (time == times.front()) always = now;
        std::erase_if(always, [&](const std::string& name) { return !now.contains(name); });
        sometimes.insert(now.begin(), now.end());
    }
    for (const std::string& name : sometimes) {
        if (!always.contains(name)) options.effects.requests.forced.push_back({name, true});
    }
}

}  // namespace relief::tools
