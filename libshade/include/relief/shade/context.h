// SPDX-License-Identifier: Apache-2.0
/// \file
/// An OpenGL context: without a window, or a window's.
/// Tests: tests/shade/gl/context_test.cpp, tests/shade/gl/egl_devices_test.cpp.
#pragma once

#include <memory>
#include <string>

namespace relief {

/// Which library gives the context. Each is loaded at run time; none is needed by another.
///
/// OSMesa is libOSMesa.so.8, .6 or .so, EGL is libEGL.so.1, wherever the system keeps them;
/// $RELIEF_OSMESA_LIBRARY and $RELIEF_EGL_LIBRARY name another file in their place. A device that
/// calls itself hardware but is drawn by Mesa's rasteriser counts as software.
enum class Backend {
    automatic,  ///< A hardware EGL device where there is one, else OSMesa, else software EGL.
    osmesa,
    egl,
};

/// How a window library finds OpenGL functions of the context that is current.
using GlLoader = void (*(*)(const char* name))();

namespace gl {
class Api;  // The table of entry points (libshade/src/gl/api.h).
}

/// One OpenGL 3.3 core context, current on the thread that made it until destroyed.
///
/// At most one exists at a time in a thread, since OSMesa and EGL do not notice each other; any
/// number of threads may have one each. It is destroyed on the thread that made it, after
/// everything that lives in it. The libraries and EGL's displays stay loaded until the process
/// ends.
class Context {
  public:
    /// \throws GpuError saying for every backend tried why it could not serve
    /// \throws InvalidInput if this thread has a context already
    explicit Context(Backend backend = Backend::automatic);

    /// One that the caller has made current on this thread, and keeps so for longer than this.
    ///
    /// \param name  for backend_name()
    /// \throws GpuError if it offers less than OpenGL 3.3
    /// \throws InvalidInput if this thread has a context already
    Context(GlLoader loader, std::string name);
    ~Context();
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    /// "OSMesa", "EGL (hardware)" or "EGL (software)"; of a given one, its name.
    [[nodiscard]] const std::string& backend_name() const;
    /// "llvmpipe (LLVM 15.0.6, 256 bits), 4.5 (Core Profile) Mesa 22.3.6".
    [[nodiscard]] const std::string& renderer_name() const;
    /// Whether that draws on processors, by one of Mesa's rasterisers.
    [[nodiscard]] bool is_software() const;

    [[nodiscard]] const gl::Api& api() const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace relief
