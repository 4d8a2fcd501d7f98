// SPDX-License-Identifier: Apache-2.0
/// \file
/// Tests that draw. A suite shares one context, and every test must restore its state.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <iosfwd>
#include <memory>
#include <optional>
#include <string>

#include "gl/api.h"
#include "gl/program.h"
#include "relief/shade/renderer.h"

namespace relief::shade {
void PrintTo(Backend backend,
             std::ostream* out);  // NOLINT(readability-identifier-naming): gtest's.
}  // namespace relief::shade

namespace relief::test {

/// Returns a context, or null if the library of the backend is not installed. Any other failure
/// throws.
std::unique_ptr<shade::Context> context_if_installed(shade::Backend backend);

bool is_installed(shade::Backend backend);

/// OSMesa, or EGL on the GPU of the machine if RELIEF_TEST_BACKEND is "egl".
shade::Backend default_backend();

/// "osmesa" or "egl".
std::string backend_name(const ::testing::TestParamInfo<shade::Backend>& info);

/// The context that the tests of a suite share. The first test creates it. It is null if the
/// backend is not installed. Only one context exists; another backend replaces it.
const shade::Context* shared_context(shade::Backend backend);

/// Destroys the shared context, so that its thread may have another. Each suite calls it at its
/// end.
void release_shared_context();

/// Fails the test if OpenGL reported an error or a warning, if a GL name outlives the test, or if
/// the state of the shared context differs from that of a new context. After a failure, the next
/// test gets a new context.
void expect_clean_context();

/// A test with a context of its parameter's backend, shared with the tests of its suite. It is
/// skipped if the backend is not installed.
class GlTest : public ::testing::TestWithParam<shade::Backend> {
  protected:
    static void TearDownTestSuite() { release_shared_context(); }
    void SetUp() override;
    void TearDown() override;

    [[nodiscard]] const shade::Context& context() const { return *context_; }
    [[nodiscard]] const shade::gl::Api& api() const { return context_->api(); }

  private:
    const shade::Context* context_ = nullptr;
};

/// Draws one triangle that covers the bound target.
///
/// \param fragment  a whole fragment shader without its #version line
/// \param prepare  called with the program current, to set uniforms and bind textures
void cover(const shade::gl::Api& api, const std::string& fragment,
           const std::function<void(const shade::gl::LinkedProgram&)>& prepare = {});

/// Sets an environment variable and restores it in the destructor.
class ScopedVariable {
  public:
    ScopedVariable(const char* name, const char* value);
    ~ScopedVariable();
    ScopedVariable(const ScopedVariable&) = delete;
    ScopedVariable& operator=(const ScopedVariable&) = delete;

  private:
    std::string name_;
    std::optional<std::string> before_;
};

}  // namespace relief::test

/// Runs the tests of a suite derived from GlTest on default_backend(). Without a GPU, both backends
/// draw with the same code of Mesa; only their contexts differ.
#define RELIEF_ON_DEFAULT_BACKEND(suite)                                                    \
    INSTANTIATE_TEST_SUITE_P(On, suite, ::testing::Values(relief::test::default_backend()), \
                             relief::test::backend_name)

/// Runs the tests of a suite derived from GlTest on every backend.
#define RELIEF_ON_EACH_BACKEND(suite)                                                              \
    INSTANTIATE_TEST_SUITE_P(                                                                      \
        On, suite, ::testing::Values(relief::shade::Backend::osmesa, relief::shade::Backend::egl), \
        relief::test::backend_name)
