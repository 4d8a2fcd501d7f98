// SPDX-License-Identifier: Apache-2.0
/// \file
/// What each effect of the picture costs, measured on demand by the drawing thread where it has
/// nothing else to do; prices hold for the plan and the size that they were measured with.
/// Tests: tests/tools/window/effect_prices_test.cpp.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "relief/shade/effect_costs.h"
#include "window/capture.h"
#include "window/draw_thread.h"

namespace relief::tools {

class EffectPrices {
  public:
    struct State {
        bool is_going_on = false;
        std::size_t count = 0;  ///< Of effects; 0 before the first is known.
        EffectCosts costs;      ///< Of those that are done.
        std::string error;
        int width = 0;  ///< Of the frames that are drawn, in pixels; 0: nothing was measured.
        int height = 0;
        int samples = 0;
    };
    [[nodiscard]] State state() const;

    /// The work to be done in the drawing thread; what was measured before is forgotten.
    DrawTask start(const DrawWish& wish);

    /// Ends the work, and forgets it.
    void cancel();

    /// Forgets prices that are not those of what is drawn, and ends measuring them.
    ///
    /// \param plan  what is drawn now
    /// \param wish  what is wished whole
    void keep_for(const FramePlan& plan, const DrawWish& wish);

    /// Milliseconds that an effect takes; nothing where it was not measured.
    [[nodiscard]] std::optional<double> price(const std::string& effect) const;

  private:
    /// One measurement, which both threads know.
    struct Measurement {
        std::atomic<bool> is_wanted = true;
        std::mutex mutex;
        State state;
        FramePlan plan;  ///< Empty before it is known.
    };
    class Measuring;

    std::shared_ptr<Measurement> current_;
};

/// {"going_on", "done", "count", "frame": milliseconds, "size", "samples", "effects": {name:
/// milliseconds}, "error"}; null: nothing was measured
nlohmann::ordered_json json_of(const EffectPrices::State& state);

}  // namespace relief::tools
