// SPDX-License-Identifier: Apache-2.0
/// \file
/// Errors and times of methods for the scene in the window: normals and tangents of its largest
/// mesh, and kernels for its height map. They are measured in the background on request, and
/// discarded when another scene is read. The method that the user chooses is also computed in the
/// background and applied to the scene. Tests: tests/tools/window/scene_accuracy_test.cpp.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "relief/accuracy/asset.h"
#include "view_options.h"
#include "window/background_jobs.h"
#include "window/viewer_state.h"

namespace relief::tools {

/// An experiment with its rows in the panel.
struct AccuracyTopic {
    accuracy::AssetExperiment own;
    std::vector<std::size_t> rows;  ///< Indices of all measurements, the fastest first.
    /// For each measurement, the variant that applies it, if there is one.
    std::vector<std::optional<Variant>> uses;
};

/// The measurements of one scene.
struct AccuracyResult {
    std::vector<AccuracyTopic> topics;
    std::string error;
    std::optional<Kernel> kernel;  ///< displayed_kernel(), if there is a height map.
};

class SceneAccuracy {
  public:
    /// \param wake  called from another thread when there is news
    explicit SceneAccuracy(const std::function<void()>& wake);

    void measure(const ViewerState& state);
    void stop() { measuring_.cancel(); }

    /// Applies a method for normals or tangents.
    void use(const Variant& variant);

    /// Collects results, and applies the chosen methods to the state's scene. To be called once per
    /// frame.
    void follow(ViewerState& state);

    [[nodiscard]] const AccuracyResult& result() const { return result_; }
    [[nodiscard]] bool is_measuring() const { return measuring_.is_running(); }
    [[nodiscard]] bool is_working() const { return is_measuring() || computing_.is_running(); }
    [[nodiscard]] Progress::State progress() const { return measuring_.progress(); }

    /// Returns whether the picture uses this method.
    [[nodiscard]] bool is_used(const Variant& variant, const ViewOptions& options) const;

    [[nodiscard]] nlohmann::ordered_json json(const ViewOptions& options) const;

  private:
    struct Computed {
        Variant variant;
        shade::PreparedVariant prepared;
        std::string error;
    };

    void begin_next(const ViewerState& state);

    NewestJob<AccuracyResult> measuring_;
    NewestJob<Computed> computing_;
    AccuracyResult result_;
    std::uint64_t scene_ = 0;  ///< ViewerState::scenes() of the results.
    /// The chosen methods by the index of the variant type.
    std::map<std::size_t, Variant> chosen_;
    std::vector<Variant> waiting_;  ///< Methods that are still to be computed.
};

}  // namespace relief::tools
