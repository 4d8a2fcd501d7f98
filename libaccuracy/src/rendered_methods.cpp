// SPDX-License-Identifier: Apache-2.0
// Renders methods side by side, so that their rounds can be interleaved.
#include "rendered_methods.h"

#include <fmt/format.h>

#include <cerrno>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <string>
#include <system_error>

#include "error_metrics.h"
#include "experiment_driver.h"
#include "relief/accuracy/measure.h"
#include "relief/mesh/mesh.h"
#include "relief/shade/context.h"
#include "relief/shade/reference.h"
#include "relief/shade/renderer.h"

namespace relief {
namespace {

/// Sets the affinity of all threads of this process. New threads inherit it.
bool set_affinity(const ::cpu_set_t& processors) {
    std::error_code failed;
    bool is_active = true;
    // A thread may end meanwhile; ESRCH is therefore not an error.
    for (const auto& entry : std::filesystem::directory_iterator("/proc/self/task", failed)) {
        const auto thread = static_cast<::pid_t>(std::stoi(entry.path().filename().string()));
        const bool is_set = ::sched_setaffinity(thread, sizeof processors, &processors) == 0;
        is_active = is_active && (is_set || errno == ESRCH);
    }
    return is_active && !failed;
}

/// The set that holds only the first of `processors`.
::cpu_set_t first_of(const ::cpu_set_t& processors) {
    ::cpu_set_t first;
    CPU_ZERO(&first);
    for (int one = 0; one < CPU_SETSIZE; ++one) {
        if (!CPU_ISSET(one, &processors)) continue;
        CPU_SET(one, &first);
        break;
    }
    return first;
}

}  // namespace

SingleProcessor::SingleProcessor() {
    CPU_ZERO(&before_);
    if (::sched_getaffinity(0, sizeof before_, &before_) != 0) return;
    is_active_ = set_affinity(first_of(before_));
    if (!is_active_) set_affinity(before_);
}

SingleProcessor::~SingleProcessor() {
    if (is_active_) set_affinity(before_);
}

namespace {

FrameSettings settings_of(const RenderedMethod& method, const Image& ground_truth) {
    return {ground_truth.width * method.pixels_per_side,
            ground_truth.height * method.pixels_per_side, method.samples, OutputCoding::srgb};
}

Image drawn(Renderer& renderer, const RenderedMethod& method) {
    const Image picture = without_alpha(renderer.draw(*method.scene.camera).image);
    if (method.pixels_per_side == 1) return picture;
    return to_srgb(averaged(to_linear(picture), method.pixels_per_side), 8);
}

/// A single frame takes less than a time slice of the scheduler (see min_round_seconds in
/// measure.cpp).
constexpr std::size_t frames_per_round = 4;

/// Mean seconds of a few frames of one renderer, without reading back.
double seconds_of_frames(Renderer& renderer, const Camera& camera) {
    Renderer* const only = &renderer;
    const FrameSeries series = time_frames({&only, 1}, camera, {frames_per_round, 0}).front();
    const double milliseconds = std::accumulate(series.draw.begin(), series.draw.end(), 0.0);
    return 1e-3 * milliseconds / static_cast<double>(frames_per_round);
}

/// Interleaved frame times of all methods, with the driver's threads.
std::vector<Timing> frame_timings(const std::string& group,
                                  std::span<const std::unique_ptr<Renderer>> renderers,
                                  const Camera& camera, const RunOptions& options) {
    return measure_interleaved_rounds(group, renderers.size(), options, [&](std::size_t i) {
        return seconds_of_frames(*renderers[i], camera);
    });
}

std::string note_of(const RenderedMethod& method, const GlDevice& device) {
    const std::string where = fmt::format(
        "Rendered by {}; the time excludes reading the image back.{}",
        device.context().renderer_name(),
        device.context().is_software()
            ? " The time on one thread is that of all threads of the driver on one processor."
            : "");
    return method.note.empty() ? where : method.note + " " + where;
}

}  // namespace

GlDevice::GlDevice(Backend backend) {
    try {
        context_ = std::make_unique<Context>(backend);
    } catch (const GpuError& error) {
        absence_ = error.what();
    }
}

bool GlDevice::is_available_for(Experiment& experiment) const {
    if (!context_)
        experiment.finding = "Not measured: this needs OpenGL, which is not available: " + absence_;
    return context_ != nullptr;
}

std::vector<RenderedImage> measure_rendered(const GlDevice& device,
                                            std::span<const RenderedMethod> methods,
                                            const Image& ground_truth, const RunOptions& options,
                                            Experiment& experiment) {
    std::vector<std::unique_ptr<Renderer>> renderers;
    for (const RenderedMethod& method : methods) {
        Report report;
        renderers.push_back(std::make_unique<Renderer>(device.context(), method.scene,
                                                       settings_of(method, ground_truth), report));
    }
    std::vector<RenderedImage> pictures;
    for (std::size_t i = 0; i < methods.size(); ++i) {
        Image picture = drawn(*renderers[i], methods[i]);
        PictureError error = picture_error(ground_truth, picture);
        experiment.measurements.push_back({.method = methods[i].name,
                                           .choices = methods[i].choices,
                                           .error = error.figures,
                                           .cost = {.stored_bytes = methods[i].stored_bytes},
                                           .note = note_of(methods[i], device)});
        pictures.push_back({std::move(picture), std::move(error.map)});
    }
    if (!options.is_timed) return pictures;
    const Camera& camera = *methods.front().scene.camera;
    std::vector<Timing> one;
    if (device.context().is_software()) {
        const SingleProcessor kept;
        if (kept.is_active()) one = frame_timings("one thread", renderers, camera, options);
    }
    const std::vector<Timing> all = frame_timings("all threads", renderers, camera, options);
    const std::size_t first = experiment.measurements.size() - methods.size();
    for (std::size_t i = 0; i < methods.size(); ++i) {
        Cost& cost = experiment.measurements[first + i].cost;
        if (!one.empty()) cost.one_thread = one[i];
        cost.all_threads = all[i];
    }
    return pictures;
}

double rendered_error(const GlDevice& device, const RenderedMethod& method,
                      const Image& ground_truth) {
    Report report;
    Renderer renderer(device.context(), method.scene, settings_of(method, ground_truth), report);
    return picture_error(ground_truth, drawn(renderer, method)).figures.rms;
}

PicturePair image_pair(const std::string& title, const std::string& method, const Image& picture,
                       const Image& ground_truth) {
    return {title, method, "reference", picture, to_srgb(ground_truth, 8)};
}

void add_images(const std::string& title, const RenderedMethod& method, const RenderedImage& image,
                const Image& ground_truth, double brightest, Experiment& experiment) {
    experiment.pictures.push_back(image_pair(title, method.name, image.picture, ground_truth));
    experiment.heat_maps.push_back({"FLIP error", method.name, image.errors, brightest});
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

Experiment image_experiment(const std::string& id, int size) {
    Experiment experiment;
    experiment.id = id;
    experiment.error_unit = "FLIP";
    experiment.item = "pixel";
    experiment.items = static_cast<double>(size) * size;
    return experiment;
}

Scene lit_scene(Mesh mesh, Material material) {
    Scene scene;
    mesh.material_ranges = {{0, static_cast<std::uint32_t>(mesh.triangles.size()), 0U}};
    scene.meshes.emplace_back(std::move(mesh));
    scene.materials = {std::move(material)};
    scene.instances = {{}};
    scene.directional_lights = {{light_direction_world, glm::vec3(light_irradiance)}};
    scene.ambient = glm::vec3(lit_ambient);
    scene.background = lit_background;
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
    const Image shown = reference_picture(reference.radiance, scene, OutputCoding::clamped);
    return without_alpha(averaged(shown, rays_per_side));
}

std::size_t torus_triangles(int slices) {
    return static_cast<std::size_t>(slices) * static_cast<std::size_t>(slices);
}

std::string name_on_torus(const std::string& method, int slices) {
    return fmt::format("{}, {} triangles", method, torus_triangles(slices));
}

Camera torus_camera() {
    return *lit_scene(make_torus(), {}).camera;
}

Chart torus_chart(const Experiment& experiment, std::span<const std::string> methods,
                  std::span<const int> slices) {
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

}  // namespace relief
