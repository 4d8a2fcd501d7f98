// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/window/health_search_test.cpp.
#include "window/health_search.h"

#include "debug_options.h"

namespace relief::tools {
namespace {

FoundHealth find(const HealthWish& wish) {
    DebugChoices choices;
    choices.health_markers = wish.choice;
    try {
        return {chosen_markers(choices, *wish.scene), ""};
    } catch (const Cancelled&) {
        throw;
    } catch (const std::exception& error) {
        return {{}, error.what()};
    }
}

}  // namespace

void HealthSearch::start(HealthWish wish) {
    if (!wish.choice || !wish.scene) return job_.cancel();
    job_.start([sought = std::move(wish)](const Progress&) { return find(sought); });
}

}  // namespace relief::tools
