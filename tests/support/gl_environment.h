// SPDX-License-Identifier: Apache-2.0
/// \file
/// Tests that draw: one context a test, on every backend that the machine has.
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

/// "osmesa" or "egl".
std::string backend_name(const ::testing::TestParamInfo<Backend>& info);

/// A test with a context of its parameter's backend: skipped, with a word, where that is not
/// installed; failed if OpenGL reports an error or a warning, or if a GL name outlives it.
class GlTest : public ::testing::TestWithParam<Backend> {
  protected:
    void SetUp() override;
    void TearDown() override;

    [[nodiscard]] const Context& context() const { return *context_; }
    [[nodiscard]] const gl::Api& api() const { return context_->api(); }

  private:
    std::unique_ptr<Context> context_;
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

/// Runs the tests of a suite derived from GlTest on every backend.
#define RELIEF_ON_EACH_BACKEND(suite)                                                          \
    INSTANTIATE_TEST_SUITE_P(On, suite,                                                        \
                             ::testing::Values(relief::Backend::osmesa, relief::Backend::egl), \
                             relief::test::backend_name)
