// SPDX-License-Identifier: Apache-2.0
// What a bake says on a terminal while it runs, and that it says nothing elsewhere.
#include "mesh/mesh_progress.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tools/workplace.h"

namespace relief::tools {
namespace {

using test::Workplace;
using testing::HasSubstr;

TEST(MeshProgress, SaysHowFastItIsAndWhenItWillBeDone) {
    EXPECT_EQ(progress_words(0.5, 0.5, 1'000'000), "2.0 million rays a second");
    EXPECT_EQ(progress_words(0.0, 5.0, 0), "0.0 million rays a second");
    EXPECT_EQ(progress_words(0.25, 4.0, 10'000'000), "2.5 million rays a second, 12 s left");
    EXPECT_EQ(progress_words(0.01, 4.0, 10'000'000), "2.5 million rays a second, 7 min left");
    EXPECT_EQ(progress_words(1.0, 4.0, 4'000'000), "1.0 million rays a second, 0 s left");
}

TEST(MeshProgress, IsSaidOnATerminalAlone) {
    const Workplace place;
    place.write_square("square.obj");
    const std::string line =
        "relief-bake mesh square.obj square.obj out/n.png --size 256 --samples 4";
    EXPECT_EQ(place.run(line).error, "");
    const auto shown = place.run("script -qec '" + line + "' /dev/null < /dev/null");
    if (shown.exit_code == 127) GTEST_SKIP() << "no script(1) to make a terminal";
    EXPECT_EQ(shown.exit_code, 0);
    EXPECT_THAT(shown.out, HasSubstr("bake 100 %, "));
    EXPECT_THAT(shown.out, HasSubstr(" million rays a second ..."));
    const auto quiet = place.run("script -qec '" + line + " --quiet' /dev/null < /dev/null");
    EXPECT_EQ(quiet.out, "");
}

}  // namespace
}  // namespace relief::tools
