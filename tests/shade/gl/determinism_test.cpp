// SPDX-License-Identifier: Apache-2.0
// The same picture, bit for bit, whatever the number of Mesa's threads and whichever library the
// context came from. Each is drawn by a process of its own (fingerprint.cpp), since Mesa reads its
// environment once.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>

#include "support/gl_environment.h"

namespace relief {
namespace {

using ::testing::HasSubstr;

/// What gl_fingerprint prints under this environment: "A=1 B=2".
std::string fingerprint(const std::string& environment, const std::string& backend) {
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

/// Without the line about loaded libraries.
std::string hashes(const std::string& output) {
    return output.substr(0, output.find("loaded:"));
}

TEST(Determinism, TheNumberOfThreadsChangesNoBit) {
    for (const char* backend : {"osmesa", "egl"}) {
        const bool is_osmesa = std::string(backend) == "osmesa";
        if (!test::is_installed(is_osmesa ? Backend::osmesa : Backend::egl)) continue;
        const std::string one = hashes(fingerprint("LP_NUM_THREADS=0", backend));
        EXPECT_THAT(one, HasSubstr("32 bits, 4 samples: "));
        EXPECT_EQ(hashes(fingerprint("LP_NUM_THREADS=1", backend)), one);
        EXPECT_EQ(hashes(fingerprint("LP_NUM_THREADS=4", backend)), one);
        EXPECT_EQ(hashes(fingerprint("", backend)), one);
    }
}

TEST(Determinism, OsmesaAndSoftwareEglDrawTheSameBits) {
    {
        const auto egl = test::context_if_installed(Backend::egl);
        if (!egl || !egl->api().is_software()) GTEST_SKIP() << "needs software EGL";
    }
    const std::string osmesa = fingerprint("", "osmesa");
    if (osmesa.find("cannot open shared object") != std::string::npos) {
        GTEST_SKIP() << "needs OSMesa";
    }
    EXPECT_EQ(hashes(fingerprint("", "egl")), hashes(osmesa));
}

TEST(Determinism, NeitherLibraryIsLoadedForTheOther) {
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
