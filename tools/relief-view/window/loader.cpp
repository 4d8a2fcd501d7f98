// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/window/loader_test.cpp.
#include "window/loader.h"

#include <utility>

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

}  // namespace relief::tools
