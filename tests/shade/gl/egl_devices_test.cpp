// SPDX-License-Identifier: Apache-2.0
// Which of EGL's devices is taken, and what is said of the others, on machines unlike this one: the
// devices are staged (staged_egl.cpp), what they draw with is the real library.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "relief/shade/context.h"
#include "relief/shade/error.h"
#include "support/gl_environment.h"

namespace relief {
namespace {

using test::ScopedVariable;
using ::testing::HasSubstr;

class EglDevices : public ::testing::Test {
  protected:
    void SetUp() override {
        const auto real = test::context_if_installed(Backend::egl);
        if (!real || !real->api().is_software()) GTEST_SKIP() << "needs software EGL";
    }

    /// "BACKEND: RENDERER" of the context made with these devices, or the error.
    static std::string outcome(const char* devices, Backend backend = Backend::egl) {
        const ScopedVariable library("RELIEF_EGL_LIBRARY", RELIEF_STAGED_EGL);
        const ScopedVariable staged("STAGED_EGL_DEVICES", devices);
        try {
            const Context context(backend);
            return context.backend_name() + ": " + context.api().renderer();
        } catch (const GpuError& error) {
            return error.what();
        }
    }
};

TEST_F(EglDevices, AGpuIsTakenBeforeAnythingElse) {
    EXPECT_EQ(outcome("gpu"), "EGL (hardware): Staged GPU");
    EXPECT_EQ(outcome("software gpu"), "EGL (hardware): Staged GPU");
    EXPECT_EQ(outcome("software gpu", Backend::automatic), "EGL (hardware): Staged GPU");
}

TEST_F(EglDevices, AGpuThatDoesNotServeGivesWayToTheNext) {
    EXPECT_EQ(outcome("broken windowed old es gpu"), "EGL (hardware): Staged GPU");
}

TEST_F(EglDevices, AnAdapterWithoutADriverIsNotTakenForHardware) {
    EXPECT_EQ(outcome("adapter gpu"), "EGL (hardware): Staged GPU");
    EXPECT_THAT(outcome("adapter software"), HasSubstr("EGL (software): llvmpipe"));
}

TEST_F(EglDevices, WithoutHardwareAutomaticTakesOsmesa) {
    if (!test::is_installed(Backend::osmesa)) GTEST_SKIP() << "needs OSMesa";
    EXPECT_THAT(outcome("broken adapter software", Backend::automatic), HasSubstr("OSMesa: "));
}

TEST_F(EglDevices, WithoutAListOfDevicesTheSurfacelessPlatformServes) {
    EXPECT_THAT(outcome(""), HasSubstr("EGL (software): llvmpipe"));
}

TEST_F(EglDevices, EveryOneThatFailedIsNamedWithItsReason) {
    const ScopedVariable osmesa("RELIEF_OSMESA_LIBRARY", "libabsent-osmesa.so");
    EXPECT_EQ(outcome("alone broken windowed old es", Backend::automatic),
              "no OpenGL 3.3 context could be made: "
              "EGL (hardware): device 0: eglInitialize: EGL_NOT_INITIALIZED; "
              "EGL (hardware): device 1: it lacks EGL_KHR_surfaceless_context; "
              "EGL (hardware): device 2: it gives no OpenGL 3.3 core context: EGL_BAD_MATCH; "
              "EGL (hardware): device 3: it has no OpenGL, only OpenGL ES; "
              "OSMesa: libabsent-osmesa.so: cannot open shared object file: No such file or "
              "directory (RELIEF_OSMESA_LIBRARY is set); "
              "EGL (software): there is no such device");
}

TEST_F(EglDevices, TheReasonForRefusingAnAdapterNamesItsRasteriser) {
    // Asked for by its right name, software, it would serve; as hardware it is refused.
    EXPECT_THAT(outcome("alone adapter"), HasSubstr("device 0: it is drawn by llvmpipe"));
}

}  // namespace
}  // namespace relief
