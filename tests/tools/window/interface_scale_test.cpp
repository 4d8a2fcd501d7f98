// SPDX-License-Identifier: Apache-2.0
#include "window/interface_scale.h"

#include <gtest/gtest.h>

#include <limits>

namespace relief::tools {
namespace {

TEST(InterfaceScaleTest, IsTheScreensUnlessAskedOtherwise) {
    EXPECT_EQ(interface_scale({}, 1.0F, 1.0F), (InterfaceScale{1.0F, 1.0F}));
    EXPECT_EQ(interface_scale({}, 1.5F, 1.0F), (InterfaceScale{1.5F, 1.5F}));
    EXPECT_EQ(interface_scale(2.0F, 1.5F, 1.0F), (InterfaceScale{2.0F, 2.0F}));
}

TEST(InterfaceScaleTest, WhereAUnitIsTwoPixelsOnlyTheLettersAreFiner) {
    EXPECT_EQ(interface_scale({}, 2.0F, 2.0F), (InterfaceScale{1.0F, 2.0F}));
    EXPECT_EQ(interface_scale(1.0F, 2.0F, 2.0F), (InterfaceScale{0.5F, 1.0F}));
}

TEST(InterfaceScaleTest, StaysWithinItsLimitsAndTakesNoNonsense) {
    EXPECT_EQ(interface_scale(100.0F, 1.0F, 1.0F).glyphs, 4.0F);
    EXPECT_EQ(interface_scale({}, 0.01F, 1.0F).glyphs, 0.5F);
    EXPECT_EQ(interface_scale({}, 0.0F, 0.0F), (InterfaceScale{1.0F, 1.0F}));
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(interface_scale({}, nan, nan), (InterfaceScale{1.0F, 1.0F}));
}

TEST(InterfaceScaleTest, GoesUpAndDownByStepsAndStopsAtTheEnds) {
    EXPECT_EQ(next_scale(1.0F, true), 1.25F);
    EXPECT_EQ(next_scale(1.0F, false), 0.75F);
    EXPECT_EQ(next_scale(1.1F, true), 1.25F) << "a screen's own";
    EXPECT_EQ(next_scale(1.1F, false), 1.0F);
    EXPECT_EQ(next_scale(4.0F, true), 4.0F);
    EXPECT_EQ(next_scale(0.5F, false), 0.5F);
}

}  // namespace
}  // namespace relief::tools
