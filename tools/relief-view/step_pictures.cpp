// SPDX-License-Identifier: Apache-2.0
#include "step_pictures.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "picture_sheet.h"
#include "picture_sink.h"
#include "relief/mesh/image.h"
#include "relief/mesh/image_file.h"
#include "relief/shade/renderer.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

Image drawn_step(const Context& context, RenderCache& cache, const ComposedScene& composed,
                 const FrameSettings& settings, const PictureStep& step, Report& report) {
    const Scene scene = scene_of_step(composed.scene(), step);
    Renderer renderer(cache, context, scene, plan_of_step(scene, settings, step), settings, report);
    Image picture = renderer.draw(composed.camera).image;
    if (scene.background.a == 1.0F) drop_alpha(picture);
    return picture;
}

/// For example "3 highlights: the mirror images of light sources (FLIP 0.021 from step 2)".
std::string step_text(std::size_t number, const DrawnStep& drawn) {
    const std::string change = drawn.change ? fmt::format(" (FLIP {:.3g} from step {})",
                                                          drawn.change->flip.mean, number - 1)
                                            : "";
    return fmt::format("{} {}: {}{}", number, drawn.step.name, drawn.step.what, change);
}

}  // namespace

void add_step_options(CLI::App& app, ViewOptions& options) {
    add_switch(app, "--steps", options.steps,
               "Draw the picture in steps: ambient light, then also diffuse light, highlights, "
               "shadows, maps, reflection, Fresnel, layers, emission and the tone curve, as far as "
               "the scene has them. The output is a strip with all steps side by side, or "
               "numbered files if its name has a #.")
        .group("Shaders");
}

std::vector<DrawnStep> draw_steps(const ViewOptions& options, const FrameSettings& settings,
                                  const ComposedScene& composed, Stages& stages, Report& report) {
    const std::filesystem::path& output = *options.output;
    const auto context =
        stages.run("context", [&] { return std::make_unique<Context>(options.backend); });
    RenderCache cache(*context);
    std::vector<DrawnStep> drawn;
    std::vector<Image> pictures;
    Report same;  // The last step has all findings.
    const std::vector<PictureStep> steps = picture_steps(composed.scene(), settings);
    for (const PictureStep& step : steps) {
        const bool is_last = drawn.size() + 1 == steps.size();
        stages.run("draw", fmt::format("draw {} of {}", drawn.size() + 1, steps.size()), [&] {
            pictures.push_back(
                drawn_step(*context, cache, composed, settings, step, is_last ? report : same));
        });
        drawn.push_back({step, std::nullopt});
        if (pictures.size() < 2) continue;
        drawn.back().change = compare_pictures(pictures[pictures.size() - 2], pictures.back());
    }
    stages.run("write", [&] {
        if (!has_numbers(output)) return write_image(output, sheet_of({pictures}));
        for (std::size_t i = 0; i < pictures.size(); ++i)
            write_image(numbered_file(output, static_cast<int>(i) + 1), pictures[i]);
    });
    return drawn;
}

void add_steps(Summary& summary, const ViewOptions& options, const std::vector<DrawnStep>& steps) {
    Summary::Lines lines;
    for (std::size_t i = 0; i < steps.size(); ++i)
        lines.push_back(step_text(i + 1, steps[i]));
    summary.add("steps", lines,
                {{"steps", json_list(steps, [](const DrawnStep& drawn) -> Json {
                      return {{"name", drawn.step.name},
                              {"what", drawn.step.what},
                              {"effects", drawn.step.effects},
                              {"parts", drawn.step.parts},
                              {"change", drawn.change ? numbers_json(*drawn.change) : Json()}};
                  })}});
    const std::filesystem::path& output = *options.output;
    summary.add("wrote",
                has_numbers(output)
                    ? fmt::format("{} to {}", numbered_file(output, 1).string(),
                                  numbered_file(output, static_cast<int>(steps.size())).string())
                    : file_and_size(output));
}

}  // namespace relief::tools
