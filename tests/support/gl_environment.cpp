// SPDX-License-Identifier: Apache-2.0
#include "support/gl_environment.h"

#include <array>
#include <cstdlib>
#include <initializer_list>
#include <map>
#include <ostream>
#include <utility>
#include <vector>

#include "gl/api.h"
#include "relief/shade/renderer.h"

namespace relief::shade {
void PrintTo(Backend backend, std::ostream* out) {
    *out << (backend == Backend::osmesa ? "osmesa" : "egl");
}
}  // namespace relief::shade

namespace relief::test {
using namespace relief::shade;

std::unique_ptr<Context> context_if_installed(Backend backend) {
    try {
        return std::make_unique<Context>(backend);
    } catch (const GpuError& error) {
        const std::string message = error.what();
        if (message.find("cannot open shared object file") != std::string::npos) return nullptr;
        throw;
    }
}

bool is_installed(Backend backend) {
    return context_if_installed(backend) != nullptr;
}

Backend default_backend() {
    const char* asked = std::getenv("RELIEF_TEST_BACKEND");
    return asked != nullptr && std::string(asked) == "egl" ? Backend::egl : Backend::osmesa;
}

std::string backend_name(const ::testing::TestParamInfo<Backend>& info) {
    return info.param == Backend::osmesa ? "osmesa" : "egl";
}

namespace {

/// Each draw call sets these, and nothing resets them.
void reset_state_of_each_draw(const gl::Api& api) {
    api->UseProgram(0);
    api->BindVertexArray(0);
    api->Disable(GL_CULL_FACE);
    api->Disable(GL_DEPTH_TEST);
}

/// Name and value of each part of the state that a test must restore.
using GlState = std::map<std::string, std::vector<GLint>>;

GlState state_of(const gl::Api& api) {
    struct Named {
        GLenum what;
        const char* name;
    };
    GlState state;
    for (const auto& [what, name] :
         std::initializer_list<Named>{{GL_DRAW_FRAMEBUFFER_BINDING, "draw framebuffer"},
                                      {GL_READ_FRAMEBUFFER_BINDING, "read framebuffer"},
                                      {GL_RENDERBUFFER_BINDING, "renderbuffer"},
                                      {GL_ARRAY_BUFFER_BINDING, "array buffer"},
                                      {GL_UNIFORM_BUFFER_BINDING, "uniform buffer"},
                                      {GL_PIXEL_PACK_BUFFER_BINDING, "pixel pack buffer"},
                                      {GL_PIXEL_UNPACK_BUFFER_BINDING, "pixel unpack buffer"},
                                      {GL_PACK_ALIGNMENT, "pack alignment"},
                                      {GL_UNPACK_ALIGNMENT, "unpack alignment"},
                                      {GL_UNPACK_ROW_LENGTH, "unpack row length"},
                                      {GL_BLEND, "blending"},
                                      {GL_DEPTH_CLAMP, "depth clamp"},
                                      {GL_DEPTH_WRITEMASK, "depth mask"},
                                      {GL_SCISSOR_TEST, "scissor test"},
                                      {GL_STENCIL_TEST, "stencil test"},
                                      {GL_POLYGON_OFFSET_FILL, "polygon offset"},
                                      {GL_FRAMEBUFFER_SRGB, "sRGB framebuffer"},
                                      {GL_SAMPLE_ALPHA_TO_COVERAGE, "alpha to coverage"},
                                      {GL_RASTERIZER_DISCARD, "rasterizer discard"},
                                      {GL_TEXTURE_CUBE_MAP_SEAMLESS, "seamless cube maps"}}) {
        GLint value = 0;
        api->GetIntegerv(what, &value);
        state[name] = {value};
    }
    std::array<GLint, 4> mask{};
    api->GetIntegerv(GL_COLOR_WRITEMASK, mask.data());
    state["color mask"] = {mask.begin(), mask.end()};
    return state;
}

struct SharedContext {
    Backend backend = Backend::automatic;
    std::unique_ptr<Context> context;
    GlState new_state;  ///< The state of the context after its creation.
};

SharedContext& shared() {
    static SharedContext one;
    return one;
}

}  // namespace

const Context* shared_context(Backend backend) {
    SharedContext& one = shared();
    if (one.context && one.backend == backend) return one.context.get();
    one = {};
    std::unique_ptr<Context> made = context_if_installed(backend);
    if (!made) return nullptr;
    GlState state = state_of(made->api());
    one = {backend, std::move(made), std::move(state)};
    return one.context.get();
}

void release_shared_context() {
    shared() = {};
}

void expect_clean_context() {
    const SharedContext& one = shared();
    if (!one.context) return;
    bool is_clean = true;
    const gl::Api& api = one.context->api();
    reset_state_of_each_draw(api);
    for (const gl::DebugMessage& message : api.take_messages()) {
        ADD_FAILURE() << "OpenGL: " << message.text;
        is_clean = false;
    }
    if (api.live_names() != 0) {
        ADD_FAILURE() << api.live_names() << " GL names outlive the test";
        is_clean = false;
    }
    for (const auto& [name, value] : state_of(api)) {
        if (value == one.new_state.at(name)) continue;
        ADD_FAILURE() << "the test left the OpenGL state " << name << " at "
                      << ::testing::PrintToString(value) << " instead of "
                      << ::testing::PrintToString(one.new_state.at(name));
        is_clean = false;
    }
    if (!is_clean) release_shared_context();
}

void GlTest::SetUp() {
    context_ = shared_context(GetParam());
    if (context_ == nullptr) GTEST_SKIP() << "the library of this backend is not installed";
}

void GlTest::TearDown() {
    if (context_ != nullptr) expect_clean_context();
}

void cover(const gl::Api& api, const std::string& fragment,
           const std::function<void(const gl::LinkedProgram&)>& prepare) {
    const std::string vertex = R"(#version 330 core
void main() {
    gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
)";
    const gl::LinkedProgram program(
        api, {"covering test program", vertex, "#version 330 core\n" + fragment, {}, {}});
    const gl::VertexArray no_vertices(api);
    api->BindVertexArray(no_vertices.name());
    program.use();
    if (prepare) prepare(program);
    api->DrawArrays(GL_TRIANGLES, 0, 3);
    api->UseProgram(0);
    api->BindVertexArray(0);
}

ScopedVariable::ScopedVariable(const char* name, const char* value) : name_(name) {
    if (const char* before = std::getenv(name); before != nullptr) before_ = before;
    setenv(name, value, 1);
}

ScopedVariable::~ScopedVariable() {
    if (before_) {
        setenv(name_.c_str(), before_->c_str(), 1);
    } else {
        unsetenv(name_.c_str());
    }
}

}  // namespace relief::test
