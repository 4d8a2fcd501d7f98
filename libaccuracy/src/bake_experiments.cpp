// SPDX-License-Identifier: Apache-2.0
// Bakes a sphere with bumps onto a coarse sphere. The ground truth of a texel is the mean of many
// rays.
#include "bake_experiments.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/trigonometric.hpp>
#include <memory>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "experiment_driver.h"
#include "relief/accuracy/measure.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/mesh.h"
#include "rendered_methods.h"
#include "report_names.h"

namespace relief {
namespace {

constexpr double height = 0.02;
constexpr double waves = 12.0;

struct SphereAngles {
    double longitude = 0.0;  ///< From +z towards +x.
    double polar = 0.0;      ///< From +y.
};

SphereAngles angles_of(const glm::dvec3& p) {
    return {std::atan2(p.x, p.z), std::atan2(std::hypot(p.x, p.z), p.y)};
}

double radius_at(const SphereAngles& a) {
    return 1.0 + height * std::sin(waves * a.longitude) * std::sin(waves * a.polar);
}

glm::dvec3 direction_at(const SphereAngles& a) {
    return {std::sin(a.polar) * std::sin(a.longitude), std::cos(a.polar),
            std::sin(a.polar) * std::cos(a.longitude)};
}

/// Normalizes the gradient of |p| - radius: outward - d radius / d polar * p_polar
/// - d radius / d longitude / sin polar * p_longitude, divided by the radius.
glm::dvec3 normal_at(const SphereAngles& a) {
    const double sine = std::max(std::sin(a.polar), 1e-9);
    const glm::dvec3 polar_wards(std::cos(a.polar) * std::sin(a.longitude), -std::sin(a.polar),
                                 std::cos(a.polar) * std::cos(a.longitude));
    const glm::dvec3 east(std::cos(a.longitude), 0.0, -std::sin(a.longitude));
    const double by_polar =
        height * waves * std::sin(waves * a.longitude) * std::cos(waves * a.polar);
    const double by_longitude =
        height * waves * std::cos(waves * a.longitude) * std::sin(waves * a.polar);
    const double radius = radius_at(a);
    return glm::normalize(direction_at(a) - by_polar / radius * polar_wards -
                          by_longitude / (radius * sine) * east);
}

/// Barycentric weights of the intersection of a ray with a triangle; the edges have a small
/// tolerance.
std::optional<glm::dvec3> weights_of(const glm::dvec3& from, const glm::dvec3& along,
                                     const glm::dvec3& a, const glm::dvec3& b,
                                     const glm::dvec3& c) {
    const glm::dvec3 x = a - from;
    const glm::dvec3 y = b - from;
    const glm::dvec3 z = c - from;
    const glm::dvec3 volumes(glm::dot(glm::cross(along, z), y), glm::dot(glm::cross(along, x), z),
                             glm::dot(glm::cross(along, y), x));
    const glm::dvec3 weights = volumes / (volumes.x + volumes.y + volumes.z);
    if (!(std::min({weights.x, weights.y, weights.z}) > -1e-9)) return std::nullopt;
    return weights;
}

}  // namespace

BumpySphere::BumpySphere(int stacks) : stacks_(stacks) {
    const int slices = 2 * stacks;
    for (int stack = 0; stack <= stacks; ++stack) {
        for (int slice = 0; slice <= slices; ++slice) {
            const SphereAngles a{2.0 * std::numbers::pi * (slice % slices) / slices,
                                 std::numbers::pi * stack / stacks};
            mesh_.positions.emplace_back(radius_at(a) * direction_at(a));
            mesh_.normals.emplace_back(normal_at(a));
        }
    }
    for (int stack = 0; stack < stacks; ++stack) {
        for (int slice = 0; slice < slices; ++slice) {
            const auto upper = static_cast<std::uint32_t>(stack * (slices + 1) + slice);
            const auto lower = upper + static_cast<std::uint32_t>(slices + 1);
            mesh_.triangles.emplace_back(upper, lower, lower + 1);
            mesh_.triangles.emplace_back(upper, lower + 1, upper + 1);
        }
    }
}

SurfacePoint BumpySphere::on_surface(const glm::dvec3& from, const glm::dvec3& inward) {
    // Advance by the distance of the point from the surface; the ray is steep, so this converges.
    double way = 0.0;
    glm::dvec3 at = from;
    for (int step = 0; step < 40; ++step) {
        const double outside = glm::length(at) - radius_at(angles_of(at));
        if (std::abs(outside) < 1e-15) break;
        way += outside;
        at = from + way * inward;
    }
    return {at, normal_at(angles_of(at))};
}

SurfacePoint BumpySphere::on_mesh(const glm::dvec3& from, const glm::dvec3& inward) const {
    const SphereAngles a = angles_of(on_surface(from, inward).position);
    const int slices = 2 * stacks_;
    const auto near_stack = static_cast<int>(std::floor(a.polar / std::numbers::pi * stacks_));
    const auto near_slice =
        static_cast<int>(std::floor(a.longitude / (2.0 * std::numbers::pi) * slices));
    for (int stack = std::max(near_stack - 1, 0); stack <= std::min(near_stack + 1, stacks_ - 1);
         ++stack) {
        for (int by = -1; by <= 1; ++by) {
            const int slice = (near_slice + by + slices) % slices;
            for (int half = 0; half < 2; ++half) {
                const auto index = static_cast<std::size_t>(2 * (stack * slices + slice) + half);
                const glm::uvec3& t = mesh_.triangles[index];
                const auto weights =
                    weights_of(from, inward, glm::dvec3(mesh_.positions[t.x]),
                               glm::dvec3(mesh_.positions[t.y]), glm::dvec3(mesh_.positions[t.z]));
                if (!weights) continue;
                const auto mixed = [&](const std::vector<glm::vec3>& values) {
                    return weights->x * glm::dvec3(values[t.x]) +
                           weights->y * glm::dvec3(values[t.y]) +
                           weights->z * glm::dvec3(values[t.z]);
                };
                return {mixed(mesh_.positions), glm::normalize(mixed(mesh_.normals))};
            }
        }
    }
    throw std::logic_error("a line passes the sphere by");
}

namespace {

Mesh low_sphere(Report& report) {
    return with_frames(make_sphere(BumpyBake::low_slices, BumpyBake::low_stacks),
                       {.tangents = TangentMethod::mikktspace}, report)
        .mesh;
}

BakeMapOptions square_map(int side) {
    BakeMapOptions map;
    map.width = map.height = side;
    return map;
}

}  // namespace

std::string name_of(const BakeSampling& way) {
    if (way.sample_degrees)
        return fmt::format("up to {} rays beyond {:g}°", way.samples, *way.sample_degrees);
    return way.samples == 1 ? "1 ray" : fmt::format("{} rays", way.samples);
}

BumpyBake::BumpyBake(int high_stacks, int side)
    : high_(high_stacks),
      baker_(std::span(&high_.mesh(), 1), low_sphere(report_), BakeOptions{}, report_),
      map_(square_map(side)),
      trials_(baker_, map_, static_cast<std::size_t>(side) * static_cast<std::size_t>(side)) {}

std::string BumpyBake::description() const {
    return fmt::format("sphere with bumps, {} triangles, for one of {}; map of {} x {} texels",
                       high_.mesh().triangles.size(), baker_.low().triangles.size(), map_.width,
                       map_.height);
}

double BumpyBake::texels() const {
    return static_cast<double>(map_.width) * map_.height;
}

const std::vector<NormalMapFormat>& BumpyBake::formats() {
    static const std::vector<NormalMapFormat> all = {{.bits = 8}, {.bits = 16}, {.bits = 32}};
    return all;
}

Image BumpyBake::map_by(const BakeSampling& way, const NormalMapFormat& format) const {
    BakeMapOptions map = map_;
    map.samples = way.samples;
    if (way.sample_degrees) map.sample_angle = glm::radians(*way.sample_degrees);
    Image normals = make_image(map.width, map.height, 3, 32, ColorSpace::data);
    std::span<float> rest = normals.as<float>();
    Report ignored;
    baker_.bake(
        map,
        [&](const BakedRows& rows) {
            std::copy(rows.normals.begin(), rows.normals.end(), rest.begin());
            rest = rest.subspan(rows.normals.size());
        },
        ignored);
    return encode_normal_map(normals, format, ignored);
}

std::vector<BakeWayResult> BumpyBake::measured(std::span<const BakeSampling> ways,
                                               const RunOptions& options) const {
    std::vector<BakeWayResult> results;
    for (const BakeSampling& way : ways)
        results.push_back({trials_.measure(way, formats())});
    if (!options.is_timed) return results;
    // One cast serves all formats of a way, which are consecutive here.
    const std::size_t depths = formats().size();
    BakeMeasurement trial;
    const auto timings = [&](const char* group) {
        return measure_interleaved_rounds(group, ways.size() * depths, options, [&](std::size_t i) {
            if (i % depths == 0) trial = trials_.measure(ways[i / depths], formats());
            return trial.cast_seconds + trial.code_seconds[i % depths];
        });
    };
    const std::vector<Timing> one = on_one_thread(options, [&] { return timings("one thread"); });
    const std::vector<Timing> all = timings("all threads");
    for (std::size_t i = 0; i < one.size(); ++i) {
        results[i / depths].one_thread.push_back(one[i]);
        results[i / depths].all_threads.push_back(all[i]);
    }
    return results;
}

namespace {

/// One finished map.
struct BakedMap {
    BakeSampling way;
    NormalMapFormat format;
};

constexpr int picture_side = 320;
constexpr int rays_per_side = 2;

std::string name_of(const BakedMap& map) {
    return fmt::format("{}, {}", name_of(map.way), depth_name(map.format.bits));
}

Image picture_of(const Scene& scene) {
    return supersampled_reference(scene, picture_side, rays_per_side);
}

/// Adds a heat map of the errors of each map. \param brightest  degrees shown at full brightness
void add_error_maps(const BumpyBake& bake, std::span<const BakedMap> maps, double brightest,
                    Experiment& experiment) {
    for (const BakedMap& map : maps) {
        experiment.heat_maps.push_back({"Error of the map", name_of(map),
                                        bake.trials().error_map(map.way, map.format), brightest});
    }
}

/// Adds an image pair per map: the low mesh with the map, and the high mesh. The CPU reference
/// shader renders both, so OpenGL is not needed.
void add_renderings(const BumpyBake& bake, std::span<const BakedMap> maps, Experiment& experiment) {
    const Scene high = lit_scene(bake.high().mesh(), glossy_plastic());
    const Image ground_truth = picture_of(high);
    for (const BakedMap& map : maps) {
        Scene low =
            bumpy_scene(bake.baker().low(), glossy_plastic(), bake.map_by(map.way, map.format));
        low.camera = high.camera;
        experiment.pictures.push_back(image_pair(
            fmt::format("{} triangles with a map of {} x {} texels, and the {} triangles from "
                        "which it was baked",
                        bake.baker().low().triangles.size(), bake.map().width, bake.map().height,
                        bake.high().mesh().triangles.size()),
            name_of(map), to_srgb(picture_of(low), 8), ground_truth));
    }
}

double rays_per_texel(const BakeWayResult& result, const BumpyBake& bake) {
    return static_cast<double>(result.trial.rays) / bake.texels();
}

Cost nominal_cost(const BakeWayResult& result, std::size_t format) {
    Cost cost{.stored_bytes = 3.0 * BumpyBake::formats()[format].bits / 8.0};
    if (result.one_thread.empty()) return cost;
    cost.one_thread = result.one_thread[format];
    cost.all_threads = result.all_threads[format];
    return cost;
}

/// The common part of both experiments, and a measurement of each way in each of `formats`.
Experiment measured(const BumpyBake& bake, std::span<const BakeSampling> ways,
                    const std::vector<BakeWayResult>& results,
                    std::span<const std::size_t> formats) {
    Experiment experiment{
        .subject = Subject::bake,
        .ground_truth = fmt::format(
            "The mean of {} rays per texel, not rounded to codes. A test verifies bakes by the "
            "formula of the surface, without the baker's rays.",
            bake.trials().reference_samples()),
        .input = bake.description(),
        .error_unit = "degrees",
        .item = "texel",
        .items = bake.texels()};
    for (std::size_t i = 0; i < ways.size(); ++i) {
        for (const std::size_t format : formats) {
            const NormalMapFormat& depth = BumpyBake::formats()[format];
            experiment.measurements.push_back(
                {.method = fmt::format("{}, {}", name_of(ways[i]), depth_name(depth.bits)),
                 .choices = {{"rays", name_of(ways[i])}, {"depth", depth_name(depth.bits)}},
                 .error = nan_if_empty(results[i].trial.errors[format]),
                 .cost = nominal_cost(results[i], format),
                 .note = fmt::format("{:.2f} rays per texel.", rays_per_texel(results[i], bake))});
        }
    }
    mark_pareto_optimal(experiment);
    return experiment;
}

Curve curve_of(const std::string& name, const BumpyBake& bake,
               std::span<const BakeWayResult> results, std::size_t format) {
    Curve curve{.method = name};
    for (const BakeWayResult& one : results)
        curve.points.push_back({rays_per_texel(one, bake), curve_error(one.trial.errors[format])});
    return curve;
}

/// The speed of ray casting, from a float map, whose encoding time is negligible; empty if not
/// timed.
std::string speed_of(const BakeWayResult& result) {
    if (result.one_thread.empty()) return {};
    const auto millions = [&](const Timing& timing) {
        return 1e-6 * static_cast<double>(result.trial.rays) / timing.spread().median;
    };
    return fmt::format(
        " It casts {:.2g} million rays per second on one thread, {:.2g} on all threads.",
        millions(result.one_thread.back()), millions(result.all_threads.back()));
}

Experiment by_samples(const BumpyBake& bake, const RunOptions& options) {
    std::vector<BakeSampling> ways = {{1}, {4}, {16}};
    if (!options.is_quick) ways.push_back({64});
    const std::vector<BakeWayResult> results = bake.measured(ways, options);
    constexpr std::array<std::size_t, 3> formats = {0, 1, 2};
    Experiment experiment = measured(bake, ways, results, formats);
    experiment.id = "bake/samples";
    experiment.question = "How many rays does a texel need, and how many bits?";
    Chart chart{.id = "rays",
                .title = "Error by rays",
                .x_label = "rays per texel",
                .y_label = "RMS error, degrees"};
    for (const std::size_t format : formats)
        chart.curves.push_back(
            curve_of(depth_name(BumpyBake::formats()[format].bits), bake, results, format));
    // Sample points are the centers of equal squares: halving their distance quarters the error.
    chart.curves.back() =
        fitted_curve(chart.curves.back().method, chart.curves.back().points, -1.0);
    experiment.charts = {std::move(chart)};
    const std::array maps = {BakedMap{ways.front(), {.bits = 8}}, BakedMap{ways[2], {.bits = 8}},
                             BakedMap{ways[2], {.bits = 16}}};
    add_error_maps(bake, maps, 2.0, experiment);
    add_renderings(bake, std::span(maps).first(2), experiment);
    const auto rms = [&](std::size_t way, std::size_t format) {
        return results[way].trial.errors[format].rms;
    };
    const std::size_t last = ways.size() - 1;
    experiment.finding = fmt::format(
        "Without rounding, {} per texel has an error of {:.3f} degrees (RMS), {} {:.3f} and {} "
        "{:.4f}. Rounding alone has an error of {:.3f} degrees in 8 bits and {:.4f} in 16 bits; "
        "with {} the error is {:.3f} in 8 bits and {:.4f} in 16 bits.{}",
        name_of(ways[0]), rms(0, 2), name_of(ways[1]), rms(1, 2), name_of(ways[last]), rms(last, 2),
        results[0].trial.quantization[0].rms, results[0].trial.quantization[1].rms,
        name_of(ways[last]), rms(last, 0), rms(last, 1), speed_of(results[last]));
    return experiment;
}

Experiment by_threshold(const BumpyBake& bake, const RunOptions& options) {
    const int max_rays = options.is_quick ? 16 : 64;
    std::vector<BakeSampling> ways;
    for (const double degrees : {16.0, 8.0, 4.0, 2.0, 1.0, 0.5})
        ways.push_back({max_rays, degrees});
    const auto adaptive = static_cast<std::ptrdiff_t>(ways.size());
    ways.push_back({max_rays / 4});
    ways.push_back({max_rays});
    const std::vector<BakeWayResult> results = bake.measured(ways, options);
    constexpr std::array<std::size_t, 1> formats = {2};
    Experiment experiment = measured(bake, ways, results, formats);
    experiment.id = "bake/adaptive";
    experiment.question = "Does it pay to cast more rays only where the first rays differ?";
    Chart rays{.id = "rays",
               .title = "Error by rays",
               .x_label = "rays per texel",
               .y_label = "RMS error, degrees",
               .curves = {curve_of("more where they differ", bake,
                                   {results.begin(), results.begin() + adaptive}, 2),
                          curve_of("as many everywhere", bake,
                                   {results.begin() + adaptive, results.end()}, 2)}};
    Chart thresholds{.id = "threshold",
                     .title = "Error by threshold",
                     .x_label = "limit of the angle between the first rays, degrees",
                     .y_label = "RMS error, degrees",
                     .curves = {{.method = "more where they differ"}}};
    for (std::ptrdiff_t i = adaptive - 1; i >= 0; --i) {
        const auto at = static_cast<std::size_t>(i);
        thresholds.curves.front().points.push_back(
            {*ways[at].sample_degrees, curve_error(results[at].trial.errors[2])});
    }
    experiment.charts = {std::move(rays), std::move(thresholds)};
    const std::array maps = {BakedMap{ways.front(), {.bits = 32}}, BakedMap{ways[2], {.bits = 32}},
                             BakedMap{ways.back(), {.bits = 32}}};
    add_error_maps(bake, maps, 0.5, experiment);
    const BakeWayResult& chosen = results[2];
    experiment.finding = fmt::format(
        "If only texels whose first rays differ by more than {:g} degrees get all {} rays, the "
        "mean "
        "is {:.1f} rays per texel and the error is {:.4f} degrees (RMS), compared with {:.4f} with "
        "{} rays everywhere and {:.4f} with all rays everywhere.",
        *ways[2].sample_degrees, max_rays, rays_per_texel(chosen, bake), chosen.trial.errors[2].rms,
        results[results.size() - 2].trial.errors[2].rms, max_rays / 4,
        results.back().trial.errors[2].rms);
    return experiment;
}

}  // namespace

std::vector<Experiment> bake_experiments(const RunOptions& options) {
    const std::shared_ptr<const BumpyBake> bake = computed_once(options, "bake", [&] {
        return std::make_shared<const BumpyBake>(options.is_quick ? 120 : 200,
                                                 options.is_quick ? 128 : 256);
    });
    const std::vector<PlannedExperiment> plan = {
        {"Baked normals: rays and bits", [&] { return by_samples(*bake, options); }},
        {"Baked normals: rays where they are needed",
         [&] { return by_threshold(*bake, options); }}};
    return run_planned(plan, options);
}

}  // namespace relief
