// SPDX-License-Identifier: Apache-2.0
/// \file
/// The OpenGL entry points of one context, the messages of its driver, the owners of OpenGL names,
/// and the libraries that provide contexts: OSMesa and EGL, behind one interface.
///
/// OSMesa's functions differ from EGL's, and a call of one has no effect while the other is
/// current. So there is no global table: callers of OpenGL receive the Api of their context.
/// Neither library notices the other: each context is released before another is made current.
#pragma once

#include <glad/gl.h>

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gl/api.h"

namespace relief::shade::gl {

// Entry points

/// A message of the driver through KHR_debug.
struct DebugMessage {
    bool error = false;  ///< An OpenGL error, not a warning or a hint.
    std::string text;
};

/// The limits of a context.
struct Limits {
    int texture_size = 0;       ///< Texels along a side of a 2D texture.
    int cube_size = 0;          ///< Texels along a side of a cube face.
    int renderbuffer_size = 0;  ///< Pixels along a side.
    int viewport_width = 0;
    int viewport_height = 0;
    int buffer_texels = 0;        ///< The size of a buffer texture.
    int uniform_block_bytes = 0;  ///< The size of one uniform block.
    int texture_units = 0;        ///< The units of a fragment shader.
    int samples = 0;              ///< Per pixel.
    float anisotropy = 1.0F;  ///< 1 if filtering is isotropic, or anisotropic filtering is wrong.
};

/// The table of one context: `api->Clear(...)`.
///
/// Only OpenGL 3.3 core is always available; for the rest there are has_...() functions.
class Api {
  public:
    using Loader = GLADapiproc (*)(const char* name);

    /// Loads the table of the context that is current, and sets the two states that all of relief
    /// relies on: seamless cube maps, tightly packed rows in uploads and readbacks.
    /// \throws GpuError if it offers less than OpenGL 3.3
    explicit Api(Loader loader);
    ~Api();
    Api(const Api&) = delete;
    Api& operator=(const Api&) = delete;

    const GladGLContext* operator->() const { return &table_; }

    [[nodiscard]] bool has_debug_messages() const { return table_.KHR_debug != 0; }
    [[nodiscard]] const Limits& limits() const { return limits_; }
    /// Returns GL_RENDERER and GL_VERSION.
    [[nodiscard]] std::string renderer() const { return text(GL_RENDERER); }
    [[nodiscard]] std::string version() const { return text(GL_VERSION); }
    /// Tells whether the processor rasterizes (Mesa's llvmpipe, softpipe and swr); then timer
    /// queries are wrong.
    [[nodiscard]] bool is_software() const;

    /// Returns errors and warnings since the last call, at most 64, without performance hints.
    /// Without KHR_debug, the errors of glGetError.
    [[nodiscard]] std::vector<DebugMessage> take_messages() const;

    /// \param doing  "uploading texture 'bricks.png'"
    /// \throws GpuError if OpenGL reported an error since the last check: "DOING: MESSAGE"
    void check(std::string_view doing) const;

    /// Returns the number of live OpenGL names, for finding leaks; the owners below count them.
    [[nodiscard]] std::size_t live_names() const { return live_names_; }
    void count_name(int change) const { live_names_ += static_cast<std::size_t>(change); }

  private:
    [[nodiscard]] std::string text(GLenum name) const;
    void collect_messages();
    void read_limits();

    GladGLContext table_{};
    Limits limits_;
    mutable std::vector<DebugMessage> messages_;
    mutable std::size_t live_names_ = 0;
};

/// Returns "GL_INVALID_OPERATION" and so on, or the number in hexadecimal if it is unknown.
std::string error_name(GLenum error);

// Owners of names

/// The owner of one OpenGL name: moved, never copied, deleted at the end of life. The context must
/// be current when an owner is made, replaced or destroyed, and must outlive it. An empty owner
/// holds 0.
///
/// \tparam Kind  creates and deletes a name: static create(api, ...) and destroy(api, name)
template <typename Kind>
class Handle {
  public:
    Handle() = default;

    /// Makes a name; a shader also needs its stage.
    template <typename... Arguments>
    explicit Handle(const Api& api, Arguments... arguments)
        : api_(&api), name_(Kind::create(api, arguments...)) {
        api.count_name(+1);
    }

    ~Handle() { reset(); }
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;
    Handle(Handle&& other) noexcept
        : api_(std::exchange(other.api_, nullptr)), name_(std::exchange(other.name_, 0)) {}
    Handle& operator=(Handle&& other) noexcept {
        if (this != &other) {
            reset();
            api_ = std::exchange(other.api_, nullptr);
            name_ = std::exchange(other.name_, 0);
        }
        return *this;
    }

    /// Returns the OpenGL name; 0 if empty.
    [[nodiscard]] GLuint name() const { return name_; }
    explicit operator bool() const { return name_ != 0; }

    /// Deletes the name and holds 0.
    void reset() noexcept {
        if (api_ == nullptr) return;
        Kind::destroy(*api_, name_);
        api_->count_name(-1);
        api_ = nullptr;
        name_ = 0;
    }

  private:
    const Api* api_ = nullptr;
    GLuint name_ = 0;
};

namespace kind {

/// The kinds that OpenGL creates and deletes in arrays.
template <auto Gen, auto Delete>
struct Generated {
    static GLuint create(const Api& api) {
        GLuint name = 0;
        (api.operator->()->*Gen)(1, &name);
        return name;
    }
    static void destroy(const Api& api, GLuint name) { (api.operator->()->*Delete)(1, &name); }
};

struct Program {
    static GLuint create(const Api& api) { return api->CreateProgram(); }
    static void destroy(const Api& api, GLuint name) { api->DeleteProgram(name); }
};

struct Shader {
    static GLuint create(const Api& api, GLenum stage) { return api->CreateShader(stage); }
    static void destroy(const Api& api, GLuint name) { api->DeleteShader(name); }
};

}  // namespace kind

using Buffer = Handle<kind::Generated<&GladGLContext::GenBuffers, &GladGLContext::DeleteBuffers>>;
using Texture =
    Handle<kind::Generated<&GladGLContext::GenTextures, &GladGLContext::DeleteTextures>>;
using Sampler =
    Handle<kind::Generated<&GladGLContext::GenSamplers, &GladGLContext::DeleteSamplers>>;
using VertexArray =
    Handle<kind::Generated<&GladGLContext::GenVertexArrays, &GladGLContext::DeleteVertexArrays>>;
using Framebuffer =
    Handle<kind::Generated<&GladGLContext::GenFramebuffers, &GladGLContext::DeleteFramebuffers>>;
using Renderbuffer =
    Handle<kind::Generated<&GladGLContext::GenRenderbuffers, &GladGLContext::DeleteRenderbuffers>>;
using Program = Handle<kind::Program>;
using Shader = Handle<kind::Shader>;

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

/// Returns all displays: the devices in EGL's order, then Mesa's surfaceless platform.
/// \throws GpuError if EGL is missing or offers none
std::vector<EglDisplay> egl_displays();

/// \throws GpuError saying why not
std::unique_ptr<PlatformContext> make_egl_context(const EglDisplay& display);

}  // namespace relief::shade::gl
