// SPDX-License-Identifier: Apache-2.0
/// \file
/// Pictures saved from the window: one, or all of a turn, as --output and --turntable write them.
/// They are drawn by the drawing thread where it has nothing else to do, one after the other.
/// Tests: tests/tools/window/capture_test.cpp.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>

#include "relief/shade/effect_forcing.h"
#include "relief/shade/render_cache.h"
#include "relief/shade/renderer.h"

namespace relief::tools {

/// What the panel asks for.
struct CaptureSettings {
    bool own_size = false;  ///< Else that of the view.
    int width = 1920;
    int height = 1080;
    bool transparent = false;  ///< Neither background nor skybox.
    int pictures = 36;         ///< Of one turn.
};

struct CaptureWish {
    std::shared_ptr<const Scene> scene;
    EffectWishes effects;
    FrameSettings settings;
    Camera camera;
    bool transparent = false;
    int turntable = 0;       ///< Pictures of one turn; 0: a single one.
    glm::vec3 middle{0.0F};  ///< What the model turns about.
    std::filesystem::path file;
};

/// How far it is, for all threads.
class CaptureProgress {
  public:
    struct State {
        int done = 0;
        int count = 0;
        std::string file;   ///< Written last.
        std::string error;  ///< Nothing more is written after one.
        [[nodiscard]] bool is_going_on() const { return error.empty() && done < count; }
    };
    [[nodiscard]] State state() const;
    void set(const State& state);

  private:
    mutable std::mutex mutex_;
    State state_;
};

nlohmann::ordered_json json_of(const CaptureProgress::State& state);

/// "Saved 3 of 36: vase-turn-0003.png", or the error; empty: nothing was asked for.
std::string text_of(const CaptureProgress::State& state);

/// Work for the thread with that context: each call draws and writes one picture, and says whether
/// there is more. What it leaves on the GPU goes with the function, which is to be destroyed there.
using DrawTask = std::function<bool(const Context& context, RenderCache& cache)>;
DrawTask capture_task(CaptureWish wish, std::shared_ptr<CaptureProgress> progress);

/// "vase-1.png" beside the model, or with the next number that is free; of a turn
/// "vase-turn-1.png", whose pictures are "vase-turn-1-0001.png" and so on.
/// \param turntable  how many pictures, of which none may be there; 0: one, and no turn
std::filesystem::path free_file(const std::filesystem::path& model, int turntable);

/// "vase-scene-1.json" beside the model, for "-scene-" and ".json", or the next that is free.
std::filesystem::path free_beside(const std::filesystem::path& model, const std::string& middle,
                                  const std::string& extension);

}  // namespace relief::tools
