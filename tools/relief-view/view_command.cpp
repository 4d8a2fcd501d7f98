// SPDX-License-Identifier: Apache-2.0
// `relief-view MODEL`: composes the scene, draws it, writes the picture, says what was done. Asked
// only to explain the effects, it plans and needs no OpenGL. Tests:
// tests/tools/relief_view_test.cpp.
#include "view_command.h"

#include <fmt/format.h>

#include <memory>
#include <span>

#include "common/findings.h"
#include "common/text.h"
#include "effects_text.h"
#include "picture_reference.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/threads.h"
#include "relief/shade/renderer.h"
#include "scene_options.h"
#include "view_options.h"

namespace relief::tools {
namespace {

/// A finished picture, and with what it was drawn.
struct Drawn {
    Frame frame;
    std::string backend;
    std::string renderer;
};

OutputCoding coding_of(const ViewOptions& options) {
    return is_linear_output(options) ? OutputCoding::linear : OutputCoding::srgb;
}

FrameSettings settings_of(const ViewOptions& options) {
    return {.width = options.size.x,
            .height = options.size.y,
            .samples = options.samples,
            .output = coding_of(options)};
}

Drawn draw(const ViewOptions& options, const ComposedScene& composed, Stages& stages,
           Report& report) {
    const std::unique_ptr<Context> context =
        stages.run("context", [&] { return std::make_unique<Context>(options.backend); });
    const FrameSettings settings = settings_of(options);
    const std::unique_ptr<Renderer> renderer = stages.run("prepare", [&] {
        return std::make_unique<Renderer>(*context, composed.scene, settings, report);
    });
    return {.frame = stages.run("draw", [&] { return renderer->draw(composed.camera); }),
            .backend = context->backend_name(),
            .renderer = context->renderer_name()};
}

/// Without its last channel: where the whole picture is covered, alpha says nothing.
Image without_alpha(const Image& image) {
    Image opaque =
        make_image(image.width, image.height, image.channels - 1, image.bits(), image.color_space);
    std::visit(
        [&](const auto& samples) {
            using Samples = std::decay_t<decltype(samples)>;
            auto& kept = std::get<Samples>(opaque.samples);
            const auto channels = static_cast<std::size_t>(image.channels);
            for (std::size_t i = 0; i < kept.size(); ++i)
                kept[i] = samples[i / (channels - 1) * channels + i % (channels - 1)];
        },
        image.samples);
    return opaque;
}

/// Alpha is kept only where it was asked for, since viewers disagree about what to show behind it.
Image picture_of(const Frame& frame, const Scene& scene) {
    return scene.background.a == 1.0F ? without_alpha(frame.image) : frame.image;
}

std::string lights_in_words(const Scene& scene) {
    std::string text;
    const auto add = [&](std::size_t count, const std::string& kind) {
        if (count != 0) text += (text.empty() ? "" : ", ") + counted(count, kind + " light");
    };
    add(scene.directional_lights.size(), "directional");
    add(scene.point_lights.size(), "point");
    add(scene.spot_lights.size(), "spot");
    if (text.empty()) text = "no light";
    if (scene.ambient != glm::vec3(0.0F)) text += " and ambient light";
    return text;
}

std::size_t triangle_count(const Scene& scene) {
    std::size_t count = 0;
    for (const Instance& instance : scene.instances)
        count += scene.meshes[instance.mesh].triangles.size();
    return count;
}

void print_summary(const ViewOptions& options, const ComposedScene& composed, const Drawn& drawn,
                   const Findings& findings, const Stages& stages) {
    const Scene& scene = composed.scene;
    print_entry("read", fmt::format("{}: {}, {}", options.model.string(),
                                    counted(scene.instances.size(), "mesh", "meshes"),
                                    counted(triangle_count(scene), "triangle")));
    print_entry("light", lights_in_words(scene));
    print_entry("notes", composed.notes);
    print_entry("findings", findings.empty() ? std::vector<std::string>{"none"} : findings.lines());
    print_entry(
        "drew",
        fmt::format("{} x {}, {}, {}, {}, by {}: {}", options.size.x, options.size.y,
                    counted(static_cast<std::size_t>(options.samples), "sample"),
                    counted(drawn.frame.programs, "program"),
                    counted(drawn.frame.textures, "texture"), drawn.backend, drawn.renderer));
    print_entry("time", durations(stages.finished()));
    if (options.output) print_entry("wrote", file_and_size(*options.output));
}

nlohmann::ordered_json summary_json(const ViewOptions& options, const ComposedScene& composed,
                                    const Findings& findings, const Stages& stages) {
    return {{"tool", "relief-view"},
            {"version", version()},
            {"model", options.model.string()},
            {"instances", composed.scene.instances.size()},
            {"triangles", triangle_count(composed.scene)},
            {"notes", composed.notes},
            {"findings", findings.json()},
            {"milliseconds", durations_json(stages.finished())}};
}

nlohmann::ordered_json picture_json(const ViewOptions& options, const Drawn& drawn) {
    const FrameTimes& times = drawn.frame.times;
    using Json = nlohmann::ordered_json;
    return {{"output", options.output ? Json(options.output->string()) : Json(nullptr)},
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
              {"draw", times.draw},
              {"read_back", times.read_back}}}};
}

ExitCode run(ViewOptions& options) {
    settle(options);
    set_thread_limit(options.general.threads);
    Stages stages(options.general.quiet);
    Report report;
    const ComposedScene composed = compose_scene(options, stages, report);
    const FramePlan plan = plan_effects(composed.scene, settings_of(options));
    if (options.explain_effects && !options.json) print_effects(composed.scene, plan);

    std::optional<Drawn> drawn;
    std::optional<ReferenceComparison> comparison;
    if (options.output || options.reference) {
        const Image reference = options.reference ? read_reference(options) : Image{};
        drawn = draw(options, composed, stages, report);
        const Image picture = picture_of(drawn->frame, composed.scene);
        if (options.output) stages.run("write", [&] { write_image(*options.output, picture); });
        if (options.reference) {
            comparison = stages.run(
                "compare", [&] { return compare_with_reference(options, picture, reference); });
        }
    }

    Findings findings;
    findings.add("", report);
    if (options.json) {
        nlohmann::ordered_json json = summary_json(options, composed, findings, stages);
        if (drawn) json["picture"] = picture_json(options, *drawn);
        if (comparison) json["comparison"] = comparison_json(options, *comparison);
        if (options.explain_effects) json["effects"] = effects_json(composed.scene, plan);
        print_json(json);
    } else if (drawn && !options.general.quiet) {
        if (options.explain_effects) fmt::print("\n");
        print_summary(options, composed, *drawn, findings, stages);
        if (comparison) print_entry("compared", in_words(*comparison));
    }
    if (comparison) require_match(options, *comparison);
    return ExitCode::done;
}

}  // namespace

Command add_view_command(CLI::App& tool) {
    const auto options = std::make_shared<ViewOptions>();
    add_view_options(tool, *options);
    set_examples(
        tool,
        {"relief-view data/vase.obj --output out/vase.png",
         "relief-view data/vase.obj --height-map data/bricks-height.png --strength 12 --output "
         "out/bricks.png",
         "relief-view data/vase.obj --environment data/sky --reflectivity 0.4 --output "
         "out/mirror.png --size 640x480",
         "relief-view data/vase.obj --light directional:-60,20 --light "
         "point:2,2,2,4,#ff8040 --camera 0,10,1.5 --output out/lit.exr",
         "relief-view data/vase.obj --diffuse-map data/bricks-diffuse.png --explain-effects"});
    return {&tool, [options] { return run(*options); }};
}

}  // namespace relief::tools
