// SPDX-License-Identifier: Apache-2.0
// Intersects rays of view with height maps by the methods of relief mapping, and measures how far
// their points are from the first intersection, in texels along the map.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "asset_report.h"
#include "experiment_parts.h"
#include "portable_math.h"
#include "relief/mesh/height_march.h"
#include "relief_parts.h"
#include "samples.h"

namespace relief::accuracy {
using namespace relief::accuracy::detail;

namespace detail {

namespace {

namespace portable = relief::detail::portable;
using relief::detail::Random;

/// A pixel is a miss if its point is farther than this from the first intersection, in texels.
constexpr double miss_distance = 1.0;

/// Cone maps of larger height maps of a user would take longer than everything else.
constexpr int max_texels_of_cones = 1 << 20;

Image heights_over_square(int side, const std::function<double(double u, double v)>& height) {
    Image image = make_image(side, side, 1, 16, ColorSpace::data);
    const auto samples = image.as<std::uint16_t>();
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            const double h = std::clamp(height((x + 0.5) / side, (y + 0.5) / side), 0.0, 1.0);
            samples[static_cast<std::size_t>(y) * static_cast<std::size_t>(side) +
                    static_cast<std::size_t>(x)] = static_cast<std::uint16_t>(h * 65535.0 + 0.5);
        }
    }
    return image;
}

Image fractal_heights(int side) {
    return heights_over_square(side, [](double u, double v) {
        return 0.5 + 0.45 * sample::tiling_octaves(u, v, 4, 4, 7);
    });
}

Image wave_map(int side) {
    return heights_over_square(side, [](double u, double v) {
        constexpr double turn = 2.0 * std::numbers::pi;
        return 0.5 + 0.2 * portable::sin(turn * (3.0 * u + v)) +
               0.15 * portable::cos(turn * (5.0 * v - 2.0 * u)) +
               0.1 * portable::sin(turn * 4.0 * u);
    });
}

/// Poles of two texels at distances of 32 texels.
Image pole_heights(int side) {
    return heights_over_square(side, [side](double u, double v) {
        const auto is_pole = [side](double at) { return static_cast<int>(at * side) % 32 < 2; };
        return is_pole(u) && is_pole(v) ? 1.0 : 0.2;
    });
}

constexpr std::array relief_maps = {
    ReliefSample{"bricks", "the wall of bricks of data/bricks-height.png", 12.0,
                 sample::brick_heights},
    ReliefSample{"fractal", "smooth noise of four octaves", 24.0, fractal_heights},
    ReliefSample{"poles", "poles of 2 x 2 texels, 32 texels apart", 16.0, pole_heights},
    ReliefSample{"waves", "a sum of waves", 16.0, wave_map}};

std::shared_ptr<const ReliefFields> fields_of(const ReliefSample& map, int side) {
    const HeightField heights(map.heights(side), Wrap::repeat);
    const HeightField cones(channel_of(relaxed_cones(heights), 1), Wrap::repeat);
    return std::make_shared<const ReliefFields>(ReliefFields{heights, cones});
}

ReliefInput relief_input(std::shared_ptr<const ReliefFields> fields, double depth,
                         const ViewBand& band, std::size_t count) {
    ReliefInput input{std::move(fields), {}, {}, {}};
    Random random(52);
    for (std::size_t i = 0; i < count; ++i) {
        HeightRay ray;
        ray.texcoord = {random.between(0.0, 1.0), random.between(0.0, 1.0)};
        const double angle = random.between(band.from, band.to) * std::numbers::pi / 180.0;
        const double azimuth = random.between(0.0, 2.0 * std::numbers::pi);
        const double slant = portable::tan(angle);
        ray.direction = {slant * portable::cos(azimuth), slant * portable::sin(azimuth), 1.0};
        ray.black_depth = depth;
        input.rays.push_back(ray);
        input.exact.push_back(input.fields->heights.first_hit(ray));
    }
    return input;
}

const ReliefMethod& method_named(const std::vector<ReliefMethod>& methods,
                                 const std::string& name) {
    return *std::find_if(methods.begin(), methods.end(),
                         [&](const ReliefMethod& one) { return one.name == name; });
}

}  // namespace

std::vector<ReliefMethod> relief_methods(bool on_curves) {
    constexpr double heights = 2.0;
    std::vector<ReliefMethod> methods{{"normal map", std::nullopt, 0.0}};
    const auto add = [&](const std::string& settings, HeightMethod method, int layers,
                         double bytes) {
        HeightMarch march;
        march.method = method;
        march.layers = layers;
        std::string name = enum_name(method);
        std::replace(name.begin(), name.end(), '_', ' ');
        if (!settings.empty()) name += " " + settings;
        methods.push_back({name, march, bytes});
    };
    add("", HeightMethod::parallax, 1, heights);
    for (const int layers : {8, 16, 32, 128})
        add(fmt::format("{}", layers), HeightMethod::parallax_occlusion, layers, heights);
    for (const int layers : {16, 32})
        add(fmt::format("{}+6", layers), HeightMethod::relief_mapping, layers, heights);
    for (const int layers : {16, 64})
        add(fmt::format("{}+6", layers), HeightMethod::relaxed_cones, layers, heights + 4.0);
    add("", HeightMethod::maximum_mipmaps, 1, heights * 4.0 / 3.0);
    if (!on_curves) return methods;
    for (const char* const name : {"parallax occlusion 16", "maximum mipmaps"}) {
        ReliefMethod curved = method_named(methods, name);
        curved.name += " curved";
        curved.is_curved = true;
        methods.push_back(curved);
    }
    return methods;
}

namespace {

HeightHit hit_by(const ReliefMethod& method, const ReliefInput& input, std::size_t i) {
    const ReliefFields& fields = *input.fields;
    const HeightRay& ray = method.is_curved ? input.curved[i] : input.rays[i];
    if (method.march) return fields.heights.march(ray, *method.march, &fields.cones);
    HeightHit hit;
    hit.texcoord = ray.texcoord;
    hit.slope = ray.black_depth * fields.heights.slope(ray.texcoord);
    return hit;
}

/// The errors of a method over all rays.
struct ReliefErrors {
    ErrorStats texels;
    double rms_degrees = 0.0;
    double misses = 0.0;        ///< Fraction of the rays.
    double miss_squares = 0.0;  ///< The fraction of the squared errors that is that of misses.
    double lookups = 0.0;       ///< Mean.
    std::size_t exceeded = 0;   ///< Rays beyond the bound on steps.
};

/// Returns a squared distance, which is 0 below a billionth: that is the rounding of coordinates.
double without_rounding(double square) {
    constexpr double rounding = 1e-9;
    return square < rounding * rounding ? 0.0 : square;
}

ReliefErrors errors_of(const ReliefMethod& method, const ReliefInput& input) {
    ReliefErrors errors;
    std::vector<float> distances;
    double squares = 0.0;
    double squares_of_misses = 0.0;
    double squared_degrees = 0.0;
    std::size_t misses = 0;
    const glm::dvec2 size(input.fields->heights.size());
    for (std::size_t i = 0; i < input.rays.size(); ++i) {
        const HeightHit hit = hit_by(method, input, i);
        const HeightHit& exact = input.exact[i];
        const glm::dvec2 aside = (hit.texcoord - exact.texcoord) * size;
        const double square = without_rounding(glm::dot(aside, aside));
        const double degrees =
            degrees_between(glm::dvec3(-hit.slope, 1.0), glm::dvec3(-exact.slope, 1.0));
        distances.push_back(static_cast<float>(std::sqrt(square)));
        squares += square;
        squared_degrees += without_rounding(degrees * degrees);
        errors.lookups += hit.lookups;
        errors.exceeded += hit.end == HeightRayEnd::exceeded ? 1 : 0;
        if (square <= miss_distance * miss_distance) continue;
        ++misses;
        squares_of_misses += square;
    }
    const auto count = static_cast<double>(input.rays.size());
    errors.texels = error_stats(std::move(distances));
    errors.rms_degrees = std::sqrt(squared_degrees / count);
    errors.misses = static_cast<double>(misses) / count;
    errors.miss_squares = squares > 0.0 ? squares_of_misses / squares : 0.0;
    errors.lookups /= count;
    return errors;
}

std::string note_of(const ReliefErrors& errors) {
    std::string note = fmt::format("{:.3g} % misses, {:.3g} degrees RMS, {:.1f} lookups",
                                   100.0 * errors.misses, errors.rms_degrees, errors.lookups);
    if (errors.exceeded > 0) note += fmt::format(", {} rays beyond the steps", errors.exceeded);
    return note;
}

/// States what the misses mean for the choice of a method, or what no method can reduce.
std::string relief_finding(const ReliefInput& input) {
    const std::vector<ReliefMethod> methods = relief_methods(!input.curved.empty());
    const auto errors = [&](const char* name) {
        return errors_of(method_named(methods, name), input);
    };
    const ReliefErrors exact = errors("maximum mipmaps");
    const ReliefErrors layers = errors("relief mapping 16+6");
    const ReliefErrors more = errors("parallax occlusion 128");
    const std::string lookups =
        fmt::format(", with {:.1f} lookups, {:.2g} times those of 'parallax occlusion 128', which",
                    exact.lookups, exact.lookups / more.lookups);
    if (exact.texels.max > 0.0) {
        std::string text = fmt::format(
            "The curvature, which the plane of a triangle does not have, limits all methods: "
            "'maximum mipmaps', exact on the plane, has an RMS error of {:.2g} texels and misses "
            "{:.2g} % of the rays{} misses {:.2g} %. 'parallax occlusion 16' has {:.2g} texels.",
            exact.texels.rms, 100.0 * exact.misses, lookups, 100.0 * more.misses,
            errors("parallax occlusion 16").texels.rms);
        if (input.curved.empty()) return text;
        const ReliefErrors curved = errors("maximum mipmaps curved");
        const ReliefErrors layers_curved = errors("parallax occlusion 16 curved");
        return text + fmt::format(
                          " With the curvature, 'maximum mipmaps curved' has {:.2g} texels and "
                          "misses {:.2g} %, 'parallax occlusion 16 curved' {:.2g} texels and "
                          "{:.2g} %.",
                          curved.texels.rms, 100.0 * curved.misses, layers_curved.texels.rms,
                          100.0 * layers_curved.misses);
    }
    std::string text = fmt::format(
        "'maximum mipmaps' is exact to rounding for every ray{} misses {:.2g} % of the "
        "rays.",
        lookups, 100.0 * more.misses);
    if (layers.misses > 0.0) {
        text += fmt::format(
            " Misses are {:.2g} % of the rays of 'relief mapping 16+6', but {:.0f} % of its "
            "squared error, which more bisections do not reduce; 'relaxed cones 16+6' ends before "
            "the surface on {:.2g} %.",
            100.0 * layers.misses, 100.0 * layers.miss_squares,
            100.0 * errors("relaxed cones 16+6").misses);
    }
    return text;
}

/// The error over the angle of view.
Chart angle_chart(const std::function<ReliefInput(const ViewBand& band)>& input_of) {
    std::vector<ReliefMethod> methods = relief_methods(false);
    std::erase_if(methods, [](const ReliefMethod& one) {
        return one.name.ends_with(" 8") || one.name.ends_with(" 32");
    });
    std::vector<std::string> names;
    for (const ReliefMethod& one : methods)
        names.push_back(one.name);
    Chart chart{.id = "angles",
                .title = "Slanted views",
                .x_label = "degrees from the normal",
                .y_label = "RMS error, texels",
                .is_x_log = false};
    return chart_over(
        std::move(chart), names, {10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0, 85.0},
        [&](double angle) {
            return input_of({angle, angle});
        },
        [&](std::size_t i, const ReliefInput& input) {
            return errors_of(methods[i], input).texels.rms;
        });
}

}  // namespace

PreparedExperiment relief_of(const std::string& ground_truth, const std::string& description,
                             const std::shared_ptr<const ReliefInput>& input) {
    PreparedExperiment prepared;
    prepared.report = {.question = "Which method finds where a ray of view meets the heights?",
                       .ground_truth = ground_truth,
                       .input = description,
                       .error_unit = "texels",
                       .item = "ray",
                       .items = static_cast<double>(input->rays.size())};
    for (const ReliefMethod& method : relief_methods(!input->curved.empty())) {
        prepared.methods.push_back({.name = method.name,
                                    .choices = {{"method", method.name}},
                                    .error =
                                        [method, input] {
                                            const ReliefErrors errors = errors_of(method, *input);
                                            return MethodError(errors.texels, note_of(errors));
                                        },
                                    .work =
                                        [method, input] {
                                            double sum = 0.0;
                                            for (std::size_t i = 0; i < input->rays.size(); ++i)
                                                sum += hit_by(method, *input, i).depth;
                                            volatile double result = sum;
                                            (void)result;
                                        },
                                    .stored_bytes = method.bytes});
    }
    prepared.costs.all_threads = false;
    prepared.costs.memory = false;
    prepared.finish = [input](Experiment& report) { report.finding = relief_finding(*input); };
    return prepared;
}

std::string name_of(const ViewBand& band) {
    return fmt::format("{:g}-{:g}", band.from, band.to);
}

namespace {

PreparedExperiment plane_experiment(const ReliefSample& map, const ViewBand& band,
                                    const SharedInput<ReliefFields>& shared, bool is_quick) {
    const std::shared_ptr<const ReliefFields> fields = shared.get();
    const auto input_of = [fields, &map](const ViewBand& one, std::size_t rays) {
        return relief_input(fields, map.depth, one, rays);
    };
    const int side = fields->heights.size().x;
    PreparedExperiment prepared = relief_of(
        "The first intersection with the bilinear patches between texels, from the roots of their "
        "quadratics in double precision. Tests compare it with the displaced mesh of a quad per "
        "texel, which other code intersects.",
        fmt::format("{}, {} x {} texels, {:g} deep, on a plane; {:g} to {:g} degrees from its "
                    "normal",
                    map.description, side, side, map.depth, band.from, band.to),
        std::make_shared<const ReliefInput>(input_of(band, is_quick ? 2'000 : 60'000)));
    if (band.from != 45.0) return prepared;
    prepared.finish = [input_of, is_quick, finish = prepared.finish](Experiment& report) {
        finish(report);
        report.charts = {
            angle_chart([&](const ViewBand& at) { return input_of(at, is_quick ? 500 : 10'000); })};
    };
    return prepared;
}

}  // namespace

std::vector<PlannedExperiment> relief_plan(const PlanOptions& options) {
    const int side = options.is_quick ? 128 : 256;
    std::vector<PlannedExperiment> plan;
    const auto add = [&](const std::string& id, const std::string& title, const auto& prepare) {
        plan.push_back({"relief/" + id, "Relief mapping: " + title, prepare});
    };
    const auto fields_of_map = [side](const ReliefSample& map) {
        return SharedInput<ReliefFields>([&map, side] { return fields_of(map, side); });
    };
    for (const ReliefSample& map : relief_maps) {
        const SharedInput<ReliefFields> fields = fields_of_map(map);
        for (const ViewBand& band : view_bands) {
            add(fmt::format("{}-{}", map.id, name_of(band)),
                fmt::format("{}, {:g} to {:g} degrees", map.id, band.from, band.to),
                [=, &map](const PlanOptions& all) {
                    return plane_experiment(map, band, fields, all.is_quick);
                });
        }
    }
    const ReliefSample& bricks = relief_maps.front();
    for (PlannedExperiment& planned : curved_relief_plan(bricks, fields_of_map(bricks)))
        plan.push_back(std::move(planned));
    return plan;
}

}  // namespace detail

AssetExperiment measure_asset_relief(const Image& heights, const Wraps& wraps, double depth,
                                     const glm::dvec2& degrees, const AssetOptions& options) {
    AssetExperiment asset = asset_experiment(Subject::relief, "relief", "Relief mapping", options);
    Report report;
    const HeightField field(heights, wraps, report);
    const bool has_cones = field.size().x * field.size().y <= max_texels_of_cones;
    const auto fields = std::make_shared<const ReliefFields>(ReliefFields{
        field, has_cones ? HeightField(channel_of(relaxed_cones(field), 1), wraps) : field});
    PreparedExperiment prepared = relief_of(
        "The first intersection with the bilinear patches between texels, in double precision.",
        fmt::format("{} x {} texels, {:g} deep, on a plane; {:g} to {:g} degrees from its normal{}",
                    field.size().x, field.size().y, depth, degrees.x, degrees.y,
                    has_cones ? "" : "; too large for a cone map"),
        std::make_shared<const ReliefInput>(relief_input(fields, depth, {degrees.x, degrees.y},
                                                         options.run.is_quick ? 2'000 : 20'000)));
    for (const ReliefMethod& method : relief_methods(false)) {
        if (!method.march) continue;
        const HeightMethod kind = method.march->method;
        std::string& command =
            std::find_if(prepared.methods.begin(), prepared.methods.end(), [&](const Method& one) {
                return one.name == method.name;
            })->command;
        command = fmt::format(
            "relief-view MODEL --height-map {} --height-depth {:g} "
            "--height-method {}",
            options.arguments, depth, enum_name(kind));
        if (kind != HeightMethod::parallax && kind != HeightMethod::maximum_mipmaps)
            command += fmt::format(" --height-layers {}", method.march->layers);
        if (kind == HeightMethod::relaxed_cones) command += " --cone-map CONES.png";
    }
    if (!has_cones) {
        std::erase_if(prepared.methods,
                      [](const Method& one) { return one.name.starts_with("relaxed"); });
    }
    Experiment& described = prepared.report;
    std::swap(described.id, asset.experiment.id);
    described.subject = asset.experiment.subject;
    described.title = asset.experiment.title;
    described.command = asset.experiment.command;
    asset.experiment = std::move(described);
    AssetOptions own = options;
    own.costs.all_threads = own.costs.memory = false;
    own.request.max_error.reset();  // A limit is in degrees.
    detail::finish(asset, prepared.methods, {.negligible_error = 0.01}, own);
    return asset;
}

}  // namespace relief::accuracy
