// SPDX-License-Identifier: Apache-2.0
// Renderers live side by side, so that they can draw in turns. Tests:
// tests/accuracy/drawn_methods_test.cpp.
#include "drawn/drawn_methods.h"

#include <fmt/format.h>

#include <cmath>
#include <numeric>

#include "drawn/one_processor.h"
#include "drawn/picture_error.h"
#include "measured_methods.h"
#include "relief/accuracy/measure.h"
#include "relief/shade/error.h"
#include "relief/shade/frame_timing.h"
#include "relief/shade/renderer.h"

namespace relief {
namespace {

FrameSettings settings_of(const DrawnMethod& method, const Image& truth) {
    return {truth.width * method.pixels_a_side, truth.height * method.pixels_a_side, method.samples,
            OutputCoding::srgb};
}

Image drawn(Renderer& renderer, const DrawnMethod& method) {
    const Image picture = without_alpha(renderer.draw(*method.scene.camera).image);
    if (method.pixels_a_side == 1) return picture;
    return to_srgb(averaged(to_linear(picture), method.pixels_a_side), 8);
}

/// Single frames take less than a slice of the scheduler's (measure.cpp).
constexpr std::size_t frames_in_a_round = 4;

/// The mean seconds of some frames of one renderer, without reading them back.
double seconds_of_frames(Renderer& renderer, const Camera& camera) {
    Renderer* const only = &renderer;
    const FrameSeries series = time_frames({&only, 1}, camera, {frames_in_a_round, 0}).front();
    const double milliseconds = std::accumulate(series.draw.begin(), series.draw.end(), 0.0);
    return 1e-3 * milliseconds / static_cast<double>(frames_in_a_round);
}

/// What frames of all methods take, in turns, on the threads that the driver has.
std::vector<Timing> frame_timings(std::span<const std::unique_ptr<Renderer>> renderers,
                                  const Camera& camera, const RunOptions& options) {
    return rounds_in_turns(renderers.size(), options,
                           [&](std::size_t i) { return seconds_of_frames(*renderers[i], camera); });
}

std::string note_of(const DrawnMethod& method, const Drawing& drawing) {
    const std::string where = fmt::format(
        "Drawn by {}; not counted: reading the picture back.{}", drawing.context().renderer_name(),
        drawing.context().is_software() ? " One thread is the driver's threads on one processor."
                                        : "");
    return method.note.empty() ? where : method.note + " " + where;
}

}  // namespace

Drawing::Drawing(Backend backend) {
    try {
        context_ = std::make_unique<Context>(backend);
    } catch (const GpuError& error) {
        absence_ = error.what();
    }
}

bool Drawing::is_possible_for(Experiment& experiment) const {
    if (!context_)
        experiment.finding = "Not measured: this needs OpenGL, and there is none: " + absence_;
    return context_ != nullptr;
}

std::vector<DrawnPicture> measure_drawn(const Drawing& drawing,
                                        std::span<const DrawnMethod> methods, const Image& truth,
                                        const RunOptions& options, Experiment& experiment) {
    std::vector<std::unique_ptr<Renderer>> renderers;
    for (const DrawnMethod& method : methods) {
        Report report;
        renderers.push_back(std::make_unique<Renderer>(drawing.context(), method.scene,
                                                       settings_of(method, truth), report));
    }
    std::vector<DrawnPicture> pictures;
    for (std::size_t i = 0; i < methods.size(); ++i) {
        Image picture = drawn(*renderers[i], methods[i]);
        PictureError error = picture_error(truth, picture);
        experiment.measurements.push_back({.method = methods[i].name,
                                           .choices = methods[i].choices,
                                           .error = error.figures,
                                           .cost = {.stored_bytes = methods[i].stored_bytes},
                                           .note = note_of(methods[i], drawing)});
        pictures.push_back({std::move(picture), std::move(error.map)});
    }
    if (!options.is_timed) return pictures;
    const Camera& camera = *methods.front().scene.camera;
    std::vector<Timing> one;
    if (drawing.context().is_software()) {
        const OneProcessor kept;
        if (kept.is_kept()) one = frame_timings(renderers, camera, options);
    }
    const std::vector<Timing> all = frame_timings(renderers, camera, options);
    const std::size_t first = experiment.measurements.size() - methods.size();
    for (std::size_t i = 0; i < methods.size(); ++i) {
        Cost& cost = experiment.measurements[first + i].cost;
        if (!one.empty()) cost.one_thread = one[i];
        cost.all_threads = all[i];
    }
    return pictures;
}

double drawn_error(const Drawing& drawing, const DrawnMethod& method, const Image& truth) {
    Report report;
    Renderer renderer(drawing.context(), method.scene, settings_of(method, truth), report);
    return picture_error(truth, drawn(renderer, method)).figures.rms;
}

PicturePair pair_of(const std::string& title, const std::string& method, const Image& picture,
                    const Image& truth) {
    return {title, method, "as it should be", picture, to_srgb(truth, 8)};
}

std::string frame_times(std::initializer_list<NamedMeasurement> methods) {
    std::vector<std::string> times;
    for (const auto& [name, measurement] : methods) {
        const double seconds = median_seconds(measurement);
        if (std::isnan(seconds)) return "";
        times.push_back(fmt::format("{:.2g} ms ({})", 1e3 * seconds, name));
    }
    return fmt::format(" Median frame times: {}.", fmt::join(times, ", "));
}

}  // namespace relief
