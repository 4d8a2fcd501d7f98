// SPDX-License-Identifier: Apache-2.0
// The command `relief-view MODEL`: composes the scene, draws it, writes the output and prints a
// summary. Without pictures it needs no OpenGL. Tests: tests/tools/relief_view_test.cpp.
#include "view_command.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <glm/gtc/matrix_transform.hpp>
#include <memory>
#include <numbers>
#include <variant>

#include "common/command.h"
#include "common/file_jobs.h"
#include "common/material_maps.h"
#include "common/model_file.h"
#include "common/summary.h"
#include "effect_options.h"
#include "file_replacement.h"
#include "picture_comparison.h"
#include "portable_math.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/image.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/map_description.h"
#include "relief/mesh/report.h"
#include "relief/mesh/statistics.h"
#include "relief/shade/renderer.h"
#include "relief/shade/scene_file.h"
#include "scene_options.h"
#include "view_options.h"
#include "window/viewer_state.h"

namespace relief::tools {

// Output files.

namespace {

constexpr int max_frames = 100000;
constexpr std::size_t default_digits = 4;

bool is_sequence(const ViewOptions& options) {
    return options.turntable || options.frames;
}

bool is_video(const std::filesystem::path& output) {
    return extension_of(output) == ".mp4" || extension_of(output) == ".webm";
}

bool is_animation(const std::filesystem::path& output) {
    return is_video(output) || extension_of(output) == ".apng";
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

void check_sequence(const ViewOptions& options) {
    const bool has_video = options.output && is_video(*options.output);
    const bool animated = options.output && is_animation(*options.output);
    refuse(options.turntable && options.frames, "--turntable", "contradicts --frames",
           "leave one of them out");
    refuse(options.seconds && !options.frames, "--seconds", "needs --frames",
           "add --frames, or leave it out");
    refuse(options.frames_per_second && !animated, "--fps", "applies to animations and videos",
           "write an .apng, .mp4 or .webm, or leave it out");
    refuse(has_video && options.background && options.background->a < 1.0F, "--background",
           "a video has no transparent pixels", "choose a color, or write an .apng");
    refuse(has_video && options.size_given && (options.size.x % 2 != 0 || options.size.y % 2 != 0),
           "--size", "the width and the height of a video must be even", "");
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

/// Multiplies the color by alpha, because a video has no transparent pixels.
void append_opaque(std::vector<std::byte>& rgb, const std::uint8_t* texel, int channels) {
    constexpr std::uint8_t opaque = 255;
    const std::uint8_t alpha = channels == 4 ? texel[3] : opaque;
    for (int i = 0; i < 3; ++i) {
        const std::uint8_t code = texel[i];
        if (alpha == opaque) {
            rgb.push_back(static_cast<std::byte>(code));
            continue;
        }
        const float linear = linear_from_srgb(static_cast<float>(code) / 255.0F);
        const float coded = srgb_from_linear(linear * static_cast<float>(alpha) / 255.0F);
        rgb.push_back(static_cast<std::byte>(std::lround(coded * 255.0F)));
    }
}

/// Sends the pictures to the program ffmpeg, which compresses them: H.264 for .mp4, VP9 for .webm.
/// The video replaces an existing file when it is complete.
class VideoSink : public PictureSink {
  public:
    VideoSink(const std::filesystem::path& file, double frames_per_second)
        : file_(file), rate_(frames_per_second) {}
    VideoSink(const VideoSink&) = delete;
    VideoSink& operator=(const VideoSink&) = delete;
    ~VideoSink() override {
        if (process_ <= 0) return;
        ::close(socket_);
        ::kill(process_, SIGKILL);
        ::waitpid(process_, nullptr, 0);
    }

    void take(const Image& picture) override {
        if (process_ <= 0) start(picture.width, picture.height);
        rgb_.clear();
        const std::span<const std::uint8_t> samples = picture.as<std::uint8_t>();
        const auto channels = static_cast<std::size_t>(picture.channels);
        for (std::size_t i = 0; i + channels <= samples.size(); i += channels)
            append_opaque(rgb_, &samples[i], picture.channels);
        std::size_t sent = 0;
        while (sent < rgb_.size()) {
            const ssize_t count =
                ::send(socket_, rgb_.data() + sent, rgb_.size() - sent, MSG_NOSIGNAL);
            if (count < 0 && errno == EINTR) continue;
            if (count <= 0) fail("ffmpeg ended early");
            sent += static_cast<std::size_t>(count);
        }
    }

    void finish() override {
        ::shutdown(socket_, SHUT_WR);
        int status = 0;
        while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
        }
        ::close(socket_);
        process_ = 0;
        if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) fail("ffmpeg failed");
        file_.commit();
    }

  private:
    [[noreturn]] void fail(const std::string& problem) const {
        throw FileError(file_.file(), problem);
    }

    void start(int width, int height) {
        std::vector<std::string> words = {
            "ffmpeg", "-loglevel", "error", "-y",
            // The input: raw pictures from the socket.
            "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", fmt::format("{}x{}", width, height), "-r",
            fmt::format("{}", rate_), "-i", "pipe:0",
            // The colors of HD video.
            "-vf", "scale=out_color_matrix=bt709:out_range=tv", "-pix_fmt", "yuv420p",
            "-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709"};
        const std::vector<std::string> mp4 = {"-c:v", "libx264", "-crf",      "16",
                                              "-f",   "mp4",     "-movflags", "+faststart"};
        const std::vector<std::string> webm = {"-c:v", "libvpx-vp9", "-crf", "20", "-b:v",
                                               "0",    "-row-mt",    "1",    "-f", "webm"};
        const std::vector<std::string>& format = extension_of(file_.file()) == ".mp4" ? mp4 : webm;
        words.insert(words.end(), format.begin(), format.end());
        words.push_back("file:" + file_.temporary().string());
        std::vector<char*> arguments;
        for (std::string& word : words)
            arguments.push_back(word.data());
        arguments.push_back(nullptr);

        std::array<int, 2> ends{};
        if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
            fail("cannot start ffmpeg");
        posix_spawn_file_actions_t actions;
        ::posix_spawn_file_actions_init(&actions);
        ::posix_spawn_file_actions_adddup2(&actions, ends[1], STDIN_FILENO);
        const int error =
            ::posix_spawnp(&process_, "ffmpeg", &actions, nullptr, arguments.data(), environ);
        ::posix_spawn_file_actions_destroy(&actions);
        ::close(ends[1]);
        socket_ = ends[0];
        if (error == 0) return;
        ::close(socket_);
        process_ = 0;
        fail("needs the program ffmpeg, which is not installed");
    }

    FileReplacement file_;
    double rate_;
    pid_t process_ = 0;
    int socket_ = -1;
    std::vector<std::byte> rgb_;
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
    const auto rounded = static_cast<double>(static_cast<float>(angle));
    const auto sine = static_cast<float>(portable::sin(rounded));
    const auto cosine = static_cast<float>(portable::cos(rounded));
    glm::mat4 rotation(1.0F);
    rotation[0] = {cosine, 0.0F, -sine, 0.0F};
    rotation[2] = {sine, 0.0F, cosine, 0.0F};
    turned = glm::translate(turned * rotation, -middle);
    for (std::size_t i = 0; i < composed.at_rest.size(); ++i)
        composed.scene().instances[i].world_from_object = turned * composed.at_rest[i];
}

}  // namespace

std::unique_ptr<PictureSink> make_sink(const ViewOptions& options) {
    const std::filesystem::path& output = *options.output;
    const int count = picture_count(options);
    const double rate = options.frames_per_second.value_or(default_frames_per_second);
    if (is_video(output)) return std::make_unique<VideoSink>(output, rate);
    if (extension_of(output) == ".apng") {
        return std::make_unique<AnimationSink>(output, count, 1.0 / rate);
    }
    if (options.turntable || options.frames) return std::make_unique<NumberedFiles>(output);
    return std::make_unique<OneFile>(output);
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

namespace {

/// glTF requires flat normals if there are none, and then ignores stored tangents.
void frame(GltfDocument& document, const FrameOptions& read, Report& report) {
    for (const GltfPrimitiveId id : document.triangle_primitives()) {
        const GltfTangentTexcoords texcoords = document.tangent_texcoords(id);
        Mesh mesh = document.mesh(id, texcoords.set);
        FrameOptions options = read;
        options.if_missing = read.crease_angle ? NormalMode(NormalWeight::angle) : NormalMode::flat;
        const bool has_normals = !mesh.normals.empty();
        const bool has_tangents = has_normals && !mesh.tangents.empty();
        if (!has_tangents) options.tangents = TangentMethod::none;
        if (!has_tangents && !mesh.texcoords.empty() && !texcoords.texture.empty())
            options.tangents = TangentMethod::mikktspace;
        const bool keeps_normals = has_normals && options.normals == NormalMode::keep;
        if (keeps_normals && !computes_tangents(options.tangents)) continue;
        const FramedMesh framed = with_frames(std::move(mesh), options, report);
        document.set_frames(id, framed, options, report);
    }
}

void frame(MeshFile& contents, FrameOptions options, Report& report) {
    const bool has_map =
        std::any_of(contents.materials.begin(), contents.materials.end(),
                    [](const MtlMaterial& material) { return material.normal_map.has_value(); });
    if (has_map && !contents.mesh.texcoords.empty()) options.tangents = TangentMethod::mikktspace;
    contents.mesh = with_frames(std::move(contents.mesh), options, report).mesh;
}

/// Turns z up: glTF's y points up.
void turn_y_up(Model& model) {
    auto* contents = std::get_if<MeshFile>(&model);
    if (contents == nullptr)
        throw InvalidInput("is drawn with z up, which a copy of a glTF file cannot hold");
    const auto turn = [](auto& v) {
        const auto y = v.y;
        v.y = v.z;
        v.z = -y;
    };
    turn(contents->origin);
    for (glm::vec3& position : contents->mesh.positions)
        turn(position);
    for (glm::vec3& normal : contents->mesh.normals)
        turn(normal);
    for (glm::vec4& tangent : contents->mesh.tangents)
        turn(tangent);
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
             "with. --normal-map and --diffuse-map are stored in all of its materials, which "
             "otherwise stay as they are in the model file.")
        .group(group);
}

namespace {

/// The maps of --save-model must be what glTF prescribes.
void check_saved_maps(const ViewOptions& options) {
    const std::string option = "--save-model";
    refuse(options.height_map.has_value(), option, "glTF has no height maps",
           "convert it with relief-bake bump, or leave --height-map out");
    for (const auto& file : {options.normal_map, options.diffuse_map}) {
        if (file) check_image(option, *file);
    }
    if (!options.normal_map) return;
    refuse(options.normal_space && *options.normal_space != NormalSpace::tangent, option,
           "normals of glTF are in tangent space", "convert the map with relief-bake convert");
    const MapDescription stated = read_description(read_image_info(*options.normal_map).metadata);
    refuse(options.green.value_or(stated.green.value_or(Green::up)) == Green::down, option,
           "glTF has green up", "convert the map with relief-bake convert --flip green");
}

/// Stores the maps of the command line in the saved model.
void save_maps(const ViewOptions& options) {
    MaterialRequest request;
    request.input = request.output = *options.save_model;
    request.all_materials = true;
    request.normal_scale = options.normal_scale;
    // The kinds were checked for the scene. A direction of green that is given is up.
    request.assumed = options.assumed;
    if (options.green) request.assumed.push_back(MapKind::normal);
    std::vector<MaterialMap> maps;
    if (options.normal_map) maps.push_back({GltfTextureSlot::normal, *options.normal_map});
    if (options.diffuse_map) maps.push_back({GltfTextureSlot::base_color, *options.diffuse_map});
    if (maps.empty()) return;
    request.materials.push_back({std::nullopt, std::move(maps)});
    Stages unused(true);
    store_maps(request, unused);
}

}  // namespace

void check_save_options(const ViewOptions& options) {
    const auto check = [&](const std::optional<std::filesystem::path>& file,
                           const std::string& option, bool has_format, const char* formats) {
        if (!file) return;
        refuse(!has_format, option + " " + file->string(), "unsupported format", formats);
        require_folder_of(*file);
    };
    const auto extension = [](const auto& file) { return file ? extension_of(*file) : ""; };
    check(options.save_scene, "--save-scene", extension(options.save_scene) == ".json",
          "use .json");
    const std::string model = extension(options.save_model);
    check(options.save_model, "--save-model", model == ".glb" || model == ".gltf",
          "use .glb or .gltf");
    if (options.save_model) check_saved_maps(options);
}

void save_files(const ViewOptions& options, const ComposedScene& composed, Stages& stages) {
    const auto save = [&](const std::optional<std::filesystem::path>& file, const auto& work) {
        if (!file) return;
        stages.run("save", [&] { about(options.model, work); });
        if (!options.general.quiet && !options.json) print_entry("saved", file_and_size(*file));
    };
    save(options.save_scene, [&] {
        save_scene(*options.save_scene, {options.model, composed.scene(), composed.camera,
                                         options.size, scene_options(options)});
    });
    save(options.save_model, [&] {
        save_model(*options.save_model, options.model, scene_options(options));
        save_maps(options);
    });
}

void save_model(const std::filesystem::path& file, const std::filesystem::path& model,
                const SceneOptions& options) {
    if (extension_of(model) == ".json")
        throw InvalidInput("is a scene file and cannot be saved as a model");
    Report unused;  // These findings have already been reported.
    Model contents = read_model(model, unused);
    std::visit([&](auto& read) { frame(read, frame_options(model, options), unused); }, contents);
    if (is_z_up(model, options)) turn_y_up(contents);
    write_model(file, contents, model, true, unused);
}

// The command.

namespace {

/// The last picture with its measurements.
struct Drawn {
    Frame frame;  ///< The last frame.
    SequenceTimes times;
    std::string backend;
    std::string renderer;
    std::optional<ReferenceComparison> comparison;
    std::optional<PictureComparison> sides;  ///< The result of --compare.
    FrameMeasures measures;
};

/// Describes the lights that are on, and the ambient light if a surface shows it.
std::string lights_text(const Scene& scene, const FramePlan& plan) {
    std::string text;
    const auto add = [&](const auto& lights, const std::string& kind) {
        const auto count = static_cast<std::size_t>(
            std::count_if(lights.begin(), lights.end(), [](const auto& light) {
                if constexpr (std::is_same_v<std::decay_t<decltype(light)>, SpotLight>)
                    return light.point.on;
                else
                    return light.on;
            }));
        if (count != 0) text += (text.empty() ? "" : ", ") + counted(count, kind + " light");
    };
    add(scene.directional_lights, "directional");
    add(scene.point_lights, "point");
    add(scene.spot_lights, "spot");
    if (text.empty()) text = "no light";
    const bool shows_ambient =
        std::any_of(plan.draws.begin(), plan.draws.end(),
                    [](const DrawPlan& draw) { return draw.features.ambient; });
    if (shows_ambient) text += " and ambient light";
    return text;
}

/// For example "24, each 12.3 ms to draw and 0.9 ms to read back (median)".
std::string frames_text(const SequenceTimes& times) {
    return fmt::format("{}, each {:.3g} ms to draw and {:.3g} ms to read back (median)",
                       times.draw.size(), time_statistics(times.draw).median,
                       time_statistics(times.read_back).median);
}

/// For example "out/spin-0001.png to out/spin-0024.png", or one file with its size.
std::string written(const ViewOptions& options) {
    const std::filesystem::path& output = *options.output;
    if (!is_sequence(options) || is_animation(output)) return file_and_size(output);
    return fmt::format("{} to {}", numbered_file(output, 1).string(),
                       numbered_file(output, picture_count(options)).string());
}

Json picture_json(const ViewOptions& options, const Drawn& drawn) {
    const FrameTimes& times = drawn.frame.times;
    return {{"output", options.output ? Json(options.output->string()) : Json()},
            {"width", options.size.x},
            {"height", options.size.y},
            {"samples", options.samples},
            {"backend", drawn.backend},
            {"renderer", drawn.renderer},
            {"programs", drawn.frame.programs},
            {"textures", drawn.frame.textures},
            {"frame_milliseconds",
             {{"decode_images", times.decode_images},
              {"prepare", times.prepare},
              {"link", times.link},
              {"draw", times.draw},
              {"read_back", times.read_back}}},
            {"frames",
             {{"count", drawn.times.draw.size()},
              {"median_draw_milliseconds", time_statistics(drawn.times.draw).median},
              {"median_read_back_milliseconds", time_statistics(drawn.times.read_back).median}}}};
}

void add_picture(Summary& summary, const ViewOptions& options, const Drawn& drawn) {
    summary.add(
        "drew",
        fmt::format("{} x {}, {}, {}, {}, by {}: {}", options.size.x, options.size.y,
                    counted(static_cast<std::size_t>(options.samples), "sample"),
                    counted(drawn.frame.programs, "program"),
                    counted(drawn.frame.textures, "texture"), drawn.backend, drawn.renderer),
        {{"picture", picture_json(options, drawn)}});
}

/// \param drawn  null if no picture was drawn; then only the JSON is of use
Summary summary_of(const ViewOptions& options, const ComposedScene& composed, const FramePlan& plan,
                   const Drawn* drawn, const HealthMarkers& markers, const Findings& findings,
                   const Stages& stages) {
    const Scene& scene = composed.scene();
    const std::size_t triangles = triangle_count(scene);
    Summary summary;
    summary.add_tool("relief-view");
    summary.add("read",
                fmt::format("{}: {}, {}", options.model.string(),
                            counted(scene.instances.size(), "mesh", "meshes"),
                            counted(triangles, "triangle")),
                {{"model", options.model.string()},
                 {"instances", scene.instances.size()},
                 {"triangles", triangles}});
    summary.add("light", lights_text(scene, plan));
    summary.add("notes", composed.notes, {{"notes", composed.notes}});
    summary.add_findings(findings);
    if (drawn != nullptr) add_picture(summary, options, *drawn);
    summary.add_times(stages);
    if (drawn != nullptr) {
        if (drawn->times.draw.size() > 1) summary.add("frames", frames_text(drawn->times));
        if (options.output) summary.add("wrote", written(options));
        if (drawn->comparison) add_comparison(summary, options, *drawn->comparison);
        if (drawn->sides) add_sides(summary, options.compare, *drawn->sides);
    }
    if (options.debug.health_markers) add_legend(summary, markers);
    if (drawn != nullptr) add_measures(summary, drawn->measures, options, drawn->frame);
    return summary;
}

OutputCoding coding_of(const ViewOptions& options) {
    return is_linear_output(options) ? OutputCoding::linear : OutputCoding::srgb;
}

FrameSettings settings_of(const ViewOptions& options, const HealthMarkers& markers,
                          const Scene& scene) {
    const Grid grid = options.debug.grid ? grid_below(world_bounds(scene)) : Grid();
    return {.width = options.size.x,
            .height = options.size.y,
            .samples = options.samples,
            .output = coding_of(options),
            .view = options.debug.view,
            .overlays = overlays_of(options.debug, markers, grid)};
}

/// Keeps alpha only if it was requested, because viewers show different colors behind it.
Image picture_of(const Frame& frame, const Scene& scene) {
    Image picture = frame.image;
    if (scene.background.a == 1.0F) drop_alpha(picture);
    return picture;
}

/// Draws the other side of a comparison.
Image draw_other(const ViewOptions& options, const Context& context, const ComposedScene& composed,
                 Stages& stages) {
    Report unused;  // Most of these findings belong to both sides.
    const OtherSide other = other_side(options, composed, stages, unused);
    const FrameSettings settings =
        settings_of(options, chosen_markers(options.debug, other.scene), other.scene);
    const FramePlan plan = viewed_plan(options, other.scene, settings,
                                       chosen_plan(options, other.scene, settings), unused);
    return stages.run("draw other side", [&] {
        Renderer renderer(context, other.scene, plan, settings, unused);
        return picture_of(renderer.draw(other.camera), composed.scene());
    });
}

/// Draws, writes and compares the pictures.
///
/// \param plan  becomes the plan that was drawn: within the budget and without unreadable textures
Drawn draw(const ViewOptions& options, const FrameSettings& settings, ComposedScene& composed,
           FramePlan& plan, Stages& stages, Report& report) {
    const Image reference = options.reference ? read_reference(options) : Image{};
    const std::unique_ptr<Context> context =
        stages.run("context", [&] { return std::make_unique<Context>(options.backend); });
    FrameMeasures measures = measure_frame(
        options, {*context, composed.scene(), settings, composed.camera}, plan, stages);
    RenderCache cache(*context);
    bool is_first = true;
    const auto prepare = [&] {
        Report same;
        if (!is_first) {  // Materials have moved.
            plan = viewed_plan(options, composed.scene(), settings,
                               chosen_plan(options, composed.scene(), settings), same);
        }
        auto renderer = std::make_unique<Renderer>(cache, *context, composed.scene(), plan,
                                                   settings, is_first ? report : same);
        if (std::exchange(is_first, false)) plan = renderer->plan();
        return renderer;
    };
    const std::unique_ptr<PictureSink> sink = options.output ? make_sink(options) : nullptr;
    Drawn drawn;
    drawn.measures = std::move(measures);
    drawn.backend = context->backend_name();
    drawn.renderer = context->renderer_name();
    const bool has_sides = options.compare.compares();
    const Image other = has_sides ? draw_other(options, *context, composed, stages) : Image{};
    const auto take = [&](const Frame& frame) {
        Image picture = picture_of(frame, composed.scene());
        if (has_sides) {
            drawn.sides = compare_pictures(picture, other);
            write_difference_map(options, *drawn.sides);
            const float split = options.compare.split.value_or(default_split);
            picture = split_picture(picture, other, split);
        }
        if (sink) sink->take(picture);
        if (options.reference)
            drawn.comparison = compare_with_reference(options, picture, reference);
    };
    drawn.frame = draw_sequence(prepare, composed, options, stages, take, drawn.times);
    if (sink) stages.run("write", [&] { sink->finish(); });
    return drawn;
}

/// Composes the scene, and checks that no picture or file will replace a file that it reads.
ComposedScene compose_and_check(ViewOptions& options, Stages& stages, Report& report) {
    Progress opened;
    const ProgressScope scope(opened);
    ComposedScene composed = compose_scene(options, stages, report);
    std::vector<std::filesystem::path> files = names_of(opened.files());
    for (const ImageSource& image : composed.scene().images) {  // Their files are opened later.
        if (const auto* file = std::get_if<std::filesystem::path>(&image.source))
            files.push_back(*file);
    }
    check_written_files(options, std::move(files));
    return composed;
}

ExitCode run(const CLI::App& app, ViewOptions& options) {
    settle(options);
    if (options.list_bindings) {
        print_text(shortcuts_text());
        return ExitCode::done;
    }
    set_thread_limit(options.general.threads);
    if (options.wants_window()) return run_window(options);
    Stages stages(options.general.quiet);
    Report report;
    ComposedScene composed = compose_and_check(options, stages, report);
    HealthMarkers markers;
    if (options.debug.health_markers)
        markers =
            stages.run("check", [&] { return chosen_markers(options.debug, composed.scene()); });
    const FrameSettings settings = settings_of(options, markers, composed.scene());
    FramePlan plan = viewed_plan(options, composed.scene(), settings,
                                 chosen_plan(options, composed.scene(), settings), report);
    save_files(options, composed, stages);
    std::optional<Drawn> drawn;
    if (options.output || options.reference || options.effects.measures()) {
        drawn = draw(options, settings, composed, plan, stages, report);
    }
    if (options.explain_effects && !options.json) effect_summary(composed.scene(), plan).print();
    if (options.effects.print_shaders && !options.json) print_shaders(composed.scene(), plan);

    Findings findings;
    findings.add("", report);
    Summary summary =
        summary_of(options, composed, plan, drawn ? &*drawn : nullptr, markers, findings, stages);
    if (options.json) {
        if (options.explain_effects)
            summary.add_part("effects", effect_summary(composed.scene(), plan));
        if (options.effects.print_shaders) summary.add_json({{"shaders", shaders_json(plan)}});
        print_json(summary.json());
    } else if (drawn && !options.general.quiet) {
        if (options.explain_effects || options.effects.print_shaders) print_text("\n");
        summary.print();
    }
    if (drawn && drawn->comparison) require_match(options, *drawn->comparison);
    ReportOptions strictness;
    strictness.strict = options.strict;
    return found_fault(app, strictness, options.model, findings) ? ExitCode::fell_back
                                                                 : ExitCode::done;
}

}  // namespace

Command add_view_command(CLI::App& tool) {
    const auto options = std::make_shared<ViewOptions>();
    add_view_options(tool, *options);
    set_common_options(
        tool, {"--output", "--size", "--explain-effects", "--diffuse-map", "--normal-map",
               "--height-map", "--strength", "--material", "--environment", "--light", "--camera",
               "--turntable", "--compare", "--show"});
    set_examples(
        tool,
        {"relief-view --list-bindings", "relief-view data/vase.obj --output out/vase.png",
         "relief-view data/vase.obj --height-map data/bricks-height.png --strength 12 --output "
         "out/bricks.png",
         "relief-view data/vase.obj --environment data/sky --reflectivity 0.4 --output "
         "out/mirror.png --size 640x480",
         "relief-view data/vase.obj --light directional:-60,20 --light "
         "point:2,2,2,4,#ff8040 --camera 0,10,1.5 --output out/lit.exr",
         "relief-view data/vase.obj --material gold --turntable 24 --size 256x256 --output "
         "out/spin.apng",
         "relief-view data/vase.obj --show shading-normal --wireframe --output out/normals.png",
         "relief-view data/vase.obj --height-map data/bricks-height.png --compare kernel=central3 "
         "--output out/sides.png",
         "relief-view data/vase.obj --material gold --light point:2,2,2,4 --save-scene "
         "out/golden.json",
         "relief-view data/vase.obj --diffuse-map data/bricks-diffuse.png --explain-effects"});
    return {&tool, [&tool, options] { return run(tool, *options); }};
}

Tool relief_view() {
    return {"relief-view",
            "Show a model with normal, height, diffuse and environment maps in a window, or draw "
            "it to a file.",
            {add_view_command}};
}

}  // namespace relief::tools
