// SPDX-License-Identifier: Apache-2.0
// Milliseconds of wall clock. Tests: tests/tools/window/effect_prices_test.cpp.
#include "window/effect_prices.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace relief::tools {
namespace {

/// The drawing thread looks for wishes so often, and the window shows how far it is.
constexpr std::chrono::milliseconds step_time(100);

bool have_same_effects(const FramePlan& a, const FramePlan& b) {
    const auto same_features = [](const DrawPlan& one, const DrawPlan& other) {
        return one.features == other.features;
    };
    return effects_in(a) == effects_in(b) &&
           std::equal(a.draws.begin(), a.draws.end(), b.draws.begin(), b.draws.end(),
                      same_features);
}

}  // namespace

/// What the drawing thread holds of it.
class EffectPrices::Measuring {
  public:
    Measuring(DrawWish wish, std::shared_ptr<Measurement> measurement)
        : wish_(std::move(wish)), measurement_(std::move(measurement)) {}

    /// As many steps as there is time for. \return whether there is more to do
    bool work(const Context& context, RenderCache& cache) {
        if (!measurement_->is_wanted) return false;
        bool has_more = false;
        std::string error;
        try {
            const auto end = std::chrono::steady_clock::now() + step_time;
            if (!pricing_) prepare(context, cache);
            do {
                has_more = pricing_->step();
            } while (has_more && measurement_->is_wanted && std::chrono::steady_clock::now() < end);
        } catch (const std::exception& failure) {
            has_more = false;
            error = failure.what();
        }
        const std::lock_guard lock(measurement_->mutex);
        State& state = measurement_->state;
        if (pricing_) state.costs = pricing_->costs();
        state.error = error;
        state.is_going_on = has_more;
        return has_more;
    }

  private:
    void prepare(const Context& context, RenderCache& cache) {
        FramePlan plan = force_effects(*wish_.scene, wish_.settings,
                                       plan_effects(*wish_.scene, wish_.settings), wish_.effects);
        const MeasuredFrame frame{.context = context,
                                  .scene = *wish_.scene,
                                  .settings = wish_.settings,
                                  .camera = wish_.camera,
                                  .cache = &cache};
        pricing_ = std::make_unique<EffectPricing>(frame, plan);
        const std::lock_guard lock(measurement_->mutex);
        measurement_->plan = std::move(plan);
        measurement_->state.count = pricing_->count();
    }

    DrawWish wish_;
    std::shared_ptr<Measurement> measurement_;
    std::unique_ptr<EffectPricing> pricing_;
};

EffectPrices::State EffectPrices::state() const {
    if (!current_) return {};
    const std::lock_guard lock(current_->mutex);
    return current_->state;
}

DrawTask EffectPrices::start(const DrawWish& wish) {
    cancel();
    current_ = std::make_shared<Measurement>();
    State& state = current_->state;
    state.is_going_on = true;
    state.width = wish.settings.width;
    state.height = wish.settings.height;
    state.samples = wish.settings.samples;
    DrawWish picture = wish;
    picture.settings.overlays = {};
    const auto measuring = std::make_shared<Measuring>(std::move(picture), current_);
    return [measuring](const Context& context, RenderCache& cache) {
        return measuring->work(context, cache);
    };
}

void EffectPrices::cancel() {
    if (current_) current_->is_wanted = false;
    current_.reset();
}

void EffectPrices::keep_for(const FramePlan& plan, const DrawWish& wish) {
    if (!current_) return;
    bool holds = false;
    {
        const std::lock_guard lock(current_->mutex);
        const State& state = current_->state;
        const bool is_known = state.count > 0;
        holds = state.width == wish.settings.width && state.height == wish.settings.height &&
                state.samples == wish.settings.samples &&
                (!is_known || have_same_effects(current_->plan, plan));
    }
    if (!holds) cancel();
}

std::optional<double> EffectPrices::price(const std::string& effect) const {
    const State now = state();
    const auto found = std::find_if(now.costs.effects.begin(), now.costs.effects.end(),
                                    [&](const EffectCost& cost) { return cost.effect == effect; });
    if (found == now.costs.effects.end()) return std::nullopt;
    return found->milliseconds;
}

nlohmann::ordered_json json_of(const EffectPrices::State& state) {
    if (state.width == 0) return nullptr;
    nlohmann::ordered_json effects = nlohmann::ordered_json::object();
    for (const EffectCost& cost : state.costs.effects)
        effects[cost.effect] = cost.milliseconds;
    return {{"going_on", state.is_going_on},
            {"done", state.costs.effects.size()},
            {"count", state.count},
            {"frame", state.costs.frame.median},
            {"size", {state.width, state.height}},
            {"samples", state.samples},
            {"effects", effects},
            {"error", state.error}};
}

}  // namespace relief::tools
