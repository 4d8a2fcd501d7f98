// SPDX-License-Identifier: Apache-2.0
#include "window/background_jobs.h"

#include <utility>

#include "debug_options.h"
#include "relief/mesh/timing.h"

namespace relief::tools {
namespace {

Loaded load(ViewOptions options, const Progress& progress) {
    const Stopwatch stopwatch;
    Loaded loaded;
    try {
        Stages silent(true);
        loaded.composed = compose_scene(options, silent, loaded.findings);
    } catch (const Cancelled&) {
        throw;
    } catch (const std::exception& error) {
        loaded.error = error.what();
    }
    loaded.options = std::move(options);
    loaded.files = progress.files();
    loaded.seconds = stopwatch.seconds();
    return loaded;
}

}  // namespace

void Loader::start(const ViewOptions& options) {
    job_.start([options](const Progress& progress) { return load(options, progress); });
}

namespace {

HealthResult find(const HealthRequest& request) {
    DebugChoices choices;
    choices.health_markers = request.choice;
    try {
        return {chosen_markers(choices, *request.scene), ""};
    } catch (const Cancelled&) {
        throw;
    } catch (const std::exception& error) {
        return {{}, error.what()};
    }
}

}  // namespace

void HealthSearch::start(HealthRequest request) {
    if (!request.choice || !request.scene) return job_.cancel();
    job_.start([checked = std::move(request)](const Progress&) { return find(checked); });
}

}  // namespace relief::tools
