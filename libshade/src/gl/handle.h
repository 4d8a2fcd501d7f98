// SPDX-License-Identifier: Apache-2.0
/// \file
/// Owners of OpenGL names: one name each, moved, never copied, deleted at the end of life.
///
/// The context must be current when an owner is made, replaced or destroyed, and must outlive it.
/// An empty owner holds 0. Tests: tests/shade/gl/handle_test.cpp.
#pragma once

#include <utility>

#include "gl/api.h"

namespace relief::gl {

/// \tparam Kind  how a name is made and deleted: static create(api, ...) and destroy(api, name)
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

    /// The OpenGL name; 0 if empty.
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

/// The kinds that OpenGL makes and deletes in arrays.
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

}  // namespace relief::gl
