// SPDX-License-Identifier: Apache-2.0
// Contexts: which library serves, what is said where none can, and that several get along.
#include "relief/shade/context.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <thread>

#include "gl/resources.h"
#include "relief/shade/error.h"
#include "support/gl_environment.h"

namespace relief {
namespace {

using test::ScopedVariable;
using ::testing::AnyOf;
using ::testing::Eq;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* absent_osmesa = "libabsent-osmesa.so";
constexpr const char* absent_egl = "libabsent-egl.so";

std::string error_of(Backend backend) {
    try {
        const Context context(backend);
        return "no error, but " + context.backend_name();
    } catch (const GpuError& error) {
        return error.what();
    }
}

/// Clears a 2 x 2 picture to this level, and whether it reads back as that in every sample.
::testing::AssertionResult clears_to(const gl::Api& api, int level) {
    const gl::RenderTarget target(api, 2, 2, gl::ColorFormat::rgba8, 1);
    const float value = static_cast<float>(level) / 255.0F;
    api->ClearColor(value, value, value, value);
    api->Clear(GL_COLOR_BUFFER_BIT);
    const Image image = target.read(ColorSpace::data);
    for (const int sample : image.as<std::uint8_t>()) {
        if (sample != level) {
            return ::testing::AssertionFailure() << sample << " instead of " << level;
        }
    }
    return ::testing::AssertionSuccess();
}

class ContextOnEach : public test::GlTest {};
RELIEF_ON_EACH_BACKEND(ContextOnEach);

TEST_P(ContextOnEach, IsACoreProfileOf33OrMore) {
    GLint major = 0;
    GLint minor = 0;
    GLint profile = 0;
    api()->GetIntegerv(GL_MAJOR_VERSION, &major);
    api()->GetIntegerv(GL_MINOR_VERSION, &minor);
    api()->GetIntegerv(GL_CONTEXT_PROFILE_MASK, &profile);
    EXPECT_GE(10 * major + minor, 33);
    EXPECT_EQ(profile, GL_CONTEXT_CORE_PROFILE_BIT);
}

TEST_P(ContextOnEach, SaysWhatItIs) {
    if (GetParam() == Backend::osmesa) {
        EXPECT_EQ(context().backend_name(), "OSMesa");
        EXPECT_TRUE(api().is_software());
    } else {
        EXPECT_EQ(context().backend_name(),
                  api().is_software() ? "EGL (software)" : "EGL (hardware)");
    }
    EXPECT_EQ(context().renderer_name(), api().renderer() + ", " + api().version());
    EXPECT_THAT(api().renderer(), Not(Eq("")));
}

TEST_P(ContextOnEach, HasTheLimitsOfOpenGl33) {
    // The least values that the specification allows; 8192 etc. are what any driver has.
    const gl::Limits& limits = api().limits();
    EXPECT_GE(limits.texture_size, 1024);
    EXPECT_GE(limits.cube_size, 1024);
    EXPECT_GE(limits.renderbuffer_size, 1024);
    EXPECT_GE(limits.viewport_width, limits.renderbuffer_size);
    EXPECT_GE(limits.viewport_height, limits.renderbuffer_size);
    EXPECT_GE(limits.buffer_texels, 65536);
    EXPECT_GE(limits.uniform_block_bytes, 16384);
    EXPECT_GE(limits.texture_units, 16);
    EXPECT_GE(limits.samples, 4);
    EXPECT_GE(limits.anisotropy, 1.0F);
}

TEST_P(ContextOnEach, AnErrorIsToldOnceInTheDriversWords) {
    api()->Enable(0xDEAD);
    try {
        api().check("enabling nonsense");
        FAIL() << "the error went unnoticed";
    } catch (const GpuError& error) {
        EXPECT_THAT(error.what(), HasSubstr("enabling nonsense: "));
        EXPECT_THAT(error.what(), HasSubstr("GL_INVALID_ENUM"));
    }
    EXPECT_NO_THROW(api().check("doing nothing"));
}

TEST_P(ContextOnEach, MessagesAreBoundedInNumber) {
    for (int i = 0; i < 1000; ++i)
        api()->Enable(0xDEAD);
    const std::vector<gl::DebugMessage> messages = api().take_messages();
    EXPECT_GE(messages.size(), 1U);
    EXPECT_LE(messages.size(), 64U);
    EXPECT_TRUE(messages.front().error);
}

TEST_P(ContextOnEach, ASecondInTheSameThreadIsRefusedAndTheFirstLivesOn) {
    EXPECT_THROW(Context{GetParam()}, InvalidInput);
    EXPECT_THROW(Context{Backend::automatic}, InvalidInput);
    EXPECT_TRUE(clears_to(api(), 77));
}

TEST_P(ContextOnEach, DrawsInEveryOneOfASequence) {
    // The fixture's own context takes the place of the first.
    EXPECT_TRUE(clears_to(api(), 10));
    std::thread([&] {
        for (int level = 20; level < 200; level += 30) {
            const Context context(GetParam());
            EXPECT_TRUE(clears_to(context.api(), level));
        }
    }).join();
    EXPECT_TRUE(clears_to(api(), 11));
}

TEST(Context, BackendsTakeTurnsInOneThread) {
    if (!test::is_installed(Backend::osmesa)) GTEST_SKIP() << "needs OSMesa";
    if (!test::is_installed(Backend::egl)) GTEST_SKIP() << "needs EGL";
    for (int round = 0; round < 3; ++round) {
        for (const Backend backend : {Backend::osmesa, Backend::egl}) {
            const Context context(backend);
            EXPECT_TRUE(clears_to(context.api(), 40 + round));
        }
    }
}

TEST(Context, ThreadsDrawAtOnceEachInItsOwn) {
    if (!test::is_installed(Backend::osmesa)) GTEST_SKIP() << "needs OSMesa";
    if (!test::is_installed(Backend::egl)) GTEST_SKIP() << "needs EGL";
    const std::array<Backend, 4> backends{Backend::osmesa, Backend::egl, Backend::osmesa,
                                          Backend::egl};
    std::array<int, 4> right{};
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < backends.size(); ++i) {
        threads.emplace_back([&, i] {
            const Context context(backends.at(i));
            for (int round = 0; round < 50; ++round) {
                right.at(i) += clears_to(context.api(), static_cast<int>(60 * i) + round) ? 1 : 0;
            }
        });
    }
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_THAT(right, ::testing::Each(50));
}

TEST(Context, WithoutOsmesaEglServes) {
    if (!test::is_installed(Backend::egl)) GTEST_SKIP() << "needs EGL";
    const ScopedVariable osmesa("RELIEF_OSMESA_LIBRARY", absent_osmesa);
    const Context context;
    EXPECT_THAT(context.backend_name(), AnyOf("EGL (software)", "EGL (hardware)"));
    EXPECT_TRUE(clears_to(context.api(), 123));
}

TEST(Context, WithoutEglOsmesaServes) {
    if (!test::is_installed(Backend::osmesa)) GTEST_SKIP() << "needs OSMesa";
    const ScopedVariable egl("RELIEF_EGL_LIBRARY", absent_egl);
    const Context context;
    EXPECT_EQ(context.backend_name(), "OSMesa");
    EXPECT_TRUE(clears_to(context.api(), 123));
}

TEST(Context, AutomaticTakesOsmesaUnlessThereIsHardware) {
    if (!test::is_installed(Backend::osmesa)) GTEST_SKIP() << "needs OSMesa";
    EXPECT_THAT(Context().backend_name(), AnyOf("OSMesa", "EGL (hardware)"));
}

TEST(Context, WithoutAnyTheErrorSaysWhyForEachInTheOrderTried) {
    const ScopedVariable osmesa("RELIEF_OSMESA_LIBRARY", absent_osmesa);
    const ScopedVariable egl("RELIEF_EGL_LIBRARY", absent_egl);
    EXPECT_EQ(error_of(Backend::automatic),
              "no OpenGL 3.3 context could be made: "
              "EGL (hardware): libabsent-egl.so: cannot open shared object file: No such file or "
              "directory (RELIEF_EGL_LIBRARY is set); "
              "OSMesa: libabsent-osmesa.so: cannot open shared object file: No such file or "
              "directory (RELIEF_OSMESA_LIBRARY is set); "
              "EGL (software): libabsent-egl.so: cannot open shared object file: No such file or "
              "directory (RELIEF_EGL_LIBRARY is set)");
}

TEST(Context, ABackendAskedForByNameIsNotReplacedByAnother) {
    {
        const ScopedVariable osmesa("RELIEF_OSMESA_LIBRARY", absent_osmesa);
        EXPECT_THAT(error_of(Backend::osmesa),
                    AllOf(HasSubstr("OSMesa: libabsent-osmesa.so"), Not(HasSubstr("EGL"))));
    }
    const ScopedVariable egl("RELIEF_EGL_LIBRARY", absent_egl);
    EXPECT_THAT(error_of(Backend::egl),
                AllOf(HasSubstr("EGL (software): libabsent-egl.so"), Not(HasSubstr("OSMesa"))));
}

TEST(Context, ALibraryThatIsSomethingElseIsNamedWithWhatItLacks) {
    const ScopedVariable osmesa("RELIEF_OSMESA_LIBRARY", "libm.so.6");
    const ScopedVariable egl("RELIEF_EGL_LIBRARY", "libm.so.6");
    EXPECT_THAT(error_of(Backend::osmesa),
                HasSubstr("OSMesa: libm.so.6 has no function OSMesaCreateContextAttribs"));
    EXPECT_THAT(error_of(Backend::egl),
                HasSubstr("EGL (hardware): libm.so.6 has no function eglGetProcAddress"));
}

TEST(Context, AnEmptyVariableNamesNoLibrary) {
    if (!test::is_installed(Backend::osmesa)) GTEST_SKIP() << "needs OSMesa";
    const ScopedVariable osmesa("RELIEF_OSMESA_LIBRARY", "");
    EXPECT_EQ(Context(Backend::osmesa).backend_name(), "OSMesa");
}

TEST(Context, AFailureLeavesTheThreadFreeForAnother) {
    if (!test::is_installed(Backend::osmesa)) GTEST_SKIP() << "needs OSMesa";
    {
        const ScopedVariable osmesa("RELIEF_OSMESA_LIBRARY", absent_osmesa);
        EXPECT_THROW(Context{Backend::osmesa}, GpuError);
    }
    EXPECT_TRUE(clears_to(Context(Backend::osmesa).api(), 200));
}

}  // namespace
}  // namespace relief
