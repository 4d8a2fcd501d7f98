// SPDX-License-Identifier: Apache-2.0
/// \file
/// The libraries that provide contexts, OSMesa and EGL, behind one interface. Neither notices the
/// other: each context is released before another is made current.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "gl/api.h"

namespace relief::gl {

/// A context that is current on the thread that made it; its destructor, on the same thread,
/// releases and destroys it.
class PlatformContext {
  public:
    PlatformContext() = default;
    virtual ~PlatformContext() = default;
    PlatformContext(const PlatformContext&) = delete;
    PlatformContext& operator=(const PlatformContext&) = delete;

    [[nodiscard]] virtual Api::Loader loader() const = 0;
};

/// \throws GpuError saying why not
std::unique_ptr<PlatformContext> make_osmesa_context();

/// A display that EGL offers.
struct EglDisplay {
    enum class Kind { hardware, software, unknown };

    void* display = nullptr;  ///< EGLDisplay, not initialized yet.
    Kind kind = Kind::unknown;
    std::string name;  ///< For messages: "device 1 (/dev/dri/card0)", "surfaceless".
};

/// All displays: the devices in EGL's order, then Mesa's surfaceless platform.
/// \throws GpuError if EGL is missing or offers none
std::vector<EglDisplay> egl_displays();

/// \throws GpuError saying why not
std::unique_ptr<PlatformContext> make_egl_context(const EglDisplay& display);

}  // namespace relief::gl
