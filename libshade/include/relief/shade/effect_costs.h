// SPDX-License-Identifier: Apache-2.0
/// \file
/// Measures the time of each effect and its visible contribution, and selects the effects to drop
/// so that a frame fits a time budget. Measurements differ between machines; the selection depends
/// only on the measurements.
/// Tests: tests/shade/render/forced_effects_test.cpp.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "relief/export.h"
#include "relief/shade/image_compare.h"
#include "relief/shade/renderer.h"

namespace RELIEF_API relief {
namespace shade {

/// A scene and the settings with which it is drawn repeatedly.
struct MeasuredFrame {
    const Context& context;
    const Scene& scene;
    const FrameSettings& settings;
    const Camera& camera;
    Repeats repeats = {};
    RenderCache* cache = nullptr;  ///< If given, renderers share its resources.
};

/// The difference between the pictures with and without an effect.
struct PictureChange {
    double max = 0;  ///< In units of the picture's samples (8 bit: 0 to 255).
    double mean = 0;
    double flip_mean = 0;  ///< Perceived difference, 0 to 1 (image_compare.h).
    double flip_max = 0;
};
PictureChange picture_change(const Image& with, const Image& without);

/// The cost of one effect of a plan.
struct EffectCost {
    std::string effect;
    /// Frame time with it minus that without it; negative if noise exceeds the cost.
    double milliseconds = 0;
    PictureChange change;
};

struct EffectCosts {
    TimeStatistics
        frame;  ///< Milliseconds of a frame with all effects of the plan, including read-back.
    std::vector<EffectCost> effects;  ///< The effects of effects_in(plan), in its order.
};

/// Returns whether a cost is larger than the noise of the measurement: the range from the 10th to
/// the 90th percentile of the time of a frame.
bool exceeds_noise(const EffectCost& cost, const EffectCosts& measured);

/// Measures every effect: removes it, and effects that are invisible without it, from the plan, and
/// draws frames with and without it, interleaved. \throws as Renderer does
EffectCosts measure_effects(const MeasuredFrame& frame, const FramePlan& plan);

/// The same in small steps, between which the caller may draw in the same context.
class EffectCostMeasurement {
  public:
    EffectCostMeasurement(const MeasuredFrame& frame, FramePlan plan);
    ~EffectCostMeasurement();
    EffectCostMeasurement(const EffectCostMeasurement&) = delete;
    EffectCostMeasurement& operator=(const EffectCostMeasurement&) = delete;

    /// Prepares the measurement of the next effect, or draws one frame with and one without it.
    /// \return true if there is more to do
    /// \throws as Renderer does
    bool step();

    /// Number of effects to measure.
    [[nodiscard]] std::size_t count() const;

    /// The costs of the effects that have been measured.
    [[nodiscard]] EffectCosts costs() const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

/// Sorts effects in the order in which to drop them: by increasing perceived difference per saved
/// time. Effects that save less than `min_saving` are omitted; ties keep the given order.
std::vector<std::string> drop_order(std::span<const EffectCost> costs, double min_saving);

/// The dropped effects and the resulting frame time.
struct BudgetChoice {
    std::vector<std::string> dropped;  ///< In order.
    double milliseconds = 0;           ///< The resulting frame time.
    bool fits = false;
};

/// Drops effects in the given order until a frame fits.
///
/// \param frame_time  returns the frame time without these effects, measured or from a table
BudgetChoice fit_to_budget(
    double budget, const std::vector<std::string>& order,
    const std::function<double(const std::vector<std::string>& dropped)>& frame_time);

/// A plan that was reduced to fit a budget.
struct BudgetedPlan {
    FramePlan plan;
    double milliseconds_before = 0;
    BudgetChoice choice;
    PictureChange change;  ///< The difference from the picture of the complete plan.
};

/// Measures all effects of a plan and drops them in drop_order() until the median frame takes at
/// most `budget` milliseconds; measures again after each one. Also returns the difference of the
/// pictures. Effects that deform meshes are never dropped. The result does not fit if no further
/// effect can be dropped. \throws as Renderer does
BudgetedPlan plan_within_budget(const MeasuredFrame& frame, const FramePlan& plan, double budget);

}  // namespace shade
}  // namespace relief
