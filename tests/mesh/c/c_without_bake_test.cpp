// SPDX-License-Identifier: Apache-2.0
// The C interface of a library without relief::bake.
#include <gtest/gtest.h>

#include "relief/relief.h"

namespace relief {
namespace {

TEST(CWithoutBake, BakesAreUnavailable) {
    relief_bake_options options{};
    ASSERT_EQ(relief_bake_options_init(&options, sizeof(options)), RELIEF_OK);
    EXPECT_EQ(options.samples, 1);
    EXPECT_EQ(relief_bake(nullptr, 0, nullptr, &options, nullptr, nullptr, nullptr, nullptr),
              RELIEF_UNAVAILABLE);
    EXPECT_STREQ(relief_last_error(),
                 "this library was built without relief_bake() (build relief with "
                 "RELIEF_C_BAKE=ON, which needs Embree)");
}

}  // namespace
}  // namespace relief
