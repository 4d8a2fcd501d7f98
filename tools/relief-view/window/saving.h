// SPDX-License-Identifier: Apache-2.0
/// \file
/// Scene and model saved from the window, beside the model, on a thread of their own; never over a
/// file that is there. Tests: tests/tools/window/saving_test.cpp.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "window/newest_job.h"
#include "window/viewer_state.h"

namespace relief::tools {

class Saving {
  public:
    /// \param wake  called, from another thread, when it is done
    explicit Saving(std::function<void()> wake) : job_(std::move(wake)) {}

    /// "vase-scene-1.json". Nothing is begun while something is saved.
    void save_scene(const ViewerState& state);
    /// "vase-model-1.glb"
    void save_model(const ViewerState& state);

    void follow();
    [[nodiscard]] bool is_going_on() const { return job_.is_going_on(); }

    /// "Saved vase-scene-1.json", or the error; empty: nothing was asked for.
    [[nodiscard]] const std::string& text() const { return text_; }
    [[nodiscard]] nlohmann::ordered_json json() const;

  private:
    struct Saved {
        std::filesystem::path file;
        std::string error;
    };
    void begin(const std::filesystem::path& file, std::function<void()> save);

    NewestJob<Saved> job_;
    Saved saved_;
    std::string text_;
};

}  // namespace relief::tools
