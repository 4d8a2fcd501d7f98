// SPDX-License-Identifier: Apache-2.0
// Renders methods side by side, so that their rounds can be interleaved; and computes errors of
// images (FLIP and PSNR) against a ground truth.
#include "rendered_methods.h"

#include <fmt/format.h>

#include <cmath>
#include <numeric>
#include <string>

#include "experiment_parts.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"
#include "relief/mesh/statistics.h"
#include "relief/shade/image_compare.h"
#include "relief/shade/reference.h"
#include "relief/shade/renderer.h"

namespace relief::accuracy::detail {
using namespace relief::shade;

GlDevice::GlDevice(Backend backend) {
    try {
        context_ = std::make_unique<Context>(backend);
    } catch (const GpuError& error) {
        absence_ = error.what();
    }
}

namespace {

/// A single frame takes less than a time slice of the scheduler (see repeats_per_round()).
constexpr std::size_t frames_per_round = 4;

/// A rendering that is ready to be drawn.
class Drawing {
  public:
    Drawing(const GlDevice& device, Rendering rendering, int size, PictureMetric metric)
        : rendering_(std::move(rendering)) {
        const int side = size * rendering_.pixels_per_side;
        const FrameSettings settings{
            side, side, rendering_.samples,
            metric == PictureMetric::flip ? OutputCoding::srgb : OutputCoding::linear};
        const Scene& scene = rendering_.scene;
        FramePlan plan = plan_effects(scene, settings);
        if (!rendering_.effects.empty())
            plan = force_effects(scene, settings, std::move(plan), {{}, rendering_.effects});
        renderer_ = std::make_unique<Renderer>(device.context(), scene, std::move(plan), settings);
    }

    /// Three channels: 8-bit sRGB, or linear floats.
    [[nodiscard]] Image picture() {
        Image picture = renderer_->draw(*rendering_.scene.camera).image;
        drop_alpha(picture);
        if (rendering_.pixels_per_side == 1) return picture;
        return to_srgb(averaged(to_linear(picture), rendering_.pixels_per_side), 8);
    }

    /// The mean time of a few frames, without reading back.
    [[nodiscard]] double seconds_of_frames() {
        Renderer* const only = renderer_.get();
        const FrameSeries series =
            time_frames({&only, 1}, *rendering_.scene.camera, {frames_per_round, 0}).front();
        const double milliseconds = std::accumulate(series.draw.begin(), series.draw.end(), 0.0);
        return 1e-3 * milliseconds / static_cast<double>(frames_per_round);
    }

  private:
    Rendering rendering_;
    std::unique_ptr<Renderer> renderer_;
};

PictureError percent_error(const Image& ground_truth, const Image& picture) {
    const std::span<const float> expected = ground_truth.as<float>();
    std::vector<float> lost;
    for (const float radiance : picture.as<float>())
        lost.push_back(100.0F * std::abs(1.0F - radiance / expected[lost.size()]));
    return {error_stats(std::move(lost)), {}};
}

PictureError error_by(PictureMetric metric, const Image& ground_truth, const Image& picture) {
    return metric == PictureMetric::flip ? picture_error(ground_truth, picture)
                                         : percent_error(ground_truth, picture);
}

/// The state that the methods of an experiment share.
struct State {
    RenderedExperiment experiment;
    Renderings renderings;
    std::vector<std::unique_ptr<Drawing>> drawings;  ///< Null until a method is used.

    Drawing& drawing(std::size_t method) {
        if (!drawings[method])
            drawings[method] = std::make_unique<Drawing>(
                *renderings.device, renderings.methods[method].compute(experiment.x),
                experiment.size, experiment.metric);
        return *drawings[method];
    }

    /// Renders the image of a method and compares it with the ground truth.
    ErrorStats error_of(std::size_t method) {
        Image picture = drawing(method).picture();
        PictureError error = error_by(experiment.metric, renderings.ground_truth, picture);
        renderings.images[method] = {std::move(picture), std::move(error.map)};
        return error.figures;
    }

    void finish(Experiment& report) const {
        if (experiment.finish) experiment.finish(report, renderings);
        for (const std::size_t i : experiment.shown) {
            const std::string& name = renderings.methods[i].name;
            const RenderedImage& image = renderings.images[i];
            report.pictures.push_back(
                image_pair(experiment.title, name, image.picture, renderings.ground_truth));
            report.heat_maps.push_back({"FLIP error", name, image.errors, experiment.brightest});
        }
    }
};

}  // namespace

PreparedExperiment prepare_rendering(std::shared_ptr<const GlDevice> device,
                                     RenderedExperiment experiment) {
    PreparedExperiment prepared{.report = std::move(experiment.report)};
    prepared.report.error_unit = experiment.metric == PictureMetric::flip ? "FLIP" : "percent";
    prepared.report.item = "pixel";
    prepared.report.items = static_cast<double>(experiment.size) * experiment.size;
    if (!device->is_available()) {
        prepared.report.finding =
            "Not measured: this needs OpenGL, which is not available: " + device->absence();
        return prepared;
    }
    const Context& context = device->context();
    prepared.costs.one_thread = context.is_software();
    prepared.limits_processors = true;
    prepared.compared = experiment.compared;
    const std::string where = fmt::format(
        "Rendered by {}; the time excludes reading the image back.{}", context.renderer_name(),
        context.is_software()
            ? " The time on one thread is that of all threads of the driver on one processor."
            : "");
    const auto state = std::make_shared<State>();
    state->renderings = {
        std::move(device), std::move(experiment.methods), experiment.ground_truth(), {}};
    state->experiment = std::move(experiment);
    const std::vector<RenderedMethod>& methods = state->renderings.methods;
    state->renderings.images.resize(methods.size());
    state->drawings.resize(methods.size());
    for (std::size_t i = 0; i < methods.size(); ++i) {
        const RenderedMethod& method = methods[i];
        prepared.methods.push_back(
            {.name = method.name,
             .choices = method.choices,
             .error = [state, i] { return state->error_of(i); },
             .round = [state, i] { return state->drawing(i).seconds_of_frames(); },
             .stored_bytes = method.stored_bytes,
             .note = method.note.empty() ? where : method.note + " " + where});
    }
    prepared.finish = [state](Experiment& report) { state->finish(report); };
    return prepared;
}

Chart rendered_chart(const GlDevice& device, Chart chart,
                     const std::vector<RenderedMethod>& methods, const std::vector<double>& all_x,
                     const std::function<Image(double x)>& ground_truth, PictureMetric metric) {
    return chart_over(
        std::move(chart), names_of(methods), all_x,
        [&](double x) { return std::pair(x, ground_truth(x)); },
        [&](std::size_t i, const std::pair<double, Image>& at) {
            const auto& [x, expected] = at;
            Drawing drawing(device, methods[i].compute(x), expected.width, metric);
            return error_by(metric, expected, drawing.picture()).figures.rms;
        });
}

PicturePair image_pair(const std::string& title, const std::string& method, const Image& picture,
                       const Image& ground_truth) {
    return {title, method, "reference", picture, to_srgb(ground_truth, 8)};
}

Scene lit_scene(Mesh mesh, Material material) {
    Scene scene;
    mesh.material_ranges = {{0, static_cast<std::uint32_t>(mesh.triangles.size()), 0U}};
    scene.meshes.emplace_back(std::move(mesh));
    scene.materials = {std::move(material)};
    scene.instances = {{}};
    scene.directional_lights = {{light_direction_world, glm::vec3(light_irradiance)}};
    scene.ambient = glm::vec3(lit_ambient);
    scene.background = glm::vec4(0.03F, 0.04F, 0.06F, 1.0F);
    scene.camera =
        framed(world_bounds(scene), glm::radians(30.0F), glm::radians(35.0F), 0.7F, 1.0F);
    scene.camera->vertical_fov = 0.5F;  // Flat objects leave room above and below.
    return scene;
}

Scene bumpy_scene(Mesh mesh, Material material, Image normal_map) {
    material.normal_map = NormalMap{};
    Scene scene = lit_scene(std::move(mesh), std::move(material));
    scene.images = {{"bumps", Shared<Image>(std::move(normal_map))}};
    return scene;
}

Material glossy_plastic() {
    Material material;
    material.ambient = material.diffuse = {0.55F, 0.16F, 0.1F};
    material.specular = glm::vec3(0.5F);
    material.shininess = 40.0F;
    return material;
}

Image supersampled_reference(const Scene& scene, int size, int rays_per_side) {
    Report report;
    const int side = size * rays_per_side;
    const Reference reference = render_reference(scene, {side, side, 0.0}, report);
    Image shown = reference_picture(reference.radiance, scene, OutputCoding::clamped);
    drop_alpha(shown);
    return averaged(shown, rays_per_side);
}

std::size_t torus_triangles(int slices) {
    return static_cast<std::size_t>(slices) * static_cast<std::size_t>(slices);
}

RenderedMethod method_on_torus(const std::string& choice, const TorusMethod& method, int slices) {
    const std::string triangles = std::to_string(torus_triangles(slices));
    return {.name = method.name + ", " + triangles + " triangles",
            .choices = {{choice, method.name}, {"triangles", triangles}},
            .compute = [=](double) { return Rendering{method.scene(slices)}; },
            .stored_bytes = method.stored_bytes};
}

Camera torus_camera() {
    return *lit_scene(make_torus(), {}).camera;
}

namespace {

/// A chart of the error by triangle count, with one curve per method.
/// \param experiment  its first measurements are those of the methods in order, each on all meshes
Chart torus_chart(const Experiment& experiment, const std::vector<std::string>& methods,
                  const std::vector<int>& slices) {
    Chart chart{.id = "triangles",
                .title = "Error by triangles",
                .x_label = "triangles",
                .y_label = experiment.error_unit};
    for (std::size_t m = 0; m < methods.size(); ++m) {
        Curve curve{.method = methods[m]};
        for (std::size_t s = 0; s < slices.size(); ++s) {
            const Measurement& one = experiment.measurements.at(m * slices.size() + s);
            curve.points.push_back(
                {static_cast<double>(torus_triangles(slices[s])), one.error.rms});
        }
        curve.order = fitted_order(curve.points);
        chart.curves.push_back(std::move(curve));
    }
    return chart;
}

}  // namespace

RenderedExperiment on_tori(Experiment report, const std::string& choice,
                           const std::vector<TorusMethod>& methods, const std::vector<int>& slices,
                           const std::function<Scene(int slices)>& smooth, int size) {
    RenderedExperiment experiment{.report = std::move(report), .size = size};
    for (const TorusMethod& method : methods) {
        for (const int one : slices)
            experiment.methods.push_back(method_on_torus(choice, method, one));
    }
    experiment.ground_truth = [=] {
        return supersampled_reference(smooth(smooth_torus_slices), size, 1);
    };
    experiment.finish = [names = names_of(methods), slices](Experiment& finished,
                                                            const Renderings&) {
        finished.charts = {torus_chart(finished, names, slices)};
    };
    return experiment;
}

PictureError picture_error(const Image& ground_truth, const Image& picture) {
    const Image shown = to_srgb(ground_truth, 8);
    FlipDifference flip = flip_difference(shown, picture);
    const std::span<const float> pixels = flip.map.as<float>();
    PictureError error{error_stats({pixels.begin(), pixels.end()}), std::move(flip.map)};
    error.figures.psnr = compare(shown, picture).psnr;
    return error;
}

Image averaged(const Image& linear, int side) {
    if (side < 1 || linear.width % side != 0 || linear.height % side != 0)
        throw InvalidInput("a picture can be averaged only by squares that fit into it");
    Image mean = make_image(linear.width / side, linear.height / side, linear.channels, 32,
                            linear.color_space);
    const std::span<const float> from = linear.as<float>();
    const std::span<float> to = mean.as<float>();
    const auto channels = static_cast<std::size_t>(linear.channels);
    const auto index = [channels](int width, int x, int y) {
        return channels * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                           static_cast<std::size_t>(x));
    };
    for (int y = 0; y < mean.height; ++y) {
        for (int x = 0; x < mean.width; ++x) {
            for (std::size_t channel = 0; channel < channels; ++channel) {
                double sum = 0.0;
                for (int i = 0; i < side * side; ++i) {
                    sum += static_cast<double>(
                        from[index(linear.width, x * side + i % side, y * side + i / side) +
                             channel]);
                }
                to[index(mean.width, x, y) + channel] = static_cast<float>(sum / (side * side));
            }
        }
    }
    return mean;
}

}  // namespace relief::accuracy::detail
