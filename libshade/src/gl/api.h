// SPDX-License-Identifier: Apache-2.0
/// \file
/// The OpenGL entry points of one context, and what its driver complained about.
///
/// OSMesa's functions differ from EGL's, and calling one with the other current is silently
/// nothing. So there is no global table: whoever calls OpenGL is handed the Api of its context.
/// Tests: tests/shade/gl/context_test.cpp.
#pragma once

#include <glad/gl.h>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace relief::gl {

/// What the driver said through KHR_debug.
struct DebugMessage {
    bool error = false;  ///< An OpenGL error, not a warning or a hint.
    std::string text;
};

/// What the context can hold.
struct Limits {
    int texture_size = 0;       ///< Texels along a side of a 2D texture.
    int cube_size = 0;          ///< Texels along a side of a cube face.
    int renderbuffer_size = 0;  ///< Pixels along a side.
    int viewport_width = 0;
    int viewport_height = 0;
    int buffer_texels = 0;        ///< Of a buffer texture.
    int uniform_block_bytes = 0;  ///< Of one uniform block.
    int texture_units = 0;        ///< Of a fragment shader.
    int samples = 0;              ///< Per pixel.
    float anisotropy = 1.0F;      ///< 1 where filtering is isotropic only, or wrong otherwise.
};

/// The table of one context: `api->Clear(...)`.
///
/// Only OpenGL 3.3 core is called without asking; the rest only where has_...() says so.
class Api {
  public:
    using Loader = GLADapiproc (*)(const char* name);

    /// Loads the table of the context that is current, and sets the two states that hold for all of
    /// relief: seamless cube maps, tightly packed rows in uploads and readbacks.
    /// \throws GpuError if it offers less than OpenGL 3.3
    explicit Api(Loader loader);
    ~Api();
    Api(const Api&) = delete;
    Api& operator=(const Api&) = delete;

    const GladGLContext* operator->() const { return &table_; }

    [[nodiscard]] bool has_debug_messages() const { return table_.KHR_debug != 0; }
    [[nodiscard]] const Limits& limits() const { return limits_; }
    /// GL_RENDERER and GL_VERSION.
    [[nodiscard]] std::string renderer() const { return text(GL_RENDERER); }
    [[nodiscard]] std::string version() const { return text(GL_VERSION); }
    /// Rasterised by the processor (Mesa's llvmpipe, softpipe and swr): no timer queries.
    [[nodiscard]] bool is_software() const;

    /// Errors and warnings since the last call, at most 64; hints of performance are not among
    /// them. Where there is no KHR_debug, what glGetError says.
    [[nodiscard]] std::vector<DebugMessage> take_messages() const;

    /// \param doing  "uploading texture 'bricks.png'"
    /// \throws GpuError if OpenGL reported an error since the last check: "DOING: WHAT IT SAID"
    void check(std::string_view doing) const;

    /// GL names that live, for finding leaks: counted by the owners in handle.h.
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

/// "GL_INVALID_OPERATION" and so on; hexadecimal where unknown.
std::string error_name(GLenum error);

}  // namespace relief::gl
