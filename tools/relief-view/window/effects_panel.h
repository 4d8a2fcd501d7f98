// SPDX-License-Identifier: Apache-2.0
/// \file
/// Effects of the picture: the reasons for each effect, measured times, and the shader source.
/// Tests: tests/tools/window/effects_panel_test.cpp.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "relief/shade/effect_costs.h"
#include "relief/shade/effects.h"
#include "window/capture.h"
#include "window/draw_thread.h"

namespace relief::tools {

/// Measures the time of each effect on the drawing thread. Results are valid for one plan and size.
class EffectTimes {
  public:
    struct State {
        bool is_running = false;
        std::size_t count = 0;  ///< Number of effects; 0 if it is not yet known.
        EffectCosts costs;      ///< Costs of the effects that have been measured.
        std::string error;
        int width = 0;  ///< Width of the measured frames in pixels; 0 without a measurement.
        int height = 0;
        int samples = 0;
    };
    [[nodiscard]] State state() const;

    /// Starts a measurement. \return the work for the drawing thread
    DrawTask start(const DrawRequest& request);

    /// Cancels and discards the measurement.
    void cancel();

    /// Discards the measurement if it does not match the picture.
    ///
    /// \param plan  the plan of the current picture
    /// \param request  the request at full resolution
    void discard_unless_valid_for(const FramePlan& plan, const DrawRequest& request);

    /// Milliseconds of an effect, if it was measured.
    [[nodiscard]] std::optional<double> milliseconds(const std::string& effect) const;

  private:
    /// A measurement, shared by both threads.
    struct Measurement {
        std::atomic<bool> is_wanted = true;
        std::mutex mutex;
        State state;
        FramePlan plan;  ///< Empty until the measurement has started.
    };
    class MeasurementTask;

    std::shared_ptr<Measurement> current_;
};

/// {"going_on", "done", "count", "frame": milliseconds, "size", "samples", "effects": {name:
/// milliseconds}, "error"}, or null without a measurement.
nlohmann::ordered_json json_of(const EffectTimes::State& state);

/// Adds line numbers: " 1  #version 330 core".
std::string numbered_lines(const std::string& source);

/// The shader source of each program, assembled once per plan.
class ShaderPanel {
  public:
    void draw(const std::shared_ptr<const FramePlan>& plan);

  private:
    struct Program {
        std::string name;
        ShaderListing listing;
        std::string vertex;  ///< With line numbers.
        std::string fragment;
    };
    void assemble(const FramePlan& plan);
    static void draw_stage(const char* name, const std::string& source, std::string& numbered);

    std::shared_ptr<const FramePlan> plan_;
    std::vector<Program> programs_;
    std::string error_;
};

}  // namespace relief::tools
