// SPDX-License-Identifier: Apache-2.0
/// \file
/// What each effect costs, what the picture would lose without it, and which to drop so that a
/// frame keeps within a time. Measured, so it differs from machine to machine; what is decided from
/// given measurements is always the same.
/// Tests: tests/shade/render/effect_costs_test.cpp.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "relief/shade/frame_timing.h"
#include "relief/shade/image_compare.h"

namespace relief {

/// A scene to be drawn in one way, over and over.
struct MeasuredFrame {
    const Context& context;
    const Scene& scene;
    const FrameSettings& settings;
    const Camera& camera;
    Repeats repeats = {};
    RenderCache* cache = nullptr;  ///< Where given, what renderers made is shared.
};

/// How far the picture without something is from the picture with it.
struct PictureChange {
    double max = 0;  ///< In units of the picture's samples (8 bit: 0 to 255).
    double mean = 0;
    double flip_mean = 0;  ///< As an eye sees it, 0 to 1 (image_compare.h).
    double flip_max = 0;
};
PictureChange picture_change(const Image& with, const Image& without);

/// One effect of a plan.
struct EffectCost {
    std::string effect;
    /// Frame time with it less that without it; below 0 where the noise is larger than its cost.
    double milliseconds = 0;
    PictureChange change;
};

struct EffectCosts {
    Spread frame;  ///< Milliseconds of a frame with all of the plan's effects, read back included.
    std::vector<EffectCost> effects;  ///< Of effects_in(plan), in its order.
};

/// Takes each effect out of the plan by itself, and what cannot show without it with it; draws with
/// and without it in turns. \throws what Renderer does
EffectCosts measure_effects(const MeasuredFrame& frame, const FramePlan& plan);

/// The same in small steps, between which other things may be drawn in the same context.
class EffectPricing {
  public:
    EffectPricing(const MeasuredFrame& frame, FramePlan plan);
    ~EffectPricing();
    EffectPricing(const EffectPricing&) = delete;
    EffectPricing& operator=(const EffectPricing&) = delete;

    /// Prepares to draw without the next effect, or draws one frame with and one without it.
    /// \return whether there is more to do \throws what Renderer does
    bool step();

    /// How many effects there are to price.
    [[nodiscard]] std::size_t count() const;

    /// Of those that are done.
    [[nodiscard]] EffectCosts costs() const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

/// Effects in the order in which they are worth dropping: those whose absence an eye sees least for
/// the time that it saves, first. Those that save less than `least_saving` are left out; ties go by
/// the order given.
std::vector<std::string> drop_order(std::span<const EffectCost> costs, double least_saving);

/// What is dropped, and where that leads.
struct BudgetChoice {
    std::vector<std::string> dropped;  ///< In order.
    double milliseconds = 0;           ///< Of a frame, in the end.
    bool fits = false;
};

/// Drops effects in that order until a frame fits.
///
/// \param frame_time  the time without these effects: measured, or from a table
BudgetChoice fit_to_budget(
    double budget, const std::vector<std::string>& order,
    const std::function<double(const std::vector<std::string>& dropped)>& frame_time);

/// A plan that was made to fit.
struct BudgetedPlan {
    FramePlan plan;
    double milliseconds_before = 0;
    BudgetChoice choice;
    PictureChange change;  ///< From the whole plan's picture.
};

/// Measures all effects of a plan, drops by drop_order() until the median frame takes no longer
/// than `budget` milliseconds, measuring again after each, and says how the picture differs. Does
/// not fit where nothing more can be dropped. \throws what Renderer does
BudgetedPlan plan_within_budget(const MeasuredFrame& frame, const FramePlan& plan, double budget);

}  // namespace relief
