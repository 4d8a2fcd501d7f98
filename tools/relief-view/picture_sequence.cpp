// SPDX-License-Identifier: Apache-2.0
#include "picture_sequence.h"

#include <fmt/format.h>
#include <unistd.h>

#include <glm/gtc/matrix_transform.hpp>
#include <memory>
#include <numbers>

#include "common/command.h"
#include "picture_sink.h"
#include "portable_math.h"
#include "relief/shade/renderer.h"
#include "scene_options.h"
#include "view_options.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

constexpr int max_frames = 100000;

double time_of(const ComposedScene& composed, const ViewOptions& options, int index) {
    if (!options.frames) return options.time.value_or(0.0);
    const double all = options.seconds.value_or(duration(composed.graph));
    return all * index / *options.frames;
}

/// Rotates the model about the vertical axis through its center. Lights, their markers and the
/// environment do not rotate.
void turn(ComposedScene& composed, double angle) {
    const glm::vec3 middle = composed.middle;
    glm::mat4 turned = glm::translate(glm::mat4(1.0F), middle);
    const auto rounded = static_cast<double>(static_cast<float>(angle));
    const auto sine = static_cast<float>(relief::detail::portable::sin(rounded));
    const auto cosine = static_cast<float>(relief::detail::portable::cos(rounded));
    glm::mat4 rotation(1.0F);
    rotation[0] = {cosine, 0.0F, -sine, 0.0F};
    rotation[2] = {sine, 0.0F, cosine, 0.0F};
    turned = glm::translate(turned * rotation, -middle);
    for (std::size_t i = 0; i < composed.at_rest.size(); ++i)
        composed.scene().instances[i].world_from_object = turned * composed.at_rest[i];
}

}  // namespace

void add_sequence_options(CLI::App& app, ViewOptions& options) {
    const std::string group = "Animation";
    const auto add_count = [&](const char* name, std::optional<int>& target,
                               const char* description) {
        add_value(app, name, "N", description,
                  [&target](const std::string& subject, const std::string& text) {
                      target = parse_integer(subject, text, 1, max_frames);
                  })
            .group(group);
    };
    add_count("--turntable", options.turntable,
              "Draw N pictures while the model rotates once about its vertical axis. A .png or "
              ".exr output becomes numbered files (spin-0001.png, or # in the name for each "
              "digit); .apng, .mp4 and .webm outputs become animations.");
    add_count("--frames", options.frames,
              "Draw N pictures of the scene's animation, evenly spaced in time.");
    add_number(app, "--seconds", "S", options.seconds, {1e-3, 1e6, ""},
               "Set the duration of the animation for --frames. Default: until the longest "
               "animation ends.")
        .group(group);
    add_number(app, "--fps", "F", options.frames_per_second, {0.1, 1000, ""},
               "Set the pictures per second of an animation or video. Default: 25.")
        .group(group);
    add_value(app, "--animation", "NAME|N|all",
              "Play the animation of this name or number of a glTF file, or all of them at once. "
              "Default: all; the first one if they move the same nodes.",
              [&](const std::string&, const std::string& text) { options.animation = text; })
        .group(group);
    add_number(
        app, "--time", "T", options.time, {-1e6, 1e6, ""},
        "Set the time of the picture in the scene's animation, in seconds. A window then opens "
        "paused at this time. Default: 0.")
        .group(group);
}

void pose_for(ComposedScene& composed, const ViewOptions& options, int index) {
    pose(composed.graph, time_of(composed, options, index));
    if (options.turntable) turn(composed, 2.0 * std::numbers::pi * index / *options.turntable);
}

Frame draw_sequence(const std::function<std::unique_ptr<Renderer>()>& prepare,
                    ComposedScene& composed, const ViewOptions& options, Stages& stages,
                    const std::function<void(const Frame&)>& take, SequenceTimes& times) {
    const int count = picture_count(options);
    std::unique_ptr<Renderer> renderer = stages.run("prepare", prepare);
    const bool prepares_each = moves_materials(composed.graph);
    Frame frame;
    for (int i = 0; i < count; ++i) {
        stages.run("draw", fmt::format("draw {} of {}", i + 1, count), [&] {
            if (i > 0) {  // The scene is composed for the first picture.
                pose_for(composed, options, i);
                if (prepares_each)
                    renderer = prepare();
                else
                    renderer->move(composed.scene());
            }
            const bool uses_scene_camera = composed.camera_follows_scene && composed.scene().camera;
            frame = renderer->draw(uses_scene_camera ? *composed.scene().camera : composed.camera);
        });
        times.draw.push_back(frame.times.draw);
        times.read_back.push_back(frame.times.read_back);
        stages.run("write", [&] { take(frame); });
    }
    return frame;
}

}  // namespace relief::tools
