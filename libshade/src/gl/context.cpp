// SPDX-License-Identifier: Apache-2.0
// Chooses the library that provides the context, and reports the reasons if none can.
#include "relief/shade/context.h"

#include <fmt/format.h>

#include <cassert>
#include <thread>

#include "gl/platform_context.h"

namespace relief {

namespace {

/// True if this thread has a Context. OSMesa and EGL would not notice that both are current.
thread_local bool thread_has_context = false;

/// A context that works.
struct Opened {
    std::unique_ptr<gl::PlatformContext> platform;  ///< Empty if the caller owns it.
    std::unique_ptr<gl::Api> api;
    std::string name;
};

/// The failed attempts: "OSMesa: libOSMesa.so.8: cannot open shared object file; ...".
using Failures = std::vector<std::string>;

/// The table of a context that has just been made current.
Opened with_api(std::unique_ptr<gl::PlatformContext> platform, std::string name) {
    auto api = std::make_unique<gl::Api>(platform->loader());
    return {std::move(platform), std::move(api), std::move(name)};
}

Opened open_osmesa(Failures& failures) {
    try {
        return with_api(gl::make_osmesa_context(), "OSMesa");
    } catch (const GpuError& error) {
        failures.push_back(fmt::format("OSMesa: {}", error.what()));
        return {};
    }
}

Opened open_egl(bool hardware, Failures& failures) {
    const char* title = hardware ? "EGL (hardware)" : "EGL (software)";
    std::vector<gl::EglDisplay> displays;
    try {
        displays = gl::egl_displays();
    } catch (const GpuError& error) {
        failures.push_back(fmt::format("{}: {}", title, error.what()));
        return {};
    }
    const gl::EglDisplay::Kind other =
        hardware ? gl::EglDisplay::Kind::software : gl::EglDisplay::Kind::hardware;
    bool tried = false;
    for (const gl::EglDisplay& display : displays) {
        if (display.kind == other) continue;
        tried = true;
        try {
            Opened opened = with_api(gl::make_egl_context(display), title);
            // A display adapter without a driver is rasterized on the processor as well.
            if (opened.api->is_software() != hardware) return opened;
            failures.push_back(fmt::format("{}: {}: it is drawn by {}", title, display.name,
                                           opened.api->renderer()));
        } catch (const GpuError& error) {
            failures.push_back(fmt::format("{}: {}: {}", title, display.name, error.what()));
        }
    }
    if (!tried) failures.push_back(fmt::format("{}: there is no such device", title));
    return {};
}

void require_no_context() {
    if (thread_has_context)
        throw InvalidInput("this thread has an OpenGL context already; destroy it first");
}

Opened open(Backend backend, Failures& failures) {
    Opened opened;
    if (backend != Backend::osmesa) opened = open_egl(true, failures);
    if (!opened.api && backend != Backend::egl) opened = open_osmesa(failures);
    if (!opened.api && backend != Backend::osmesa) opened = open_egl(false, failures);
    return opened;
}

}  // namespace

struct Context::Implementation {
    explicit Implementation(Opened made)
        : opened(std::move(made)),
          renderer_name(fmt::format("{}, {}", opened.api->renderer(), opened.api->version())) {}

    Opened opened;
    std::string renderer_name;
    std::thread::id thread = std::this_thread::get_id();
};

Context::Context(Backend backend) {
    require_no_context();
    Failures failures;
    Opened opened = open(backend, failures);
    if (!opened.api) {
        throw GpuError(
            fmt::format("no OpenGL 3.3 context could be made: {}", fmt::join(failures, "; ")));
    }
    implementation_ = std::make_unique<Implementation>(std::move(opened));
    thread_has_context = true;
}

Context::Context(GlLoader loader, std::string name) {
    require_no_context();
    implementation_ = std::make_unique<Implementation>(
        Opened{nullptr, std::make_unique<gl::Api>(loader), std::move(name)});
    thread_has_context = true;
}

Context::~Context() {
    assert(implementation_->thread == std::this_thread::get_id() &&
           "a context is destroyed on the thread that made it");
    assert(implementation_->opened.api->live_names() == 0 &&
           "whatever lives in a context goes before it");
    implementation_->opened.api.reset();  // The context must outlive it.
    implementation_.reset();
    thread_has_context = false;
}

const std::string& Context::backend_name() const {
    return implementation_->opened.name;
}
const std::string& Context::renderer_name() const {
    return implementation_->renderer_name;
}

bool Context::is_software() const {
    return api().is_software();
}

const gl::Api& Context::api() const {
    return *implementation_->opened.api;
}

}  // namespace relief
