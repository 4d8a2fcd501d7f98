// SPDX-License-Identifier: Apache-2.0
// Contexts: the choice of the library and of the EGL device, error messages, several contexts at
// once, and equal pictures for every number of threads. EGL devices are staged (staged_egl.cpp);
// pictures come from separate processes (fingerprint.cpp), because Mesa reads its environment
// once.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <utility>

#include "gl/resources.h"
#include "relief/shade/renderer.h"
#include "support/gl_environment.h"
#include "support/labels.h"

namespace relief {
using namespace relief::shade;

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

/// Clears a 2 x 2 image to this level and returns whether every sample reads back as that level.
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

TEST_P(ContextOnEach, DescribesItself) {
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
    // The minimum values of the specification. Every driver supports 8192 and so on.
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

TEST_P(ContextOnEach, ReportsAnErrorOnceWithTheDriversMessage) {
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
    // The context of the fixture replaces the first one.
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

TEST(Context, AutomaticUsesOsmesaWithoutHardware) {
    if (!test::is_installed(Backend::osmesa)) GTEST_SKIP() << "needs OSMesa";
    EXPECT_THAT(Context().backend_name(), AnyOf("OSMesa", "EGL (hardware)"));
}

TEST(Context, ErrorListsTheReasonOfEachLibrary) {
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

TEST(Context, ErrorNamesMissingFunctionsOfALibrary) {
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

class EglDevices : public ::testing::Test {
  protected:
    void SetUp() override {
        const auto real = test::context_if_installed(Backend::egl);
        if (!real || !real->api().is_software()) GTEST_SKIP() << "needs software EGL";
    }

    /// Returns "BACKEND: RENDERER" of the context created with these devices, or the error.
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

TEST_F(EglDevices, AutomaticUsesOsmesaWithoutHardware) {
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
    // Under its correct name, software, it would be accepted. As hardware it is refused.
    EXPECT_THAT(outcome("alone adapter"), HasSubstr("device 0: it is drawn by llvmpipe"));
}

std::string run_fingerprint(const std::string& environment, const std::string& backend) {
    const std::string command = fmt::format("env MESA_SHADER_CACHE_DISABLE=true {} '{}' {}",
                                            environment, RELIEF_GL_FINGERPRINT, backend);
    const auto close = [](std::FILE* stream) { pclose(stream); };
    const std::unique_ptr<std::FILE, decltype(close)> stream(popen(command.c_str(), "r"), close);
    std::string output;
    std::array<char, 256> piece{};
    while (std::fgets(piece.data(), piece.size(), stream.get()) != nullptr)
        output += piece.data();
    return output;
}

/// Returns the output of gl_fingerprint under this environment: "A=1 B=2". It runs once for all
/// tests, because the driver compiles its shaders in each process.
const std::string& fingerprint(const std::string& environment, const std::string& backend) {
    static std::map<std::pair<std::string, std::string>, std::string> outputs;
    const auto [output, is_new] = outputs.try_emplace({environment, backend});
    if (is_new) output->second = run_fingerprint(environment, backend);
    return output->second;
}

/// Removes the line about loaded libraries.
std::string hashes(const std::string& output) {
    return output.substr(0, output.find("loaded:"));
}

TEST_LABELS(not_sanitized);
TEST(Determinism, TheNumberOfThreadsChangesNoBit) {
    if (test::is_installed(Backend::osmesa)) {
        const std::string one = hashes(fingerprint("LP_NUM_THREADS=0", "osmesa"));
        EXPECT_THAT(one, HasSubstr("32 bits, 4 samples: "));
        EXPECT_EQ(hashes(fingerprint("LP_NUM_THREADS=1", "osmesa")), one);
        EXPECT_EQ(hashes(fingerprint("LP_NUM_THREADS=4", "osmesa")), one);
    }
    // Software EGL has the same rasterizer: the number that users have suffices.
    if (test::is_installed(Backend::egl)) {
        const std::string one = hashes(fingerprint("LP_NUM_THREADS=0", "egl"));
        EXPECT_THAT(one, HasSubstr("32 bits, 4 samples: "));
        EXPECT_EQ(hashes(fingerprint("", "egl")), one);
    }
}

TEST_LABELS(not_sanitized);
TEST(Determinism, OsmesaAndSoftwareEglDrawTheSameBits) {
    {
        const auto egl = test::context_if_installed(Backend::egl);
        if (!egl || !egl->api().is_software()) GTEST_SKIP() << "needs software EGL";
    }
    const std::string osmesa = fingerprint("LP_NUM_THREADS=0", "osmesa");
    if (osmesa.find("cannot open shared object") != std::string::npos) {
        GTEST_SKIP() << "needs OSMesa";
    }
    EXPECT_EQ(hashes(fingerprint("LP_NUM_THREADS=0", "egl")), hashes(osmesa));
}

TEST(Determinism, LibrariesAreLoadedSeparately) {
    for (const auto& [backend, expected] :
         {std::pair{"osmesa", "loaded: OSMesa\n"}, std::pair{"egl", "loaded: EGL\n"}}) {
        const std::string output = fingerprint("", backend);
        const bool is_absent = output.find("cannot open shared object") != std::string::npos;
        if (!is_absent) {
            EXPECT_THAT(output, HasSubstr(expected));
        }
    }
}

}  // namespace
}  // namespace relief
