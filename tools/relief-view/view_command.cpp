// SPDX-License-Identifier: Apache-2.0
// `relief-view MODEL`: composes the scene, draws it, writes the picture, says what was done. Asked
// only to explain the effects, it plans and needs no OpenGL. Tests:
// tests/tools/relief_view_test.cpp.
#include "view_command.h"

#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "common/command.h"
#include "common/findings.h"
#include "common/text.h"
#include "compare_options.h"
#include "debug_options.h"
#include "effect_options.h"
#include "effects_text.h"
#include "picture_reference.h"
#include "relief/mesh/image_channels.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/threads.h"
#include "relief/shade/renderer.h"
#include "save_files.h"
#include "scene_options.h"
#include "sequence.h"
#include "view_options.h"
#include "view_summary.h"
#include "window/bindings.h"
#include "window/window_loop.h"

namespace relief::tools {
namespace {

OutputCoding coding_of(const ViewOptions& options) {
    return is_linear_output(options) ? OutputCoding::linear : OutputCoding::srgb;
}

FrameSettings settings_of(const ViewOptions& options, const HealthMarkers& markers) {
    return {.width = options.size.x,
            .height = options.size.y,
            .samples = options.samples,
            .output = coding_of(options),
            .view = options.debug.view,
            .overlays = overlays_of(options.debug, markers)};
}

/// Alpha is kept only where it was asked for, since viewers disagree about what to show behind it.
Image picture_of(const Frame& frame, const Scene& scene) {
    Image picture = frame.image;
    if (scene.background.a == 1.0F) drop_alpha(picture);
    return picture;
}

/// The picture of the other side.
Image draw_other(const ViewOptions& options, const Context& context, const ComposedScene& composed,
                 Stages& stages) {
    Report told;  // What the first side reports is most of it.
    const OtherSide other = other_side(options, composed, stages, told);
    const FrameSettings settings = settings_of(options, chosen_markers(options.debug, other.scene));
    const FramePlan plan = viewed_plan(options, other.scene, settings,
                                       chosen_plan(options, other.scene, settings), told);
    return stages.run("draw other side", [&] {
        Renderer renderer(context, other.scene, plan, settings, told);
        return picture_of(renderer.draw(other.camera), composed.scene());
    });
}

/// Draws every picture that is asked for, writes them where they are to go, and compares.
///
/// \param plan  becomes the plan that was drawn: within the budget, and without unreadable textures
Drawn draw(const ViewOptions& options, const FrameSettings& settings, ComposedScene& composed,
           FramePlan& plan, Stages& stages, Report& report) {
    const Image reference = options.reference ? read_reference(options) : Image{};
    const std::unique_ptr<Context> context =
        stages.run("context", [&] { return std::make_unique<Context>(options.backend); });
    FrameMeasures measures = measure_frame(
        options, {*context, composed.scene(), settings, composed.camera}, plan, stages);
    const std::unique_ptr<Renderer> renderer = stages.run("prepare", [&] {
        return std::make_unique<Renderer>(*context, composed.scene(), plan, settings, report);
    });
    plan = renderer->plan();
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
            const float split = options.compare.split.value_or(usual_split);
            picture = split_picture(picture, other, split);
        }
        if (sink) sink->take(picture);
        if (options.reference)
            drawn.comparison = compare_with_reference(options, picture, reference);
    };
    drawn.frame = draw_sequence(*renderer, composed, options, stages, take, drawn.times);
    if (sink) stages.run("write", [&] { sink->finish(); });
    return drawn;
}

ExitCode run(const CLI::App& app, ViewOptions& options) {
    settle(options);
    if (options.list_bindings) {
        fmt::print(out(), "{}", bindings_text());
        return ExitCode::done;
    }
    set_thread_limit(options.general.threads);
    if (options.wants_window()) return run_window(options);
    Stages stages(options.general.quiet);
    Report report;
    ComposedScene composed = compose_scene(options, stages, report);
    HealthMarkers markers;
    if (options.debug.health_markers)
        markers =
            stages.run("check", [&] { return chosen_markers(options.debug, composed.scene()); });
    const FrameSettings settings = settings_of(options, markers);
    FramePlan plan = viewed_plan(options, composed.scene(), settings,
                                 chosen_plan(options, composed.scene(), settings), report);
    save_files(options, composed, stages);
    std::optional<Drawn> drawn;
    if (options.output || options.reference || options.effects.measures()) {
        drawn = draw(options, settings, composed, plan, stages, report);
    }
    if (options.explain_effects && !options.json) print_effects(composed.scene(), plan);
    if (options.effects.print_shaders && !options.json) print_shaders(composed.scene(), plan);

    Findings findings;
    findings.add("", report);
    if (options.json) {
        nlohmann::ordered_json json = summary_json(options, composed, findings, stages);
        if (drawn) json["picture"] = picture_json(options, *drawn);
        if (drawn) json.update(measures_json(drawn->measures, options, drawn->frame));
        if (drawn && drawn->comparison) {
            json["comparison"] = comparison_json(options, *drawn->comparison);
        }
        if (drawn && drawn->sides) json["compare"] = sides_json(options.compare, *drawn->sides);
        if (options.debug.health_markers) json["markers"] = legend_json(markers);
        if (options.explain_effects) json["effects"] = effects_json(composed.scene(), plan);
        if (options.effects.print_shaders) json["shaders"] = shaders_json(plan);
        print_json(json);
    } else if (drawn && !options.general.quiet) {
        if (options.explain_effects || options.effects.print_shaders) fmt::print(out(), "\n");
        print_summary(options, composed, *drawn, findings, stages);
        if (options.debug.health_markers) print_entry("markers", legend(markers));
        print_measures(drawn->measures, options, drawn->frame);
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

}  // namespace relief::tools
