// SPDX-License-Identifier: Apache-2.0
#include "pixel_probe.h"

#include <fmt/format.h>

#include <vector>

#include "common/options.h"
#include "effect_options.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

/// Draws the picture with other samples and coding, and returns its pixel.
class DrawnPixel {
  public:
    DrawnPixel(const ViewOptions& options, const ComposedScene& composed,
               const FrameSettings& settings)
        : options_(options), composed_(composed), settings_(settings), context_(options.backend) {}

    [[nodiscard]] glm::dvec4 at(const glm::ivec2& pixel, int samples, OutputCoding output) const {
        FrameSettings settings = settings_;
        settings.samples = samples;
        settings.output = output;
        Report same;  // The report of the picture has these findings.
        const Scene& scene = composed_.scene();
        Renderer renderer(
            context_, scene,
            viewed_plan(options_, scene, settings, chosen_plan(options_, scene, settings), same),
            settings, same);
        return pixel_of(renderer.draw(composed_.camera).image, pixel);
    }

  private:
    const ViewOptions& options_;
    const ComposedScene& composed_;
    const FrameSettings& settings_;
    Context context_;
};

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
    Scene scene = composed.scene();
    scene.camera = composed.camera;
    ProbedPixel pixel;
    stages.run("explain", [&] {
        const Prober prober(scene, {settings.width, settings.height}, report);
        pixel = reference_values(prober.at(place.x, place.y, settings.view), scene);
    });
    stages.run("draw", [&] {
        const DrawnPixel drawn(options, composed, settings);
        pixel.shader = PixelValues{drawn.at(place, 1, OutputCoding::linear),
                                   drawn.at(place, 1, OutputCoding::srgb)};
        pixel.samples = settings.samples;
        pixel.picture = settings.samples == 1
                            ? pixel.shader->codes
                            : drawn.at(place, settings.samples, OutputCoding::srgb);
    });
    return pixel;
}

}  // namespace relief::tools
