// SPDX-License-Identifier: Apache-2.0
// Commands write the same bytes on a processor without wide vectors and fused multiplication: the C
// library, Embree and relief's own loops choose other code there.
#include <gtest/gtest.h>

#include "support/labels.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using test::ProgramResult;
using test::Workplace;

/// Glibc's names of what it is not to use. Embree's least is SSE2.
const std::string plain_processor =
    "GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX512F,-AVX512VL,-AVX2,-FMA,-AVX,-SSE4_2 "
    "RELIEF_VECTOR_BITS=128 RELIEF_EMBREE=isa=sse2 ";

/// OUT stands for the file that a command writes.
std::string with_output(std::string command, const std::string& name) {
    return command.replace(command.find("OUT"), 3, "out/" + name);
}

void expect_same_bytes(const Workplace& workplace, const std::string& command,
                       const std::string& ending) {
    for (const bool is_plain : {false, true}) {
        const std::string name = (is_plain ? "plain" : "own") + ending;
        const ProgramResult result =
            workplace.run((is_plain ? plain_processor : "") + with_output(command, name));
        ASSERT_EQ(result.exit_code, 0) << command << ": " << result.error;
    }
    const std::string own = workplace.read("out/own" + ending);
    EXPECT_FALSE(own.empty());
    EXPECT_TRUE(own == workplace.read("out/plain" + ending)) << command;
}

TEST_LABELS(not_sanitized);
TEST(Processors, MapsHaveTheSameBytes) {
    const Workplace workplace;
    workplace.shrink_bricks();
    for (const char* kernel : {"sobel5", "gaussian --kernel-radius 3"}) {
        expect_same_bytes(workplace,
                          std::string("relief-bake bump data/bricks-height.png OUT --strength 16 "
                                      "--quiet --bits 16 --kernel ") +
                              kernel,
                          ".png");
    }
    expect_same_bytes(workplace,
                      "relief-bake heights data/scenes/bricks-normal.png OUT --quiet --bits 16",
                      ".png");
    expect_same_bytes(
        workplace,
        "relief-bake convert data/scenes/bricks-normal.png OUT --resize 100x60 --bits "
        "16 --quiet",
        ".png");
    expect_same_bytes(workplace,
                      "relief-bake mesh data/urn-high.ply data/urn-low.obj out/normals.exr --size "
                      "96 --samples 4 --quiet --occlusion-map OUT --layer-bits 32",
                      ".exr");
    expect_same_bytes(workplace,
                      "relief-bake mesh data/urn-high.ply data/urn-low.obj OUT --size 96 --samples "
                      "4 --quiet --bits 32",
                      ".exr");
}

TEST_LABELS(not_sanitized);
TEST(Processors, ModelsAndPicturesHaveTheSameBytes) {
    const Workplace workplace;
    expect_same_bytes(workplace, "relief-mesh process data/vase.obj OUT --normals angle --quiet",
                      ".glb");
    expect_same_bytes(workplace, "relief-mesh subdivide data/vase.obj OUT --quiet", ".glb");
    expect_same_bytes(workplace, "relief-mesh decimate data/urn-high.ply OUT --ratio 0.2 --quiet",
                      ".glb");
}

}  // namespace
}  // namespace relief::tools
