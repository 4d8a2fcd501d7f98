// SPDX-License-Identifier: Apache-2.0
/// \file
/// Saving from the window: pictures and turntables, scene files and models, and the panel.
/// Tests: tests/tools/window/capture_test.cpp.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>

#include "relief/shade/effects.h"
#include "relief/shade/renderer.h"
#include "window/background_jobs.h"
#include "window/viewer_state.h"

namespace relief::tools {

/// The settings of the panel.
struct CaptureSettings {
    bool custom_size = false;  ///< Otherwise the size of the view is used.
    int width = 1920;
    int height = 1080;
    bool transparent = false;  ///< Without background and skybox.
    int pictures = 36;         ///< Pictures per turntable.
};

/// A request to save one picture or a turntable.
struct CaptureRequest {
    std::shared_ptr<const shade::Scene> scene;
    shade::EffectRequest effects;
    shade::FrameSettings settings;
    shade::Camera camera;
    bool transparent = false;
    int turntable = 0;       ///< Number of pictures; 0 for a single picture.
    glm::vec3 middle{0.0F};  ///< Center of the rotation.
    std::filesystem::path file;
};

/// The progress of saving pictures. Any thread may use it.
class CaptureProgress {
  public:
    struct State {
        int done = 0;
        int count = 0;
        std::string file;   ///< The last file that was written.
        std::string error;  ///< After an error, saving stops.
        [[nodiscard]] bool is_running() const { return error.empty() && done < count; }
    };
    [[nodiscard]] State state() const;
    void set(const State& state);

  private:
    mutable std::mutex mutex_;
    State state_;
};

nlohmann::ordered_json json_of(const CaptureProgress::State& state);

/// For example "Saved 36 pictures, to vase-turn-1-0036.png", or the error. Empty if nothing was
/// saved.
std::string text_of(const CaptureProgress::State& state);

/// A task that draws and writes one picture per step.
DrawTask capture_task(CaptureRequest request, std::shared_ptr<CaptureProgress> progress);

/// The first free name of the form "vase-1.png" beside the model, or "vase-turn-1.png" for a
/// turntable, whose files are "vase-turn-1-0001.png" and so on.
/// \param turntable  the number of pictures; 0 for a single picture
std::filesystem::path free_file(const std::filesystem::path& model, int turntable);

/// The first free name of the form "vase-scene-1.json" beside the model, for "-scene-" and ".json".
std::filesystem::path free_beside(const std::filesystem::path& model, const std::string& middle,
                                  const std::string& extension);

/// Saves scenes and models on another thread. Existing files are never overwritten.
class Saving {
  public:
    /// \param wake  called from another thread when a file is done
    explicit Saving(std::function<void()> wake) : job_(std::move(wake)) {}

    /// Saves as "vase-scene-1.json". Does nothing while a file is being saved.
    void save_scene(ViewerState& state);
    /// Saves as "vase-model-1.glb".
    void save_model(const ViewerState& state);

    void follow();
    [[nodiscard]] bool is_running() const { return job_.is_running(); }

    /// For example "Saved vase-scene-1.json", or the error. Empty if nothing was saved.
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
