// SPDX-License-Identifier: Apache-2.0
// The command `relief-view MODEL`: composes the scene, draws it, writes the output and prints a
// summary. Without pictures it needs no OpenGL. Tests: tests/tools/relief_view_test.cpp.
#include "view_command.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <memory>
#include <variant>

#include "command_line.h"
#include "common/command.h"
#include "common/file_jobs.h"
#include "common/summary.h"
#include "effect_options.h"
#include "exercise.h"
#include "mistake_pictures.h"
#include "page_command.h"
#include "picture_comparison.h"
#include "picture_sequence.h"
#include "picture_sink.h"
#include "pixel_probe.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/image.h"
#include "relief/mesh/report.h"
#include "relief/mesh/statistics.h"
#include "relief/shade/renderer.h"
#include "saved_files.h"
#include "scene_options.h"
#include "step_pictures.h"
#include "view_options.h"
#include "window/shortcuts.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

/// The last picture with its measurements.
struct Drawn {
    Frame frame;  ///< The last frame.
    SequenceTimes times;
    std::string backend;
    std::string renderer;
    std::optional<ReferenceComparison> comparison;
    std::optional<PictureComparison> sides;  ///< The result of --compare.
    std::optional<ExerciseResult> exercise;  ///< The result of --exercise.
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
        if (drawn->exercise) add_exercise(summary, *options.exercise, *drawn->exercise);
    }
    if (options.debug.health_markers) add_legend(summary, markers);
    if (drawn != nullptr) add_measures(summary, drawn->measures, options, drawn->frame);
    return summary;
}

void add_page(Summary& summary, const ViewOptions& options, const WrittenPage& page) {
    summary.add("page",
                fmt::format("{}, {}, {}", counted(page.pictures, "picture"),
                            counted(page.programs, "program"), counted(page.textures, "texture")),
                {{"page",
                  {{"output", options.output->string()},
                   {"bytes", page.bytes},
                   {"pictures", page.pictures},
                   {"steps", page.steps},
                   {"probes", page.probes},
                   {"programs", page.programs},
                   {"textures", page.textures},
                   {"quantization", Json(page.quantization)}}}});
    std::string errors;
    for (const auto& [attribute, error] : page.quantization)
        errors += fmt::format("{}{} {:.2g}", errors.empty() ? "" : ", ", attribute, error);
    if (!errors.empty()) summary.add("quantized", "errors at most: " + errors);
    summary.add("wrote", file_and_size(*options.output));
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
            .overlays = overlays_of(options.debug, markers, grid),
            .shaders = options.exercise ? attempt_at(*options.exercise).texts : nullptr};
}

/// Returns the camera of all pictures; none if they have several, or readers of a page move it.
std::optional<Camera> only_camera(const ViewOptions& options, const ComposedScene& composed) {
    if (is_page(options) || options.turntable || options.frames) return std::nullopt;
    const bool follows = composed.camera_follows_scene && composed.scene().camera;
    return follows ? *composed.scene().camera : composed.camera;
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
        if (options.exercise) {
            drawn.exercise =
                compare_with_solution(*options.exercise, settings, plan, composed.scene(),
                                      composed.camera, *context, picture);
            write_difference_map(options, *drawn.exercise);
            report_result(*drawn.exercise, report);
        }
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
    FrameSettings settings = settings_of(options, markers, composed.scene());
    settings.camera = only_camera(options, composed);
    FramePlan plan = viewed_plan(options, composed.scene(), settings,
                                 chosen_plan(options, composed.scene(), settings), report);
    save_files(options, composed, stages);
    std::optional<ProbedPixel> probed;
    if (options.probe) probed = probed_pixel(options, composed, settings, stages, report);
    std::optional<Drawn> drawn;
    std::vector<DrawnStep> steps;
    std::vector<DrawnMistake> mistakes;
    std::optional<WrittenPage> page;
    if (is_page(options)) {
        page = write_page(options, settings, composed, stages, report);
    } else if (options.steps) {
        steps = draw_steps(options, settings, composed, stages, report);
    } else if (!options.mistakes.empty()) {
        mistakes = draw_mistakes(options, settings, composed, stages, report);
    } else if (options.output || options.reference || options.effects.measures()) {
        drawn = draw(options, settings, composed, plan, stages, report);
    }
    if (probed && !options.json) probe_summary(*probed, composed.scene()).print();
    if (options.explain_effects && !options.json) effect_summary(composed.scene(), plan).print();
    if (options.effects.print_shaders && !options.json) print_shaders(composed.scene(), plan);

    Findings findings;
    findings.add("", without_assumed(report, options.assumed));
    Summary summary =
        summary_of(options, composed, plan, drawn ? &*drawn : nullptr, markers, findings, stages);
    if (!steps.empty()) add_steps(summary, options, steps);
    if (!mistakes.empty()) add_mistakes(summary, options, mistakes);
    if (page) add_page(summary, options, *page);
    if (options.json) {
        if (options.explain_effects)
            summary.add_part("effects", effect_summary(composed.scene(), plan));
        if (probed) summary.add_part("", probe_summary(*probed, composed.scene()));
        if (options.effects.print_shaders) summary.add_json({{"shaders", shaders_json(plan)}});
        print_json(summary.json());
    } else if ((drawn || page || !steps.empty() || !mistakes.empty()) && !options.general.quiet) {
        if (probed || options.explain_effects || options.effects.print_shaders) print_text("\n");
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
         "relief-view data/scenes/environment-mapping.json --steps --output out/steps.png --size "
         "240x160",
         "relief-view data/scenes/mistakes.json --mistake green --output out/green-down.png",
         "relief-view data/vase.obj --material gold --output out/vase.html",
         "relief-view data/vase.obj --material gold --light point:2,2,2,4 --save-scene "
         "out/golden.json",
         "relief-view data/vase.obj --size 640x480 --probe 320,240",
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
