// SPDX-License-Identifier: Apache-2.0
#include "relief/shade/shared.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "relief/shade/scene.h"
#include "support/shapes.h"

namespace relief {
namespace {

TEST(Shared, CopiesAreOneValueUntilOneIsEdited) {
    Shared<std::vector<int>> first = std::vector<int>{1, 2, 3};
    Shared<std::vector<int>> second = first;
    EXPECT_EQ(first->data(), second->data());
    const auto identity = first.identity();
    EXPECT_TRUE(identity.is(second));
    second.edit()[0] = 7;
    EXPECT_EQ(first->at(0), 1);
    EXPECT_EQ(second->at(0), 7);
    EXPECT_TRUE(identity.is(first));
    EXPECT_FALSE(identity.is(second));
}

TEST(Shared, AloneIsEditedInPlace) {
    Shared<std::vector<int>> alone = std::vector<int>{1, 2, 3};
    const auto identity = alone.identity();
    const int* before = alone->data();
    alone.edit()[2] = 5;
    EXPECT_EQ(alone->data(), before);
    EXPECT_FALSE(identity.is(alone));
    EXPECT_EQ(*alone, (std::vector<int>{1, 2, 5}));
}

TEST(Shared, AnIdentityIsNotTakenForThatOfALaterValue) {
    auto first = std::make_unique<Shared<int>>(1);
    const auto identity = first->identity();
    first.reset();
    for (int i = 0; i < 100; ++i)
        EXPECT_FALSE(identity.is(Shared<int>(1)));
}

TEST(Shared, ACopiedSceneHasItsMeshesInCommon) {
    Scene scene;
    scene.meshes.push_back(test::grid(4));
    Scene copy = scene;
    EXPECT_EQ(copy.meshes[0]->positions.data(), scene.meshes[0]->positions.data());
    copy.meshes[0].edit().positions[0].x = 9.0F;
    EXPECT_NE(scene.meshes[0]->positions[0].x, 9.0F);
}

}  // namespace
}  // namespace relief
