// SPDX-License-Identifier: Apache-2.0
/// \file
/// What methods err and cost on the scene in the window: normals and tangents of its largest mesh,
/// kernels for its height map. Measured when somebody asks, on a thread of its own; forgotten when
/// another scene is read. A method that is chosen is computed on that thread too, and put into the
/// scene; a scene read anew gets it again. Tests: tests/tools/window/scene_accuracy_test.cpp.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "relief/accuracy/own.h"
#include "variant_scene.h"
#include "window/newest_job.h"
#include "window/viewer_state.h"

namespace relief::tools {

/// One thing that methods differ in.
struct AccuracyTopic {
    OwnExperiment own;
    std::vector<std::size_t> rows;  ///< All measurements, the fastest first.
    /// By measurement, what puts it to use; absent where the window cannot.
    std::vector<std::optional<Variant>> uses;
};

/// Of one scene.
struct FoundAccuracy {
    std::vector<AccuracyTopic> topics;
    std::string error;
    std::optional<Kernel> kernel;  ///< kernel_shown(), where there is a height map.
};

class SceneAccuracy {
  public:
    /// \param wake  called, from another thread, when there is something new
    explicit SceneAccuracy(const std::function<void()>& wake);

    void measure(const ViewerState& state);
    void stop() { measuring_.cancel(); }

    /// Normals or tangents from now on.
    void use(const Variant& variant);

    /// Takes what is there by now, and puts methods that were chosen into the state's scene.
    void follow(ViewerState& state);

    [[nodiscard]] const FoundAccuracy& found() const { return found_; }
    [[nodiscard]] bool is_measuring() const { return measuring_.is_going_on(); }
    [[nodiscard]] bool is_working() const { return is_measuring() || computing_.is_going_on(); }
    [[nodiscard]] Progress::State progress() const { return measuring_.progress(); }

    /// Whether this is what the picture shows now: what was chosen, or the options' kernel.
    [[nodiscard]] bool is_used(const Variant& variant, const ViewOptions& options) const;

    [[nodiscard]] nlohmann::ordered_json json(const ViewOptions& options) const;

  private:
    struct Computed {
        Variant variant;
        PreparedVariant prepared;
        std::string error;
    };

    void begin_next(const ViewerState& state);

    NewestJob<FoundAccuracy> measuring_;
    NewestJob<Computed> computing_;
    FoundAccuracy found_;
    std::uint64_t scene_ = 0;                ///< ViewerState::scenes() that all this is about.
    std::map<std::size_t, Variant> chosen_;  ///< By kind: one for normals, one for tangents.
    std::vector<Variant> waiting_;           ///< To be computed, one after the other.
};

}  // namespace relief::tools
