// SPDX-License-Identifier: Apache-2.0
// Contexts for tests, and what they have in common. See gl_environment.h.
#include "support/gl_environment.h"

#include <cstdlib>
#include <ostream>

#include "gl/handle.h"
#include "relief/shade/error.h"

namespace relief {

void PrintTo(Backend backend, std::ostream* out) {
    *out << (backend == Backend::osmesa ? "osmesa" : "egl");
}

}  // namespace relief

namespace relief::test {

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

std::string backend_name(const ::testing::TestParamInfo<Backend>& info) {
    return info.param == Backend::osmesa ? "osmesa" : "egl";
}

void GlTest::SetUp() {
    context_ = context_if_installed(GetParam());
    if (!context_) GTEST_SKIP() << "the library of this backend is not installed";
}

void GlTest::TearDown() {
    if (!context_) return;
    for (const gl::DebugMessage& message : api().take_messages()) {
        ADD_FAILURE() << "OpenGL: " << message.text;
    }
    EXPECT_EQ(api().live_names(), 0U);
    context_.reset();
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
