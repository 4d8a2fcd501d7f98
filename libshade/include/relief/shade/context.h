// SPDX-License-Identifier: Apache-2.0
/// \file
/// Creates OpenGL contexts without a window, or wraps those of a window library.
#pragma once

#include <memory>
#include <string>

#include "relief/export.h"
#include "relief/mesh/report.h"

namespace RELIEF_API relief {

/// OpenGL is missing, too old or out of memory, or refuses a shader. The message contains that of
/// the driver.
class GpuError : public Error {
  public:
    using Error::Error;
};

/// The library that provides the context. Libraries are loaded at run time, independently of each
/// other.
///
/// OSMesa is libOSMesa.so.8, .6 or .so, EGL is libEGL.so.1, in the library path of the system;
/// $RELIEF_OSMESA_LIBRARY and $RELIEF_EGL_LIBRARY name other files. A device that claims to be
/// hardware but uses Mesa's rasterizer counts as software.
enum class Backend {
    automatic,  ///< A hardware EGL device if one exists, else OSMesa, else software EGL.
    osmesa,
    egl,
};

/// A function of a window library that returns OpenGL functions of the current context.
using GlLoader = void (*(*)(const char* name))();

namespace gl {
class Api;  // The table of entry points (libshade/src/gl/api.h).
}

/// An OpenGL 3.3 core context, current on the thread that created it until it is destroyed.
///
/// A thread can have at most one, because OSMesa and EGL do not detect each other; any number of
/// threads may have one each. Destroy it on the thread that created it, after all objects in it.
/// The libraries and EGL's displays stay loaded until the process ends.
class Context {
  public:
    /// Creates a context.
    /// \throws GpuError with the reason of every backend that was tried
    /// \throws InvalidInput if this thread has a context already
    explicit Context(Backend backend = Backend::automatic);

    /// Wraps a context that the caller has made current on this thread and keeps current for
    /// longer.
    ///
    /// \param name  for backend_name()
    /// \throws GpuError if it offers less than OpenGL 3.3
    /// \throws InvalidInput if this thread has a context already
    Context(GlLoader loader, std::string name);
    ~Context();
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    /// "OSMesa", "EGL (hardware)" or "EGL (software)"; the given name of a wrapped context.
    [[nodiscard]] const std::string& backend_name() const;
    /// "llvmpipe (LLVM 15.0.6, 256 bits), 4.5 (Core Profile) Mesa 22.3.6".
    [[nodiscard]] const std::string& renderer_name() const;
    /// Returns true if a rasterizer of Mesa draws on the CPU.
    [[nodiscard]] bool is_software() const;

    [[nodiscard]] const gl::Api& api() const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace relief
