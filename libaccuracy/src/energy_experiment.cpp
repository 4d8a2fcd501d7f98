// SPDX-License-Identifier: Apache-2.0
// The experiment on the light that rough surfaces lose: white balls in even light, drawn with and
// without the effect "energy compensation". The exact picture is as bright as the light.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "experiment_parts.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/statistics.h"
#include "relief/shade/effects.h"
#include "rendered_methods.h"
#include "shading_experiments.h"

namespace relief::accuracy::detail {
using namespace relief::shade;

namespace {

/// The methods of the experiment.
enum class EnergyMethod { one_bounce, all_bounces };

struct EnergyChoice {
    const char* name;
    const char* bounces;
};
/// In the order of EnergyMethod.
constexpr std::array energy_choices = {EnergyChoice{"one bounce", "1"},
                                       EnergyChoice{"all bounces", "all"}};

/// The radiance of the light; also of the exact picture.
constexpr double even_radiance = 0.5;

/// A ball of white metal in even light.
/// \param coat_roughness  of a clear coat; below 0: none
Scene white_ball(double roughness, double coat_roughness = -1.0) {
    const auto even = [](const glm::dvec3&) { return glm::dvec3(even_radiance); };
    Scene scene = mirror_ball(cube_map_of(even, 16), 0.0);
    MetallicRoughness metal{glm::vec3(1.0F), 1.0F, static_cast<float>(roughness), {}};
    if (coat_roughness >= 0.0) {
        metal.clearcoat = 1.0F;
        metal.clearcoat_roughness = static_cast<float>(coat_roughness);
    }
    scene.materials.front() = {};
    scene.materials.front().metallic_roughness = metal;
    return scene;
}

/// Renders a ball by one of the methods.
class BallRenderer {
  public:
    BallRenderer(const GlDevice& device, const Scene& scene, EnergyMethod method, int size)
        : camera_(*scene.camera),
          renderer_(device.context(), scene, plan(scene, method, size), settings(size)) {}

    /// The lost light of each pixel in percent.
    [[nodiscard]] ErrorStats losses() {
        const Image picture = without_alpha(renderer_.draw(camera_).image);
        std::vector<float> lost;
        for (const float radiance : picture.as<float>())
            lost.push_back(100.0F * std::abs(1.0F - radiance / static_cast<float>(even_radiance)));
        return error_stats(std::move(lost));
    }

    [[nodiscard]] double seconds_of_a_frame() { return seconds_of_frames(renderer_, camera_); }

  private:
    static FrameSettings settings(int size) { return {size, size, 1, OutputCoding::linear}; }
    static FramePlan plan(const Scene& scene, EnergyMethod method, int size) {
        FramePlan planned = plan_effects(scene, settings(size));
        if (method == EnergyMethod::all_bounces) return planned;
        return force_effects(scene, settings(size), std::move(planned),
                             {{}, {{"energy compensation", false}}});
    }

    Camera camera_;
    Renderer renderer_;
};

/// \param ball  returns the ball for a roughness
Chart loss_chart(const GlDevice& device, int size, const char* id, const char* title,
                 const std::function<Scene(double)>& ball) {
    return chart_over(
        {.id = id,
         .title = title,
         .x_label = "roughness",
         .y_label = "lost light in percent",
         .is_x_log = false},
        names_of(energy_choices), {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0}, ball,
        [&](std::size_t i, const Scene& scene) {
            return BallRenderer(device, scene, static_cast<EnergyMethod>(i), size).losses().rms;
        });
}

}  // namespace

PreparedExperiment energy_experiment(const PlanOptions& options) {
    const int size = options.is_quick ? 160 : 320;
    Experiment experiment = image_experiment(size);
    experiment.error_unit = "percent";
    experiment.question =
        "How much light do rough surfaces lose, and what does it cost to keep it?";
    experiment.ground_truth =
        "In even light, a white surface is exactly as bright as the light, from every direction.";
    experiment.input = fmt::format(
        "ball of white metal of roughness 1 in even light, {0} x {0} "
        "pixels; errors are the lost share of the light",
        size);
    const std::shared_ptr<const GlDevice> device = options.device.get();
    if (!device->is_available()) return not_rendered(std::move(experiment), *device);
    using Renderers = std::array<std::unique_ptr<BallRenderer>, energy_choices.size()>;
    const auto renderers = std::make_shared<Renderers>();
    const auto renderer = [device, renderers, size](std::size_t i) -> BallRenderer& {
        std::unique_ptr<BallRenderer>& one = renderers->at(i);
        if (!one)
            one = std::make_unique<BallRenderer>(*device, white_ball(1.0),
                                                 static_cast<EnergyMethod>(i), size);
        return *one;
    };
    PreparedExperiment prepared{.report = std::move(experiment)};
    for (std::size_t i = 0; i < energy_choices.size(); ++i) {
        const EnergyChoice& choice = energy_choices.at(i);
        prepared.methods.push_back(
            {.name = choice.name,
             .choices = {{"bounces", choice.bounces}},
             .error = [renderer, i] { return renderer(i).losses(); },
             .round = [renderer, i] { return renderer(i).seconds_of_a_frame(); },
             .note = rendering_note(*device)});
    }
    set_frame_costs(prepared, *device);
    prepared.finish = [device, chart_size = options.is_quick ? 64 : 160](Experiment& report) {
        report.charts = {
            loss_chart(*device, chart_size, "roughness", "Lost light by roughness",
                       [](double roughness) { return white_ball(roughness); }),
            loss_chart(*device, chart_size, "coat", "Lost light by roughness of a clear coat",
                       [](double roughness) { return white_ball(0.0, roughness); })};
    };
    return prepared;
}

}  // namespace relief::accuracy::detail
