// SPDX-License-Identifier: Apache-2.0
// Effects priced by drawing with and without them in turns, and dropped by what an eye would miss
// for each millisecond. Milliseconds of wall clock; what drawing throws passes. Findings of these
// drawings are those of the plan itself, and not told again.
// Tests: tests/shade/render/effect_costs_test.cpp.
#include "relief/shade/effect_costs.h"

#include <algorithm>
#include <array>

#include "relief/shade/effect_forcing.h"

namespace relief {

namespace {

FramePlan without(const MeasuredFrame& frame, const FramePlan& plan,
                  const std::vector<std::string>& effects) {
    EffectWishes wishes;
    for (const std::string& effect : effects)
        wishes.forced.push_back({effect, false});
    return force_effects(frame.scene, frame.settings, plan, wishes);
}

/// Two plans drawn in turns: what frames took, and a picture of each.
struct Pair {
    std::vector<FrameSeries> series;
    std::array<Image, 2> images;
};

Pair draw_pair(const MeasuredFrame& frame, const FramePlan& first, const FramePlan& second) {
    Report told_already;
    Renderer a(frame.context, frame.scene, first, frame.settings, told_already);
    Renderer b(frame.context, frame.scene, second, frame.settings, told_already);
    const std::array<Renderer*, 2> both{&a, &b};
    Pair pair;
    pair.series = time_frames(both, frame.camera, frame.repeats);
    pair.images = {a.draw(frame.camera).image, b.draw(frame.camera).image};
    return pair;
}

double seen_per_millisecond(const EffectCost& cost) {
    return cost.change.flip_mean / cost.milliseconds;
}

}  // namespace

PictureChange picture_change(const Image& with, const Image& without) {
    const ImageDifference difference = compare(with, without);
    if (difference.differing_pixels == 0) return {};
    const FlipDifference flip = flip_difference(with, without);
    return {difference.max, difference.mean, flip.mean, flip.max};
}

EffectCosts measure_effects(const MeasuredFrame& frame, const FramePlan& plan) {
    EffectCosts costs;
    std::vector<double> frames;
    for (const std::string& effect : effects_in(plan)) {
        const Pair pair = draw_pair(frame, plan, without(frame, plan, {effect}));
        const std::vector<double>& with = pair.series[0].frame;
        frames.insert(frames.end(), with.begin(), with.end());
        costs.effects.push_back({effect, median_difference(with, pair.series[1].frame),
                                 picture_change(pair.images[0], pair.images[1])});
    }
    costs.frame = spread_of(std::move(frames));
    return costs;
}

std::vector<std::string> drop_order(std::span<const EffectCost> costs, double least_saving) {
    std::vector<EffectCost> worth;
    for (const EffectCost& cost : costs) {
        if (cost.milliseconds > 0.0 && cost.milliseconds >= least_saving) worth.push_back(cost);
    }
    std::stable_sort(worth.begin(), worth.end(), [](const EffectCost& a, const EffectCost& b) {
        return seen_per_millisecond(a) < seen_per_millisecond(b);
    });
    std::vector<std::string> order;
    for (const EffectCost& cost : worth)
        order.push_back(cost.effect);
    return order;
}

BudgetChoice fit_to_budget(
    double budget, const std::vector<std::string>& order,
    const std::function<double(const std::vector<std::string>& dropped)>& frame_time) {
    BudgetChoice choice;
    choice.milliseconds = frame_time({});
    choice.fits = choice.milliseconds <= budget;
    for (auto next = order.begin(); next != order.end() && !choice.fits; ++next) {
        choice.dropped.push_back(*next);
        choice.milliseconds = frame_time(choice.dropped);
        choice.fits = choice.milliseconds <= budget;
    }
    return choice;
}

BudgetedPlan plan_within_budget(const MeasuredFrame& frame, const FramePlan& plan, double budget) {
    BudgetedPlan result;
    Report told_already;
    Renderer whole(frame.context, frame.scene, plan, frame.settings, told_already);
    const auto frame_time = [&](const std::vector<std::string>& dropped) {
        Renderer less(frame.context, frame.scene, without(frame, plan, dropped), frame.settings,
                      told_already);
        const std::array<Renderer*, 1> alone{&less};
        return spread_of(time_frames(alone, frame.camera, frame.repeats)[0].frame).median;
    };
    result.milliseconds_before = frame_time({});
    if (result.milliseconds_before <= budget) {
        result.plan = plan;
        result.choice = {{}, result.milliseconds_before, true};
        return result;
    }
    // Less than a hundredth of the frame is not told from noise.
    constexpr double told_from_noise = 0.01;
    const EffectCosts costs = measure_effects(frame, plan);
    const std::vector<std::string> order =
        drop_order(costs.effects, told_from_noise * costs.frame.median);
    result.choice = fit_to_budget(budget, order, frame_time);
    result.plan = without(frame, plan, result.choice.dropped);
    Renderer less(frame.context, frame.scene, result.plan, frame.settings, told_already);
    result.change = picture_change(whole.draw(frame.camera).image, less.draw(frame.camera).image);
    return result;
}

}  // namespace relief
