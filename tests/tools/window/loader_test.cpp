// SPDX-License-Identifier: Apache-2.0
#include "window/loader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>

#include "tools/window/display.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using test::eventually;
using test::Workplace;
using testing::HasSubstr;

ViewOptions of(const std::filesystem::path& model) {
    ViewOptions options;
    options.model = model;
    return options;
}

TEST(Loader, ReadsBesideAndWakes) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    std::atomic<int> woken = 0;
    Loader loader([&] { ++woken; });
    EXPECT_FALSE(loader.is_loading());
    loader.start(of(workplace / "square.obj"));
    ASSERT_TRUE(eventually([&] { return woken > 0; }));
    EXPECT_TRUE(loader.is_loading()) << "until it is taken";
    const std::optional<Loaded> loaded = loader.take();
    ASSERT_TRUE(loaded && loaded->composed);
    EXPECT_FALSE(loader.is_loading());
    EXPECT_EQ(loaded->error, "");
    EXPECT_EQ(loaded->composed->scene().meshes.at(0)->triangles.size(), 2U);
    EXPECT_EQ(loaded->options.model, workplace / "square.obj");
    EXPECT_FALSE(loader.take()) << "only once";
    EXPECT_EQ(woken, 1);
}

TEST(Loader, AnErrorIsAResult) {
    const Workplace workplace;
    std::atomic<bool> woken = false;
    Loader loader([&] { woken = true; });
    loader.start(of(workplace / "missing.obj"));
    ASSERT_TRUE(eventually([&] { return woken.load(); }));
    const std::optional<Loaded> loaded = loader.take();
    ASSERT_TRUE(loaded);
    EXPECT_FALSE(loaded->composed);
    EXPECT_THAT(loaded->error, HasSubstr("missing.obj"));
}

TEST(Loader, OnlyTheLastBeginningCounts) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    workplace.write("one.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    Loader loader([] {});
    for (int i = 0; i < 5; ++i)
        loader.start(of(workplace / "square.obj"));
    loader.start(of(workplace / "one.obj"));
    std::optional<Loaded> loaded;
    ASSERT_TRUE(eventually([&] { return (loaded = loader.take()).has_value(); }));
    ASSERT_TRUE(loaded->composed);
    EXPECT_EQ(loaded->composed->scene().meshes.at(0)->triangles.size(), 1U);
    test::pause_a_little();
    EXPECT_FALSE(loader.take());
}

TEST(Loader, WhatIsCancelledNeverComes) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    std::atomic<int> woken = 0;
    {
        Loader loader([&] { ++woken; });
        loader.start(of(workplace / "square.obj"));
        loader.cancel();
        EXPECT_FALSE(loader.is_loading());
        EXPECT_FALSE(loader.take());
    }
    EXPECT_LE(woken, 1);  // It may have been there before it was cancelled.
}

}  // namespace
}  // namespace relief::tools
