// SPDX-License-Identifier: Apache-2.0
// The frame times of three programs, interleaved, for six typical scenes: relief's planned program,
// a hand-written one for the scene, and one with all effects in branches on uniforms.
// A sphere of 99,856 triangles, 1280 x 720, one sample per pixel; wall-clock milliseconds.
//
//   relief-frame-bench [REPEATS]
//   relief-frame-bench REPEATS MODEL...
//
// The second form compares two ways of drawing an animated model: deformed in the vertex stage, and
// deformed on the CPU and uploaded in each frame; from the pose to the finished picture.
//
// The hand-written and the branching shaders replace shaders/surface.* through $RELIEF_SHADER_DIR,
// so that all three programs draw the same meshes with the same state.
#include <fmt/format.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "gl/api.h"
#include "relief/mesh/statistics.h"
#include "relief/shade/effects.h"
#include "relief/shade/image_compare.h"
#include "relief/shade/renderer.h"
#include "relief/shade/scene.h"
#include "relief/shade/scene_file.h"
#include "relief/shade/scene_graph.h"
#include "shade/typical_scenes.h"

namespace relief::bench {
using namespace relief::shade;

namespace {

const FrameSettings settings{1280, 720, 1, OutputCoding::srgb};

/// Uses the shaders of a folder below bench/shade; empty: the embedded ones.
void use_shaders(const std::string& folder) {
    if (folder.empty()) {
        unsetenv("RELIEF_SHADER_DIR");
    } else {
        const std::string path = RELIEF_BENCH_DIRECTORY "/shade/" + folder;
        setenv("RELIEF_SHADER_DIR", path.c_str(), 1);
    }
}

/// Sets switches of the current program, which is the only one in these scenes.
void switch_on(const Context& context, const std::vector<const char*>& uses) {
    const gl::Api& api = context.api();
    GLint program = 0;
    api->GetIntegerv(GL_CURRENT_PROGRAM, &program);
    for (const char* use : uses) {
        const std::string name = fmt::format("use_{}", use);
        const GLint place = api->GetUniformLocation(static_cast<GLuint>(program), name.c_str());
        api->Uniform1i(place, 1);
    }
}

/// The three programs of one scene.
struct Contenders {
    std::array<std::unique_ptr<Renderer>, 3> renderers;
    std::array<Image, 3> pictures;
};

Contenders contenders(const Context& context, const TypicalScene& typical) {
    Report report;
    const Scene& scene = typical.scene;
    const FramePlan plan = plan_effects(scene, settings);
    const FramePlan everything =
        force_effects(scene, settings, plan, {EffectBase::all_neutral, {}});
    Contenders result;
    const auto make = [&](std::size_t i, const std::string& folder, const FramePlan& frame_plan) {
        use_shaders(folder);
        result.renderers[i] =
            std::make_unique<Renderer>(context, scene, frame_plan, settings, report);
        result.pictures[i] = result.renderers[i]->draw(*scene.camera).image;
    };
    make(0, "", plan);
    make(1, std::string("minimal/") + typical.minimal, plan);
    make(2, "uber", everything);
    switch_on(context, typical.uses);
    result.pictures[2] = result.renderers[2]->draw(*scene.camera).image;
    return result;
}

void measure(const Context& context, const TypicalScene& typical, const Repeats& repeats) {
    const Contenders all = contenders(context, typical);
    const std::array<Renderer*, 3> renderers{all.renderers[0].get(), all.renderers[1].get(),
                                             all.renderers[2].get()};
    const std::vector<FrameSeries> series = time_frames(renderers, *typical.scene.camera, repeats);
    std::array<double, 3> medians{};
    for (std::size_t i = 0; i < medians.size(); ++i)
        medians[i] = time_statistics(series[i].draw).median;
    const auto median_ratio = [&](std::size_t of, std::size_t to) {
        std::vector<double> ratios;
        for (std::size_t i = 0; i < series[of].draw.size(); ++i)
            ratios.push_back(series[of].draw[i] / series[to].draw[i]);
        return time_statistics(ratios).median;
    };
    fmt::print("{:<20} {:8.2f} {:8.2f} {:8.2f}   {:5.3f}   {:5.2f}   {:3.0f} {:3.0f}\n",
               typical.name, medians[0], medians[1], medians[2], median_ratio(0, 1),
               median_ratio(2, 0), compare(all.pictures[0], all.pictures[1]).max,
               compare(all.pictures[0], all.pictures[2]).max);
}

/// Returns the scene with the deformed meshes in place of the poses.
Scene deformed_on_cpu(Scene scene) {
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        if (!scene.instances[i].pose) continue;
        scene.meshes.push_back(deformed_mesh(scene, i));
        scene.instances[i].mesh = scene.meshes.size() - 1;
        scene.instances[i].pose.reset();
    }
    return scene;
}

void measure_poses(const Context& context, const char* model, const Repeats& repeats) {
    SceneGraph graph = load_scene_graph(model, {});
    const double length = duration(graph);
    pose(graph, 0.0);
    graph.camera = {};
    graph.camera_sees_all = false;
    Scene& scene = graph.scene;
    scene.camera = framed(scene, default_azimuth, default_elevation, default_vertical_fov,
                          static_cast<float>(settings.width) / static_cast<float>(settings.height));
    add_default_lights(scene, *scene.camera);
    Renderer on_gpu(context, scene, settings);
    Renderer on_cpu(context, deformed_on_cpu(scene), settings);
    std::array<std::vector<double>, 2> pose_times;
    std::array<std::vector<double>, 2> frame_times;
    std::size_t frame = 0;
    interleave(2, repeats, [&](std::size_t i, bool counted) {
        const Stopwatch stopwatch;
        pose(graph, length * static_cast<double>(frame++ / 2 % 24) / 24.0);
        if (i == 0)
            on_gpu.move(scene);
        else
            on_cpu.move(deformed_on_cpu(scene));
        const double posed = 1e3 * stopwatch.seconds();
        (i == 0 ? on_gpu : on_cpu).draw_only(*scene.camera);
        if (!counted) return;
        pose_times[i].push_back(posed);
        frame_times[i].push_back(1e3 * stopwatch.seconds());
    });
    const auto median = [](const std::vector<double>& times) {
        return time_statistics(times).median;
    };
    std::vector<double> ratios;
    for (std::size_t i = 0; i < frame_times[0].size(); ++i)
        ratios.push_back(frame_times[0][i] / frame_times[1][i]);
    fmt::print("{:<24} {:8.3f} {:8.3f}   {:8.2f} {:8.2f}   {:5.2f}\n",
               std::filesystem::path(model).filename().string(), median(pose_times[0]),
               median(pose_times[1]), median(frame_times[0]), median(frame_times[1]),
               median(ratios));
}

int run_poses(const Repeats& repeats, std::span<char*> models) {
    const Context context(Backend::osmesa);
    fmt::print("{}, median of {} frames in turns, ms: vertex stage, CPU\n", context.renderer_name(),
               repeats.counted);
    fmt::print("{:<24} {:>17}   {:>17}   {}\n", "model", "pose and upload", "whole frame", "ratio");
    for (const char* model : models)
        measure_poses(context, model, repeats);
    return 0;
}

int run(const Repeats& repeats) {
    const Context context(Backend::osmesa);
    fmt::print("{}, median of {} frames in turns, ms of drawing\n", context.renderer_name(),
               repeats.counted);
    fmt::print("{:<20} {:>8} {:>8} {:>8}   {}   {}   {}\n", "scene", "planned", "by hand",
               "branches", "planned/hand", "branches/planned", "largest differences of 255");
    for (const TypicalScene& typical : typical_scenes())
        measure(context, typical, repeats);
    return 0;
}

}  // namespace
}  // namespace relief::bench

int main(int argc, char** argv) {
    relief::Repeats repeats{.counted = 31, .warm_up = 3};
    if (argc > 1) repeats.counted = static_cast<std::size_t>(std::atoi(argv[1]));
    const std::span<char*> models = std::span(argv, static_cast<std::size_t>(argc))
                                        .subspan(argc > 2 ? 2 : static_cast<std::size_t>(argc));
    if (!models.empty()) return relief::bench::run_poses(repeats, models);
    return relief::bench::run(repeats);
}
