// SPDX-License-Identifier: Apache-2.0
#include "window/resolution.h"

#include <gtest/gtest.h>

namespace relief::tools {
namespace {

const FrameSettings whole{1200, 800, 4};

TEST(Resolution, QuickPicturesStayWhole) {
    Resolution resolution;
    resolution.moved(5.0);
    EXPECT_EQ(resolution.settings_for(whole, 5.0).width, 1200) << "nothing is known yet";
    resolution.whole_took(60.0);
    EXPECT_EQ(resolution.settings_for(whole, 5.0).width, 1200);
    EXPECT_EQ(resolution.settings_for(whole, 5.0).samples, 4);
}

TEST(Resolution, SlowOnesLoseSamplesThenPixels) {
    Resolution resolution;
    resolution.moved(5.0);
    resolution.whole_took(100.0);
    EXPECT_EQ(resolution.settings_for(whole, 5.0).samples, 1);
    EXPECT_EQ(resolution.settings_for(whole, 5.0).width, 1200);
    resolution.whole_took(400.0);  // 167 ms with one sample: a quarter of that is below 60.
    EXPECT_EQ(resolution.settings_for(whole, 5.0).width, 600);
    EXPECT_EQ(resolution.settings_for(whole, 5.0).height, 400);
    resolution.whole_took(1e6);
    EXPECT_EQ(resolution.settings_for(whole, 5.0).width, 300) << "never coarser than that";
    EXPECT_EQ(resolution.settings_for({2, 1, 1}, 5.0).height, 1);
}

TEST(Resolution, AtRestItIsWholeAgain) {
    Resolution resolution;
    resolution.whole_took(400.0);
    EXPECT_EQ(resolution.settings_for(whole, 5.0).width, 1200) << "nothing has moved yet";
    resolution.moved(5.0);
    EXPECT_EQ(resolution.settings_for(whole, 5.1).width, 600);
    EXPECT_EQ(resolution.settings_for(whole, 5.2).width, 1200);
}

}  // namespace
}  // namespace relief::tools
