// SPDX-License-Identifier: Apache-2.0
/// \file
/// Tests that draw: one context for each suite, which every test must leave as it found it.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <iosfwd>
#include <memory>
#include <optional>
#include <string>

#include "gl/api.h"
#include "gl/program.h"
#include "relief/shade/context.h"

namespace relief {
void PrintTo(Backend backend,
             std::ostream* out);  // NOLINT(readability-identifier-naming): gtest's.
}

namespace relief::test {

/// A context, or nothing where the backend's library is not installed; any other failure throws.
std::unique_ptr<Context> context_if_installed(Backend backend);

bool is_installed(Backend backend);

/// OSMesa; EGL, and with it the machine's GPU, if RELIEF_TEST_BACKEND is "egl".
Backend default_backend();

/// "osmesa" or "egl".
std::string backend_name(const ::testing::TestParamInfo<Backend>& info);

/// The context that the tests of a suite share, made when the first asks for it; null where the
/// backend is not installed. There is one at a time: another backend replaces it.
const Context* shared_context(Backend backend);

/// Destroys the shared context, so that its thread may have another. Each suite calls it at its
/// end.
void release_shared_context();

/// Fails the test if OpenGL reported an error or a warning, if a GL name outlives the test, or if
/// the state of the shared context is not that of a new context. After a failure, the next test
/// gets a new context.
void expect_clean_context();

/// A test with a context of its parameter's backend, shared with the tests of its suite: skipped
/// where the backend is not installed.
class GlTest : public ::testing::TestWithParam<Backend> {
  protected:
    static void TearDownTestSuite() { release_shared_context(); }
    void SetUp() override;
    void TearDown() override;

    [[nodiscard]] const Context& context() const { return *context_; }
    [[nodiscard]] const gl::Api& api() const { return context_->api(); }

  private:
    const Context* context_ = nullptr;
};

/// Draws one triangle over all of the bound target.
///
/// \param fragment  a whole fragment shader, without its #version line
/// \param prepare  called with the program current, to set uniforms and bind textures
void cover(const gl::Api& api, const std::string& fragment,
           const std::function<void(const gl::LinkedProgram&)>& prepare = {});

/// Sets an environment variable for a while.
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

/// Runs the tests of a suite derived from GlTest on default_backend(). Without a GPU both backends
/// draw by the same code of Mesa; what may differ between them are contexts.
#define RELIEF_ON_DEFAULT_BACKEND(suite)                                                    \
    INSTANTIATE_TEST_SUITE_P(On, suite, ::testing::Values(relief::test::default_backend()), \
                             relief::test::backend_name)

/// Runs the tests of a suite derived from GlTest on every backend.
#define RELIEF_ON_EACH_BACKEND(suite)                                                          \
    INSTANTIATE_TEST_SUITE_P(On, suite,                                                        \
                             ::testing::Values(relief::Backend::osmesa, relief::Backend::egl), \
                             relief::test::backend_name)
