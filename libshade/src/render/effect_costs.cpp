// SPDX-License-Identifier: Apache-2.0
// Costs of effects, measured by interleaved drawing with and without them, and the choice of
// effects to drop by visible change per millisecond of wall-clock time. Tests:
// tests/shade/render/forced_effects_test.cpp.
#include "relief/shade/effect_costs.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "effects/features.h"
#include "relief/shade/effects.h"
#include "relief/shade/renderer.h"

namespace relief::shade {
using namespace relief::shade::detail;

namespace {

FramePlan without(const MeasuredFrame& frame, const FramePlan& plan,
                  const std::vector<std::string>& effects) {
    EffectRequest requests;
    for (const std::string& effect : effects)
        requests.forced.push_back({effect, false});
    return force_effects(frame.scene, frame.settings, plan, requests);
}

/// Returns a renderer whose findings are ignored, because the plan has reported them.
std::unique_ptr<Renderer> renderer_of(const MeasuredFrame& frame, const FramePlan& plan) {
    Report ignored;
    if (frame.cache != nullptr) {
        return std::make_unique<Renderer>(*frame.cache, frame.context, frame.scene, plan,
                                          frame.settings, ignored);
    }
    return std::make_unique<Renderer>(frame.context, frame.scene, plan, frame.settings, ignored);
}

double change_per_millisecond(const EffectCost& cost) {
    return cost.change.flip_mean / cost.milliseconds;
}

}  // namespace

PictureChange picture_change(const Image& with, const Image& without) {
    const ImageDifference difference = compare(with, without);
    if (difference.differing_pixels == 0) return {};
    const FlipDifference flip = flip_difference(with, without);
    return {difference.max, difference.mean, flip.mean, flip.max};
}

bool exceeds_noise(const EffectCost& cost, const EffectCosts& measured) {
    return std::abs(cost.milliseconds) > measured.frame.p90 - measured.frame.p10;
}

struct EffectCostMeasurement::Implementation {
    Implementation(const MeasuredFrame& measured, FramePlan whole_plan)
        : frame(measured), plan(std::move(whole_plan)), names(effects_in(plan)) {}

    MeasuredFrame frame;
    FramePlan plan;
    std::vector<std::string> names;
    std::vector<EffectCost> done;
    std::vector<double> frames;  ///< With all effects.
    std::unique_ptr<Renderer> whole;
    Image picture;  ///< With all effects.

    // The state of the effect that is being measured.
    std::unique_ptr<Renderer> less;
    std::size_t round = 0;
    std::vector<double> with, without;

    void prepare() {
        if (!whole) {
            whole = renderer_of(frame, plan);
            picture = whole->draw(frame.camera).image;
        }
        less = renderer_of(frame, relief::shade::without(frame, plan, {names[done.size()]}));
    }

    /// Draws with and without the effect, in alternating order, because pauses between rounds
    /// affect the first drawing of a pair.
    void draw_both() {
        std::array<Renderer*, 2> both{whole.get(), less.get()};
        const std::size_t first = round % 2;
        if (first == 1) std::swap(both[0], both[1]);
        const std::vector<FrameSeries> series =
            time_frames(both, frame.camera, {.counted = 1, .warm_up = 0});
        if (++round <= frame.repeats.warm_up) return;
        with.push_back(series[first].frame[0]);
        without.push_back(series[1 - first].frame[0]);
    }

    void finish() {
        done.push_back({names[done.size()], median_difference(with, without),
                        picture_change(picture, less->draw(frame.camera).image)});
        frames.insert(frames.end(), with.begin(), with.end());
        less.reset();
        with.clear();
        without.clear();
        round = 0;
    }
};

EffectCostMeasurement::EffectCostMeasurement(const MeasuredFrame& frame, FramePlan plan)
    : implementation_(std::make_unique<Implementation>(frame, std::move(plan))) {}

EffectCostMeasurement::~EffectCostMeasurement() = default;

bool EffectCostMeasurement::step() {
    Implementation& now = *implementation_;
    if (now.done.size() == now.names.size()) return false;
    const Repeats& repeats = now.frame.repeats;
    if (!now.less) {
        now.prepare();
    } else if (now.round < repeats.warm_up + repeats.counted) {
        now.draw_both();
    } else {
        now.finish();
    }
    return now.done.size() < now.names.size();
}

std::size_t EffectCostMeasurement::count() const {
    return implementation_->names.size();
}

EffectCosts EffectCostMeasurement::costs() const {
    return {time_statistics(implementation_->frames), implementation_->done};
}

EffectCosts measure_effects(const MeasuredFrame& frame, const FramePlan& plan) {
    EffectCostMeasurement pricing(frame, plan);
    while (pricing.step()) {
    }
    return pricing.costs();
}

std::vector<std::string> drop_order(std::span<const EffectCost> costs, double min_saving) {
    std::vector<EffectCost> worth;
    for (const EffectCost& cost : costs) {
        if (cost.milliseconds > 0.0 && cost.milliseconds >= min_saving) worth.push_back(cost);
    }
    std::stable_sort(worth.begin(), worth.end(), [](const EffectCost& a, const EffectCost& b) {
        return change_per_millisecond(a) < change_per_millisecond(b);
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
    const std::unique_ptr<Renderer> whole = renderer_of(frame, plan);
    const auto frame_time = [&](const std::vector<std::string>& dropped) {
        const std::unique_ptr<Renderer> less = renderer_of(frame, without(frame, plan, dropped));
        const std::array<Renderer*, 1> alone{less.get()};
        return time_statistics(time_frames(alone, frame.camera, frame.repeats)[0].frame).median;
    };
    result.milliseconds_before = frame_time({});
    if (result.milliseconds_before <= budget) {
        result.plan = plan;
        result.choice = {{}, result.milliseconds_before, true};
        return result;
    }
    constexpr double noise_share = 0.01;  // Of the frame time; smaller savings are noise.
    const EffectCosts costs = measure_effects(frame, plan);
    std::vector<std::string> order = drop_order(costs.effects, noise_share * costs.frame.median);
    // A mesh keeps its pose, also where the measured pose is close to rest.
    std::erase_if(order, [](const std::string& effect) {
        const EffectRow* const row = find_effect(effect);
        return row != nullptr && row->follows_pose;
    });
    result.choice = fit_to_budget(budget, order, frame_time);
    result.plan = without(frame, plan, result.choice.dropped);
    const std::unique_ptr<Renderer> less = renderer_of(frame, result.plan);
    result.change = picture_change(whole->draw(frame.camera).image, less->draw(frame.camera).image);
    return result;
}

std::vector<FrameSeries> time_frames(std::span<Renderer* const> renderers, const Camera& camera,
                                     const Repeats& repeats) {
    std::vector<FrameSeries> series(renderers.size());
    interleave(renderers.size(), repeats, [&](std::size_t i, bool counted) {
        const FrameTimes times = renderers[i]->draw(camera).times;
        if (!counted) return;
        series[i].draw.push_back(times.draw);
        series[i].read_back.push_back(times.read_back);
        series[i].frame.push_back(times.draw + times.read_back);
    });
    return series;
}

}  // namespace relief::shade
