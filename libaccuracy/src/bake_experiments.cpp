// SPDX-License-Identifier: Apache-2.0
// Bakes a sphere with bumps onto a coarse sphere. The ground truth of a texel is the mean of many
// rays.
#include "experiment_parts.h"

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
#include "portable_math.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/mesh.h"
#include "rendered_methods.h"

namespace relief::accuracy::detail {
using namespace relief::detail;

namespace {

constexpr double bump_height = 0.02;
constexpr double waves_around = 12.0;

struct SphereAngles {
    double longitude = 0.0;  ///< From +z towards +x.
    double polar = 0.0;      ///< From +y.
};

using relief::accuracy::detail::angles_of;

SphereAngles angles_of(const glm::dvec3& p) {
    return {portable::atan2(p.x, p.z), portable::atan2(std::sqrt(p.x * p.x + p.z * p.z), p.y)};
}

double radius_at(const SphereAngles& a) {
    return 1.0 + bump_height * portable::sin(waves_around * a.longitude) *
                     portable::sin(waves_around * a.polar);
}

glm::dvec3 direction_at(const SphereAngles& a) {
    return {portable::sin(a.polar) * portable::sin(a.longitude), portable::cos(a.polar),
            portable::sin(a.polar) * portable::cos(a.longitude)};
}

/// Normalizes the gradient of |p| - radius: outward - d radius / d polar * p_polar
/// - d radius / d longitude / sin polar * p_longitude, divided by the radius.
glm::dvec3 normal_at(const SphereAngles& a) {
    const double sine = std::max(portable::sin(a.polar), 1e-9);
    const glm::dvec3 polar_wards(portable::cos(a.polar) * portable::sin(a.longitude),
                                 -portable::sin(a.polar),
                                 portable::cos(a.polar) * portable::cos(a.longitude));
    const glm::dvec3 east(portable::cos(a.longitude), 0.0, -portable::sin(a.longitude));
    const double by_polar = bump_height * waves_around * portable::sin(waves_around * a.longitude) *
                            portable::cos(waves_around * a.polar);
    const double by_longitude = bump_height * waves_around *
                                portable::cos(waves_around * a.longitude) *
                                portable::sin(waves_around * a.polar);
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

ExactPoint BumpySphere::on_surface(const glm::dvec3& from, const glm::dvec3& inward) {
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

ExactPoint BumpySphere::on_mesh(const glm::dvec3& from, const glm::dvec3& inward) const {
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

BakeMapOptions square_options(int side) {
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
      map_(square_options(side)),
      reference_(baker_, map_, static_cast<std::size_t>(side) * static_cast<std::size_t>(side)) {}

std::string BumpyBake::description() const {
    return fmt::format("sphere with bumps, {} triangles, for one of {}; map of {} x {} texels",
                       high_.mesh().triangles.size(), baker_.low().triangles.size(), map_.width,
                       map_.height);
}

WholeBake whole_bake(const Baker& baker, const BakeMapOptions& map) {
    WholeBake whole{make_image(map.width, map.height, 3, 32, ColorSpace::data)};
    std::span<float> rest = whole.normals.as<float>();
    Report ignored;
    const BakeResult result = baker.bake(
        map,
        [&](const BakedRows& rows) {
            std::copy(rows.normals.begin(), rows.normals.end(), rest.begin());
            rest = rest.subspan(rows.normals.size());
        },
        ignored);
    whole.rays = result.rays;
    return whole;
}

Image BumpyBake::map_by(const BakeSampling& way, const NormalMapFormat& format) const {
    BakeMapOptions map = map_;
    map.samples = way.samples;
    if (way.sample_degrees) map.sample_angle = glm::radians(*way.sample_degrees);
    return encode_normal_map(whole_bake(baker_, map).normals, format);
}

namespace {

/// One finished map.
struct BakedMap {
    BakeSampling way;
    NormalMapFormat format;
};

constexpr int picture_side = 320;
constexpr int picture_rays_per_side = 2;

using relief::accuracy::detail::name_of;

std::string name_of(const BakedMap& map) {
    return fmt::format("{}, {}", name_of(map.way), depth_name(map.format.bits));
}

Image picture_of(const shade::Scene& scene) {
    return supersampled_reference(scene, picture_side, picture_rays_per_side);
}

/// Adds a heat map of the errors of each map. \param brightest  degrees shown at full brightness
void add_error_maps(const BumpyBake& bake, std::span<const BakedMap> maps, double brightest,
                    Experiment& experiment) {
    for (const BakedMap& map : maps) {
        experiment.heat_maps.push_back({"Error of the map", name_of(map),
                                        bake_error_map(bake.reference(), map.way, map.format),
                                        brightest});
    }
}

/// Adds an image pair per map: the low mesh with the map, and the high mesh. The CPU reference
/// shader renders both, so OpenGL is not needed.
void add_renderings(const BumpyBake& bake, std::span<const BakedMap> maps, Experiment& experiment) {
    const shade::Scene high = lit_scene(bake.high().mesh(), glossy_plastic());
    const Image ground_truth = picture_of(high);
    for (const BakedMap& map : maps) {
        shade::Scene low =
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

/// The sphere with bumps, and its bakes.
struct BumpyBakes {
    std::shared_ptr<const BumpyBake> bake;
    std::shared_ptr<TimedBakes> timed;

    BumpyBakes(const std::shared_ptr<const BumpyBake>& one, std::span<const BakeSampling> ways,
               std::vector<NormalMapFormat> formats)
        : bake(one),
          timed(std::make_shared<TimedBakes>(
              std::shared_ptr<const BakeReference>(one, &one->reference()), ways,
              std::move(formats))) {}

    [[nodiscard]] double rays_per_texel(std::size_t way) const {
        return static_cast<double>(timed->result(way).front().rays) /
               static_cast<double>(timed->reference().texels());
    }

    /// The error of ways first to last (excluded) over their rays.
    [[nodiscard]] Curve curve(const std::string& name, std::size_t first, std::size_t last,
                              std::size_t format) const {
        Curve curve{.method = name};
        for (std::size_t way = first; way < last; ++way)
            curve.points.push_back(
                {rays_per_texel(way), curve_error(timed->result(way)[format].error)});
        return curve;
    }
};

/// The common part of both experiments.
PreparedExperiment on_bakes(const BumpyBakes& bakes) {
    PreparedExperiment prepared;
    prepared.report = {
        .ground_truth = fmt::format(
            "The mean of {} rays per texel, not rounded to codes. A test verifies bakes by the "
            "formula of the surface, without the baker's rays.",
            bakes.timed->reference().samples()),
        .input = bakes.bake->description(),
        .error_unit = "degrees",
        .item = "texel",
        .items = static_cast<double>(bakes.timed->reference().texels())};
    prepared.costs.memory = false;
    prepared.methods =
        methods_of(bakes.timed, [](const BakeSampling& way, const NormalMapFormat& format) {
            return Method{.name = name_of(BakedMap{way, format}),
                          .choices = {{"rays", name_of(way)}, {"depth", depth_name(format.bits)}},
                          .stored_bytes = 3.0 * format.bits / 8.0};
        });
    for (std::size_t i = 0; i < prepared.methods.size(); ++i) {
        Method& method = prepared.methods[i];
        method.error = [bakes, i, error = method.error] {
            const std::size_t way = i / bakes.timed->formats().size();
            return MethodError(error().stats,
                               fmt::format("{:.2f} rays per texel.", bakes.rays_per_texel(way)));
        };
    }
    return prepared;
}

void finish_samples(const BumpyBakes& bakes, Experiment& report) {
    const std::vector<BakeSampling>& ways = bakes.timed->samplings();
    const std::vector<NormalMapFormat>& formats = bakes.timed->formats();
    Chart chart{.id = "rays",
                .title = "Error by rays",
                .x_label = "rays per texel",
                .y_label = "RMS error, degrees"};
    for (std::size_t format = 0; format < formats.size(); ++format)
        chart.curves.push_back(
            bakes.curve(depth_name(formats[format].bits), 0, ways.size(), format));
    // Sample points are the centers of equal squares: halving their distance quarters the error.
    fit(chart.curves.back(), -1.0);
    report.charts = {std::move(chart)};
    const std::array maps = {BakedMap{ways.front(), {.bits = 8}}, BakedMap{ways[2], {.bits = 8}},
                             BakedMap{ways[2], {.bits = 16}}};
    add_error_maps(*bakes.bake, maps, 2.0, report);
    add_renderings(*bakes.bake, std::span(maps).first(2), report);
}

PreparedExperiment by_samples(const std::shared_ptr<const BumpyBake>& bake,
                              const PlanOptions& options) {
    std::vector<BakeSampling> ways = {{1}, {4}, {16}};
    if (!options.is_quick) ways.push_back({64});
    const BumpyBakes bakes(bake, ways, {{.bits = 8}, {.bits = 16}, {.bits = 32}});
    PreparedExperiment prepared = on_bakes(bakes);
    prepared.report.question = "How many rays does a texel need, and how many bits?";
    prepared.compared = names_of(prepared.methods);
    prepared.finish = [bakes](Experiment& report) { finish_samples(bakes, report); };
    return prepared;
}

constexpr std::array thresholds_in_degrees = {16.0, 8.0, 4.0, 2.0, 1.0, 0.5};

/// The ways are one per threshold, a quarter of the rays everywhere, and all rays everywhere.
void finish_thresholds(const BumpyBakes& bakes, Experiment& report) {
    const std::vector<BakeSampling>& ways = bakes.timed->samplings();
    const std::size_t adaptive = thresholds_in_degrees.size();
    Chart rays{.id = "rays",
               .title = "Error by rays",
               .x_label = "rays per texel",
               .y_label = "RMS error, degrees",
               .curves = {bakes.curve("more where they differ", 0, adaptive, 0),
                          bakes.curve("as many everywhere", adaptive, ways.size(), 0)}};
    Chart thresholds{.id = "threshold",
                     .title = "Error by threshold",
                     .x_label = "limit of the angle between the first rays, degrees",
                     .y_label = "RMS error, degrees",
                     .curves = {{.method = "more where they differ"}}};
    for (std::size_t i = adaptive; i-- > 0;)
        thresholds.curves.front().points.push_back(
            {thresholds_in_degrees.at(i), rays.curves.front().points[i].error});
    report.charts = {std::move(rays), std::move(thresholds)};
    const std::array maps = {BakedMap{ways.front(), {.bits = 32}}, BakedMap{ways[2], {.bits = 32}},
                             BakedMap{ways.back(), {.bits = 32}}};
    add_error_maps(*bakes.bake, maps, 0.5, report);
}

PreparedExperiment by_threshold(const std::shared_ptr<const BumpyBake>& bake,
                                const PlanOptions& options) {
    const int max_rays = options.is_quick ? 16 : 64;
    std::vector<BakeSampling> ways;
    for (const double degrees : thresholds_in_degrees)
        ways.push_back({max_rays, degrees});
    ways.push_back({max_rays / 4});
    ways.push_back({max_rays});
    const BumpyBakes bakes(bake, ways, {{.bits = 32}});
    PreparedExperiment prepared = on_bakes(bakes);
    prepared.report.question = "Does it pay to cast more rays only where the first rays differ?";
    prepared.compared = {prepared.methods[2].name, prepared.methods[6].name,
                         prepared.methods[7].name};
    prepared.finish = [bakes](Experiment& report) { finish_thresholds(bakes, report); };
    return prepared;
}

}  // namespace

std::vector<PlannedExperiment> bake_plan(const PlanOptions& options) {
    const SharedInput<BumpyBake> bake([is_quick = options.is_quick] {
        return std::make_shared<const BumpyBake>(is_quick ? 120 : 200, is_quick ? 128 : 256);
    });
    return {{"bake/samples", "Baked normals: rays and bits",
             [bake](const PlanOptions& all) { return by_samples(bake.get(), all); }},
            {"bake/adaptive", "Baked normals: rays where they are needed",
             [bake](const PlanOptions& all) { return by_threshold(bake.get(), all); }}};
}

}  // namespace relief::accuracy::detail
