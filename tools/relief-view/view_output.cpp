// SPDX-License-Identifier: Apache-2.0
#include "view_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "common/model_file.h"
#include "common/text.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/report.h"
#include "relief/shade/scene_file.h"

namespace relief::tools {
namespace {

constexpr int max_frames = 100000;
constexpr std::size_t default_digits = 4;

bool is_sequence(const ViewOptions& options) {
    return options.turntable || options.frames;
}

}  // namespace

void add_sequence_options(CLI::App& app, ViewOptions& options) {
    const std::string group = "Sequences";
    const auto add_count = [&](const char* name, std::optional<int>& target,
                               const char* description) {
        add_value(app, name, "N", description,
                  [&target](const std::string& subject, const std::string& text) {
                      target = parse_integer(subject, text, 1, max_frames);
                  })
            .group(group);
    };
    add_count("--turntable", options.turntable,
              "Draw N pictures in which the model rotates once about its vertical axis. A .png or "
              ".exr output becomes numbered files (spin-0001.png, or # in the name for each "
              "digit); an .apng output becomes an animation.");
    add_count("--frames", options.frames,
              "Draw N pictures of the scene's animation, evenly spaced in time.");
    add_number(app, "--seconds", "S", options.seconds, {1e-3, 1e6, ""},
               "Set the duration of the animation for --frames. Default: until the longest "
               "animation ends.")
        .group(group);
    add_number(app, "--fps", "F", options.frames_per_second, {0.1, 1000, ""},
               "Set the pictures per second of an .apng animation. Default: 25.")
        .group(group);
    add_number(app, "--time", "T", options.time, {-1e6, 1e6, ""},
               "Set the time of the picture in the scene's animation, in seconds. Default: 0.")
        .group(group);
}

void check_sequence(const ViewOptions& options) {
    const bool animated = options.output && extension_of(*options.output) == ".apng";
    refuse(options.turntable && options.frames, "--turntable", "contradicts --frames",
           "leave one of them out");
    refuse(options.seconds && !options.frames, "--seconds", "needs --frames",
           "add --frames, or leave it out");
    refuse(options.frames_per_second && !animated, "--fps", "applies to .apng animations",
           "write an .apng, or leave it out");
    refuse(animated && !is_sequence(options), "--output " + options.output.value_or("").string(),
           "an animation needs several pictures", "add --turntable or --frames, or write a .png");
    refuse(options.time && options.frames, "--time", "contradicts --frames, which sets the times",
           "leave one of them out");
    refuse(is_sequence(options) && options.reference, "--reference",
           "applies to one picture, not to a sequence", "leave one of them out");
    refuse(is_sequence(options) && !options.output, options.turntable ? "--turntable" : "--frames",
           "there is no --output", "add one");
}

int picture_count(const ViewOptions& options) {
    return options.turntable.value_or(options.frames.value_or(1));
}

std::filesystem::path numbered_file(const std::filesystem::path& output, int index) {
    std::string name = output.filename().string();
    const std::size_t first = name.find('#');
    if (first == std::string::npos) {
        return output.parent_path() / fmt::format("{}-{:0{}}{}", output.stem().string(), index,
                                                  default_digits, output.extension().string());
    }
    const std::size_t end = std::min(name.find_first_not_of('#', first), name.size());
    name.replace(first, end - first, fmt::format("{:0{}}", index, end - first));
    return output.parent_path() / name;
}

namespace {

constexpr double default_frames_per_second = 25.0;

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

/// Rotates the model about the vertical axis through its center. Lights, their markers and the
/// environment do not rotate.
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
        const double rate = options.frames_per_second.value_or(default_frames_per_second);
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
            if (i > 0) {  // The scene is composed for the first picture.
                pose_for(composed, options, i);
                renderer.move(composed.scene());
            }
            const bool uses_scene_camera = composed.camera_follows_scene && composed.scene().camera;
            frame = renderer.draw(uses_scene_camera ? *composed.scene().camera : composed.camera);
        });
        times.draw.push_back(frame.times.draw);
        times.read_back.push_back(frame.times.read_back);
        stages.run("write", [&] { take(frame); });
    }
    return frame;
}

namespace {

/// glTF requires flat normals if there are none, and then ignores stored tangents.
void frame(GltfDocument& document, Report& report) {
    for (const GltfPrimitiveId id : document.triangle_primitives()) {
        const GltfTangentTexcoords texcoords = document.tangent_texcoords(id);
        Mesh mesh = document.mesh(id, texcoords.set);
        FrameOptions options;
        options.if_missing = NormalMode::flat;
        const bool has_normals = !mesh.normals.empty();
        const bool has_tangents = has_normals && !mesh.tangents.empty();
        if (!has_tangents) options.tangents = TangentMode::none;
        if (!has_tangents && !mesh.texcoords.empty() && texcoords.texture == "normalTexture")
            options.tangents = TangentMode::mikktspace;
        if (has_normals && !computes_tangents(options.tangents)) continue;
        const FramedMesh framed = with_frames(std::move(mesh), options, report);
        document.set_frames(id, framed, options, report);
    }
}

void frame(MeshFile& contents, Report& report) {
    const bool has_map =
        std::any_of(contents.materials.begin(), contents.materials.end(),
                    [](const MtlMaterial& material) { return material.normal_map.has_value(); });
    FrameOptions options;
    if (has_map && !contents.mesh.texcoords.empty()) options.tangents = TangentMode::mikktspace;
    contents.mesh = with_frames(std::move(contents.mesh), options, report).mesh;
}

}  // namespace

void add_save_options(CLI::App& app, ViewOptions& options) {
    const std::string group = "Output";
    add_path(app, "--save-scene", options.save_scene,
             "Write a scene file (.json) that draws this picture. It refers to the model and "
             "contains the materials, lights, environment and camera that the options change.")
        .group(group);
    add_path(app, "--save-model", options.save_model,
             "Write the model as .glb or .gltf with the normals and tangents that it is drawn "
             "with. The materials stay as they are in the model file.")
        .group(group);
}

void check_save_options(const ViewOptions& options) {
    const auto check = [&](const std::optional<std::filesystem::path>& file,
                           const std::string& option, bool has_format, const char* formats) {
        if (!file) return;
        refuse(!has_format, option + " " + file->string(), "unsupported format", formats);
        refuse(*file == options.model || file == options.output, option,
               "would overwrite the model or the picture", "");
        require_folder_of(*file);
    };
    const auto extension = [](const auto& file) { return file ? extension_of(*file) : ""; };
    check(options.save_scene, "--save-scene", extension(options.save_scene) == ".json",
          "use .json");
    const std::string model = extension(options.save_model);
    check(options.save_model, "--save-model", model == ".glb" || model == ".gltf",
          "use .glb or .gltf");
}

void save_files(const ViewOptions& options, const ComposedScene& composed, Stages& stages) {
    const auto save = [&](const std::optional<std::filesystem::path>& file, const auto& work) {
        if (!file) return;
        stages.run("save", [&] { about(options.model, work); });
        if (!options.general.quiet && !options.json) print_entry("saved", file_and_size(*file));
    };
    save(options.save_scene, [&] {
        save_scene(*options.save_scene,
                   {options.model, composed.scene(), composed.camera, options.size});
    });
    save(options.save_model, [&] { save_model(*options.save_model, options.model); });
}

void save_model(const std::filesystem::path& file, const std::filesystem::path& model) {
    if (extension_of(model) == ".json")
        throw InvalidInput("is a scene file and cannot be saved as a model");
    Report unused;  // These findings have already been reported.
    Model contents = read_model(model, unused);
    std::visit([&](auto& read) { frame(read, unused); }, contents);
    write_model(file, contents, model, true, unused);
}

}  // namespace relief::tools
