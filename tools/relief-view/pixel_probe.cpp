// SPDX-License-Identifier: Apache-2.0
#include "pixel_probe.h"

#include <fmt/format.h>

#include <vector>

#include "common/options.h"
#include "effect_options.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

/// Draws the picture with other samples and coding.
Image drawn_picture(const Context& context, const ViewOptions& options,
                    const ComposedScene& composed, FrameSettings settings, int samples,
                    OutputCoding output) {
    settings.samples = samples;
    settings.output = output;
    Report same;  // The report of the picture has these findings.
    const Scene& scene = composed.scene();
    Renderer renderer(
        context, scene,
        viewed_plan(options, scene, settings, chosen_plan(options, scene, settings), same),
        settings, same);
    return renderer.draw(composed.camera).image;
}

}  // namespace

void add_probe_options(CLI::App& app, ViewOptions& options) {
    add_value(app, "--probe", "X,Y",
              "Explain the pixel in column X and row Y, counted from 0 at the upper left: its "
              "vectors, textures and lights, the terms of its light with their formulas and "
              "numbers from the double-precision reference, and the difference to the shader. "
              "docs/probe.md describes the text and the --json. This option needs no --output.",
              [&](const std::string& subject, const std::string& text) {
                  const std::vector<std::string> parts = split(text, ',');
                  if (parts.size() != 2) throw UsageError(subject + ": not a pixel like 320,240");
                  options.probe = {parse_integer(subject, parts[0], 0, 16383),
                                   parse_integer(subject, parts[1], 0, 16383)};
              })
        .group("Debug views");
}

void check_probed_view(const ViewOptions& options) {
    const DebugView view = options.debug.view;
    refuse(options.probe && view != DebugView::picture && !is_term(view), "--probe",
           fmt::format("explains light, and --show {} shows none", debug_view_info(view).name),
           "leave --show out; the probe lists the vectors and texture coordinates");
}

ProbedPixel probed_pixel(const ViewOptions& options, const ComposedScene& composed,
                         const FrameSettings& settings, Stages& stages, Report& report) {
    const glm::ivec2 place = *options.probe;
    if (place.x >= settings.width || place.y >= settings.height) {
        throw UsageError(fmt::format("--probe {},{}: is outside of the picture of {} x {} pixels",
                                     place.x, place.y, settings.width, settings.height),
                         "--size sets the size");
    }
    return probed_pixels(options, composed, settings, {place}, stages, report).front();
}

std::vector<ProbedPixel> probed_pixels(const ViewOptions& options, const ComposedScene& composed,
                                       const FrameSettings& settings,
                                       const std::vector<glm::ivec2>& places, Stages& stages,
                                       Report& report) {
    Scene scene = composed.scene();
    scene.camera = composed.camera;
    std::vector<ProbedPixel> pixels;
    stages.run("explain", [&] {
        const Prober prober(scene, {settings.width, settings.height}, report);
        for (const glm::ivec2& place : places) {
            pixels.push_back(reference_values(prober.at(place.x, place.y, settings.view), scene));
        }
    });
    stages.run("draw", [&] {
        const Context context(options.backend);
        const auto draw = [&](int samples, OutputCoding output) {
            return drawn_picture(context, options, composed, settings, samples, output);
        };
        const Image linear = draw(1, OutputCoding::linear);
        const Image codes = draw(1, OutputCoding::srgb);
        const Image picture =
            settings.samples == 1 ? codes : draw(settings.samples, OutputCoding::srgb);
        for (std::size_t i = 0; i < places.size(); ++i) {
            pixels[i].shader = PixelValues{pixel_of(linear, places[i]), pixel_of(codes, places[i])};
            pixels[i].samples = settings.samples;
            pixels[i].picture = pixel_of(picture, places[i]);
        }
    });
    return pixels;
}

}  // namespace relief::tools
