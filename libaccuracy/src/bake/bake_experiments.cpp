// SPDX-License-Identifier: Apache-2.0
// Tests: tests/accuracy/bake_experiments_test.cpp.
#include "bake/bake_experiments.h"

#include <fmt/format.h>

#include <array>
#include <memory>

#include "analytic_words.h"
#include "bake/baked_pictures.h"
#include "bake/bumpy_bake.h"
#include "measured_methods.h"
#include "planned_experiment.h"
#include "relief/accuracy/passes.h"

namespace relief {
namespace {

double rays_a_texel(const BakeWayFound& found, const BumpyBake& bake) {
    return static_cast<double>(found.trial.rays) / bake.texels();
}

Cost cost_of(const BakeWayFound& found, std::size_t format) {
    Cost cost{.stored_bytes = 3.0 * BumpyBake::formats()[format].bits / 8.0};
    if (found.one_thread.empty()) return cost;
    cost.one_thread = found.one_thread[format];
    cost.all_threads = found.all_threads[format];
    return cost;
}

/// What all bakes have in common, and a measurement of each way in each of these formats.
Experiment measured(const BumpyBake& bake, std::span<const BakeWay> ways,
                    const std::vector<BakeWayFound>& found, std::span<const std::size_t> formats) {
    Experiment experiment{
        .subject = Subject::bake,
        .truth = fmt::format(
            "the mean of {} rays a texel, not rounded to codes; a test holds bakes to the formula "
            "of the surface, without the baker's rays",
            bake.trials().reference_samples()),
        .input = bake.words(),
        .error_unit = "degrees",
        .item = "texel",
        .items = bake.texels()};
    for (std::size_t i = 0; i < ways.size(); ++i) {
        for (const std::size_t format : formats) {
            const NormalMapFormat& depth = BumpyBake::formats()[format];
            experiment.measurements.push_back(
                {.method = fmt::format("{}, {}", words_of(ways[i]), depth_words(depth.bits)),
                 .choices = {{"rays", words_of(ways[i])}, {"depth", depth_words(depth.bits)}},
                 .error = figures_of(found[i].trial.errors[format]),
                 .cost = cost_of(found[i], format),
                 .note = fmt::format("{:.2f} rays a texel.", rays_a_texel(found[i], bake))});
        }
    }
    mark_efficient(experiment);
    return experiment;
}

Curve curve_of(const std::string& name, const BumpyBake& bake, std::span<const BakeWayFound> found,
               std::size_t format) {
    Curve curve{.method = name};
    for (const BakeWayFound& one : found)
        curve.points.push_back(
            {rays_a_texel(one, bake), curve_error(figures_of(one.trial.errors[format]))});
    return curve;
}

/// "12 million rays a second on one thread, 23 on all", of a map of floats, which take no codes to
/// speak of; empty where nothing was timed.
std::string speed_of(const BakeWayFound& found) {
    if (found.one_thread.empty()) return {};
    const auto millions = [&](const Timing& timing) {
        return 1e-6 * static_cast<double>(found.trial.rays) / timing.spread().median;
    };
    return fmt::format(" It cast {:.2g} million rays a second on one thread, {:.2g} on all.",
                       millions(found.one_thread.back()), millions(found.all_threads.back()));
}

Experiment by_samples(const BumpyBake& bake, const RunOptions& options) {
    std::vector<BakeWay> ways = {{1}, {4}, {16}};
    if (!options.is_quick) ways.push_back({64});
    const std::vector<BakeWayFound> found = bake.measured(ways, options);
    constexpr std::array<std::size_t, 3> formats = {0, 1, 2};
    Experiment experiment = measured(bake, ways, found, formats);
    experiment.id = "bake/samples";
    experiment.question = "How many rays does a texel need, and how many bits?";
    Chart chart{.id = "rays",
                .title = "Error by rays",
                .x_label = "rays a texel",
                .y_label = "RMS error, degrees"};
    for (const std::size_t format : formats)
        chart.curves.push_back(
            curve_of(depth_words(BumpyBake::formats()[format].bits), bake, found, format));
    // The middles of equal squares: half as far apart, a quarter of the error.
    chart.curves.back() =
        fitted_curve(chart.curves.back().method, chart.curves.back().points, -1.0);
    experiment.charts = {std::move(chart)};
    const std::array maps = {BakedMap{ways.front(), {.bits = 8}}, BakedMap{ways[2], {.bits = 8}},
                             BakedMap{ways[2], {.bits = 16}}};
    add_error_maps(bake, maps, 2.0, experiment);
    add_renderings(bake, std::span(maps).first(2), experiment);
    const auto rms = [&](std::size_t way, std::size_t format) {
        return found[way].trial.errors[format].rms;
    };
    const std::size_t last = ways.size() - 1;
    experiment.finding = fmt::format(
        "{} a texel leaves {:.3f} degrees (RMS), {} {:.3f} and {} {:.4f}, if the map is not "
        "rounded. 8 bits alone are {:.3f} off, 16 bits {:.4f}: with {} the former make {:.3f}, the "
        "latter {:.4f}.{}",
        words_of(ways[0]), rms(0, 2), words_of(ways[1]), rms(1, 2), words_of(ways[last]),
        rms(last, 2), found[0].trial.quantisation[0].rms, found[0].trial.quantisation[1].rms,
        words_of(ways[last]), rms(last, 0), rms(last, 1), speed_of(found[last]));
    return experiment;
}

Experiment by_threshold(const BumpyBake& bake, const RunOptions& options) {
    const int most = options.is_quick ? 16 : 64;
    std::vector<BakeWay> ways;
    for (const double degrees : {16.0, 8.0, 4.0, 2.0, 1.0, 0.5})
        ways.push_back({most, degrees});
    const auto adaptive = static_cast<std::ptrdiff_t>(ways.size());
    ways.push_back({most / 4});
    ways.push_back({most});
    const std::vector<BakeWayFound> found = bake.measured(ways, options);
    constexpr std::array<std::size_t, 1> formats = {2};
    Experiment experiment = measured(bake, ways, found, formats);
    experiment.id = "bake/adaptive";
    experiment.question = "Does it pay to cast more rays only where the first differ?";
    Chart rays{
        .id = "rays",
        .title = "Error by rays",
        .x_label = "rays a texel",
        .y_label = "RMS error, degrees",
        .curves = {
            curve_of("more where they differ", bake, {found.begin(), found.begin() + adaptive}, 2),
            curve_of("as many everywhere", bake, {found.begin() + adaptive, found.end()}, 2)}};
    Chart thresholds{.id = "threshold",
                     .title = "Error by threshold",
                     .x_label = "degrees that the first rays may differ by",
                     .y_label = "RMS error, degrees",
                     .curves = {{.method = "more where they differ"}}};
    for (std::ptrdiff_t i = adaptive - 1; i >= 0; --i) {
        const auto at = static_cast<std::size_t>(i);
        thresholds.curves.front().points.push_back(
            {*ways[at].sample_degrees, curve_error(figures_of(found[at].trial.errors[2]))});
    }
    experiment.charts = {std::move(rays), std::move(thresholds)};
    const std::array maps = {BakedMap{ways.front(), {.bits = 32}}, BakedMap{ways[2], {.bits = 32}},
                             BakedMap{ways.back(), {.bits = 32}}};
    add_error_maps(bake, maps, 0.5, experiment);
    const BakeWayFound& chosen = found[2];
    experiment.finding = fmt::format(
        "Where only texels whose first rays differ by more than {:g} degrees get all {}, a texel "
        "takes {:.1f} rays and the error is {:.4f} degrees (RMS), against {:.4f} with {} "
        "everywhere and {:.4f} with all.",
        *ways[2].sample_degrees, most, rays_a_texel(chosen, bake), chosen.trial.errors[2].rms,
        found[found.size() - 2].trial.errors[2].rms, most / 4, found.back().trial.errors[2].rms);
    return experiment;
}

}  // namespace

std::vector<Experiment> bake_experiments(const RunOptions& options) {
    const std::shared_ptr<const BumpyBake> bake = made_once(options, [&] {
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
