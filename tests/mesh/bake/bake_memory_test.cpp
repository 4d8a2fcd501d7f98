// SPDX-License-Identifier: Apache-2.0
// The peak memory for large maps. The program is separate, because its peak includes libraries and
// all threads.
#include <gtest/gtest.h>

#include "relief/mesh/bake.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/mesh.h"
#include "support/labels.h"
#include "support/peak_memory.h"
#include "support/shared_data.h"

namespace relief {
namespace {

FILE_LABELS(alone);

/// Bakes a square whose chart is a small part of a map, so that the map determines the memory.
std::size_t texels_of(BakeOptions options, float chart) {
    Mesh low = make_quad();
    for (glm::vec2& texcoord : low.texcoords)
        texcoord = chart * texcoord + glm::vec2(0.3F);
    const std::vector<Mesh> high = {make_quad()};
    Report report;
    std::size_t texels = 0;
    bake_normals(
        high, low, options, [&](const BakedRows& rows) { texels += rows.states.size(); }, report);
    return texels;
}

/// The samples of a 2048 x 2048 map with 16 each would take a gigabyte, its texels 50 MB.
TEST_LABELS(slow);
TEST(BakeMemory, DoesNotGrowWithSamplesNorWithTheMap) {
    set_thread_limit(2);
    BakeOptions options;
    options.map.width = 512;
    options.map.height = 512;
    options.map.samples = 16;
    texels_of(options, 0.1F);
    const double small = test::peak_megabytes();
    options.map.width = 8192;
    options.map.height = 1024;
    options.map.padding = 16;
    EXPECT_EQ(texels_of(options, 0.02F), 8192U * 1024U);
    const double large = test::peak_megabytes();
    // The owners of all samples would take 2.1 GB. Sanitizers keep 256 MB of freed memory.
    EXPECT_LT(large, small + 600.0);
    // A map of four times the height, with 330 MB more pixels, takes the same memory.
    options.map.samples = 4;
    options.map.height = 4096;
    EXPECT_EQ(texels_of(options, 0.02F), 8192U * 4096U);
    EXPECT_LT(test::peak_megabytes(), large + 100.0);
}

/// The file has 15 bytes per texel: 250 MB.
TEST(BakeMemory, FillsToTheBorderInFiles) {
    const test::TemporaryDirectory folder;
    set_thread_limit(2);
    const double before = test::peak_megabytes();
    BakeOptions options;
    options.map.width = 4096;
    options.map.height = 4096;
    options.map.border_folder = folder / ".";
    EXPECT_EQ(texels_of(options, 0.02F), 4096U * 4096U);
    EXPECT_LT(test::peak_megabytes(), before + 100.0);
}

}  // namespace
}  // namespace relief
