// SPDX-License-Identifier: Apache-2.0
#include "window/pasted_view.h"

#include <gtest/gtest.h>

namespace relief::tools {
namespace {

TEST(PastedView, IsFoundAmongOtherWords) {
    const PastedView view = pasted_view(
        "relief-view vase.obj --camera -30,20@0.5,1,-2,3.25 --fov 50 --size 640x480 --wireframe");
    EXPECT_EQ(view.camera.azimuth, static_cast<float>(glm::radians(-30.0)));
    ASSERT_TRUE(view.camera.place);
    EXPECT_EQ(view.camera.place->target, glm::vec3(0.5F, 1.0F, -2.0F));
    EXPECT_EQ(view.camera.place->distance, 3.25F);
    EXPECT_EQ(view.vertical_fov, static_cast<float>(glm::radians(50.0)));
}

TEST(PastedView, MayBeTheCameraAlone) {
    const PastedView view = pasted_view(" 10,-5@0,0,0,2\n");
    EXPECT_EQ(view.camera.elevation, static_cast<float>(glm::radians(-5.0)));
    EXPECT_FALSE(view.vertical_fov);
    EXPECT_FALSE(pasted_view("--camera=10,5").camera.place);
}

TEST(PastedView, WhatIsNoneIsRefused) {
    EXPECT_THROW(pasted_view(""), UsageError);
    EXPECT_THROW(pasted_view("two words"), UsageError);
    EXPECT_THROW(pasted_view("--camera"), UsageError);
    for (const char* text :
         {"10,5@0,0,0", "10,5@0,0,0,0", "10,5,2@0,0,0,1", "10,95@0,0,0,1", "10,5@0,x,0,1", "10"}) {
        EXPECT_THROW(pasted_view(text), UsageError) << text;
    }
}

}  // namespace
}  // namespace relief::tools
