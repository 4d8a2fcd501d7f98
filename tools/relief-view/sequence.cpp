// SPDX-License-Identifier: Apache-2.0
#include "sequence.h"

#include <fmt/format.h>

#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "common/text.h"
#include "relief/mesh/animated_png.h"
#include "relief/mesh/image_file.h"
#include "sequence_options.h"

namespace relief::tools {
namespace {

constexpr double usual_frames_per_second = 25.0;

class OneFile : public PictureSink {
  public:
    explicit OneFile(std::filesystem::path file) : file_(std::move(file)) {}
    void take(const Image& picture) override { write_image(file_, picture); }

  private:
    std::filesystem::path file_;
};

class NumberedFiles : public PictureSink {
  public:
    explicit NumberedFiles(std::filesystem::path output) : output_(std::move(output)) {}
    void take(const Image& picture) override {
        write_image(numbered_file(output_, ++index_), picture);
    }

  private:
    std::filesystem::path output_;
    int index_ = 0;
};

class AnimationSink : public PictureSink {
  public:
    AnimationSink(const std::filesystem::path& file, int frames, double seconds)
        : animation_(file, static_cast<std::uint32_t>(frames), seconds) {}
    void take(const Image& picture) override { animation_.add(picture); }
    void finish() override { animation_.finish(); }

  private:
    AnimatedPng animation_;
};

double time_of(const ComposedScene& composed, const ViewOptions& options, int index) {
    if (!options.frames) return options.time.value_or(0.0);
    const double all = options.seconds.value_or(duration(composed.graph));
    return all * index / *options.frames;
}

/// The model turned about the vertical axis through its middle; lamps and surroundings stay, and so
/// do the spheres that show lamps, which are no part of what is at rest.
void turn(ComposedScene& composed, double angle) {
    const glm::vec3 middle = composed.middle;
    glm::mat4 turned = glm::translate(glm::mat4(1.0F), middle);
    turned = glm::rotate(turned, static_cast<float>(angle), glm::vec3(0, 1, 0));
    turned = glm::translate(turned, -middle);
    for (std::size_t i = 0; i < composed.at_rest.size(); ++i)
        composed.scene().instances[i].world_from_object = turned * composed.at_rest[i];
}

}  // namespace

std::unique_ptr<PictureSink> make_sink(const ViewOptions& options) {
    const std::filesystem::path& output = *options.output;
    const int count = picture_count(options);
    if (extension_of(output) == ".apng") {
        const double rate = options.frames_per_second.value_or(usual_frames_per_second);
        return std::make_unique<AnimationSink>(output, count, 1.0 / rate);
    }
    if (options.turntable || options.frames) return std::make_unique<NumberedFiles>(output);
    return std::make_unique<OneFile>(output);
}

void pose_for(ComposedScene& composed, const ViewOptions& options, int index) {
    pose(composed.graph, time_of(composed, options, index));
    if (options.turntable) turn(composed, 2.0 * std::numbers::pi * index / *options.turntable);
}

Frame draw_sequence(Renderer& renderer, ComposedScene& composed, const ViewOptions& options,
                    Stages& stages, const std::function<void(const Frame&)>& take,
                    SequenceTimes& times) {
    const int count = picture_count(options);
    Frame frame;
    for (int i = 0; i < count; ++i) {
        stages.run("draw", fmt::format("draw {} of {}", i + 1, count), [&] {
            if (i > 0) {  // The first is how the scene was composed.
                pose_for(composed, options, i);
                renderer.move(composed.scene());
            }
            const bool own_camera = composed.camera_follows_scene && composed.scene().camera;
            frame = renderer.draw(own_camera ? *composed.scene().camera : composed.camera);
        });
        times.draw.push_back(frame.times.draw);
        times.read_back.push_back(frame.times.read_back);
        stages.run("write", [&] { take(frame); });
    }
    return frame;
}

}  // namespace relief::tools
