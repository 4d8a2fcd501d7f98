// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/window/saving_test.cpp.
#include "window/saving.h"

#include "relief/shade/scene_writer.h"
#include "save_files.h"
#include "window/capture.h"
#include "window/draw_thread.h"

namespace relief::tools {

void Saving::begin(const std::filesystem::path& file, std::function<void()> save) {
    text_ = "Saving " + file.string();
    job_.start([file, work = std::move(save)](const Progress&) {
        Saved saved{file, ""};
        try {
            work();
        } catch (const Cancelled&) {
            throw;
        } catch (const std::exception& error) {
            saved.error = error.what();
        }
        return saved;
    });
}

void Saving::save_scene(const ViewerState& state) {
    const std::optional<DrawWish> wish = state.wish();
    if (!wish || is_going_on()) return;
    const std::filesystem::path model = state.options().model;
    const std::filesystem::path file = free_beside(model, "-scene-", ".json");
    // All of it: what is hidden is hidden from the picture, not from the scene.
    const auto scene = std::make_shared<const Scene>(state.scene());
    begin(file, [model, file, scene, camera = wish->camera, size = state.view()] {
        relief::save_scene(file, {model, *scene, camera, size});
    });
}

void Saving::save_model(const ViewerState& state) {
    if (!state.has_scene() || is_going_on()) return;
    const std::filesystem::path model = state.options().model;
    const std::filesystem::path file = free_beside(model, "-model-", ".glb");
    begin(file, [model, file] { tools::save_model(file, model); });
}

void Saving::follow() {
    if (std::optional<Saved> saved = job_.take()) {
        saved_ = std::move(*saved);
        text_ =
            saved_.error.empty() ? "Saved " + saved_.file.string() : "Not saved: " + saved_.error;
    }
}

nlohmann::ordered_json Saving::json() const {
    return {{"going_on", is_going_on()}, {"file", saved_.file.string()}, {"error", saved_.error}};
}

}  // namespace relief::tools
