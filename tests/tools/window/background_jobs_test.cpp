// SPDX-License-Identifier: Apache-2.0
#include "window/background_jobs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>

#include "progress_stage.h"
#include "support/shared_data.h"
#include "tools/window/display.h"
#include "tools/workplace.h"

namespace relief::tools {
using namespace relief::detail;
using namespace relief::shade;

namespace {

using test::eventually;
using test::Workplace;
using testing::HasSubstr;

/// Runs until it is cancelled.
int go_on(const Progress& progress, std::atomic<int>& ended) {
    while (!progress.is_cancelled())
        test::pause_a_little();
    ++ended;
    throw Cancelled();
}

TEST(Thumbnails, ShowTheImagesOfASceneInCells) {
    Image wide = make_image(200, 100, 3, 16, ColorSpace::srgb);
    for (std::size_t i = 0; i < 300UL * 100; ++i)
        wide.as<std::uint16_t>()[600 * (i / 300) + i % 300] = 65535;  // The left half is white.
    Image high = make_image(1, 300, 1, 32, ColorSpace::linear);
    for (float& sample : high.as<float>())
        sample = 7.0F;
    Scene scene;
    scene.images = {{"wide", wide}, {"missing", std::filesystem::path("no.png")}, {"high", high}};
    std::atomic<int> woken = 0;
    Thumbnails thumbnails([&] { ++woken; });
    thumbnails.update(scene);
    EXPECT_FALSE(thumbnails.is_running()) << "no panel wants them";
    thumbnails.want();
    thumbnails.update(scene);
    ASSERT_TRUE(eventually([&] { return woken == 1; }));
    EXPECT_FALSE(thumbnails.place_of(0));
    const Image picture = thumbnails.take().value();
    EXPECT_EQ(picture.width, 16 * 96);
    EXPECT_EQ(picture.height, 96);
    EXPECT_EQ(thumbnails.place_of(0)->size, glm::ivec2(96, 48));
    EXPECT_EQ(thumbnails.place_of(0)->image_size, glm::ivec2(200, 100));
    EXPECT_FALSE(thumbnails.place_of(1)) << "it cannot be decoded";
    EXPECT_EQ(thumbnails.place_of(2)->min, glm::ivec2(192, 0));
    EXPECT_EQ(thumbnails.place_of(2)->size, glm::ivec2(1, 96));
    EXPECT_FALSE(thumbnails.place_of(3));
    const auto red_and_alpha = [&](std::size_t x, std::size_t y) {
        const std::size_t pixel = 4 * (y * 16 * 96 + x);
        return std::pair(picture.as<std::uint8_t>()[pixel], picture.as<std::uint8_t>()[pixel + 3]);
    };
    EXPECT_EQ(red_and_alpha(47, 47), std::pair(std::uint8_t{255}, std::uint8_t{255}));
    EXPECT_EQ(red_and_alpha(48, 0), std::pair(std::uint8_t{0}, std::uint8_t{255}));
    EXPECT_EQ(red_and_alpha(48, 48), std::pair(std::uint8_t{0}, std::uint8_t{0})) << "empty";
    EXPECT_EQ(red_and_alpha(192, 95), std::pair(std::uint8_t{255}, std::uint8_t{255}));

    thumbnails.want();
    thumbnails.update(scene);
    EXPECT_FALSE(thumbnails.is_running()) << "the images are the same";
    scene.images.pop_back();
    thumbnails.want();
    thumbnails.update(scene);
    EXPECT_TRUE(thumbnails.is_running());
    EXPECT_FALSE(thumbnails.place_of(0)) << "of another scene";
}

TEST(NewestJob, ReturnsItsResultOnceAndWakes) {
    std::atomic<int> woken = 0;
    NewestJob<int> job([&] { ++woken; });
    EXPECT_FALSE(job.is_running());
    job.start([](const Progress&) { return 7; });
    ASSERT_TRUE(eventually([&] { return woken == 1; }));
    EXPECT_TRUE(job.is_running()) << "until it is taken";
    EXPECT_EQ(job.take(), 7);
    EXPECT_FALSE(job.is_running());
    EXPECT_FALSE(job.take());
}

TEST(NewestJob, StartCancelsEarlierWork) {
    std::atomic<int> ended = 0, woken = 0;
    NewestJob<int> job([&] { ++woken; });
    for (int i = 0; i < 3; ++i)
        job.start([&](const Progress& progress) { return go_on(progress, ended); });
    job.start([](const Progress&) { return 4; });
    ASSERT_TRUE(eventually([&] { return ended == 3 && woken == 1; }));
    EXPECT_EQ(job.take(), 4);
}

TEST(NewestJob, CancelEndsTheWork) {
    std::atomic<int> ended = 0, woken = 0;
    {
        NewestJob<int> job([&] { ++woken; });
        job.start([&](const Progress& progress) { return go_on(progress, ended); });
        job.cancel();
        EXPECT_FALSE(job.is_running());
        EXPECT_TRUE(eventually([&] { return ended == 1; }));
        job.start([&](const Progress& progress) { return go_on(progress, ended); });
    }
    EXPECT_EQ(ended, 2);
    EXPECT_EQ(woken, 0);
}

TEST(NewestJob, WorkReportsProgress) {
    const test::TemporaryDirectory folder;
    std::atomic<bool> may_end = false;
    NewestJob<std::size_t> job([] {});
    job.start([&](const Progress& progress) {
        note_file(folder / "looked for");
        const ProgressStage stage("looking", 4);
        while (!may_end)
            test::pause_a_little();
        return progress.files().size();
    });
    EXPECT_TRUE(eventually([&] { return job.progress().stage == "looking"; }));
    EXPECT_EQ(job.progress().part, 0.0);
    may_end = true;
    std::optional<std::size_t> files;
    ASSERT_TRUE(eventually([&] { return (files = job.take()).has_value(); }));
    EXPECT_EQ(files, 1U);
    EXPECT_EQ(job.progress().stage, "");
}

ViewOptions of(const std::filesystem::path& model) {
    ViewOptions options;
    options.model = model;
    return options;
}

TEST(Loader, ReadsInTheBackgroundAndWakes) {
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

TEST(Loader, OnlyTheLastStartHasAResult) {
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

TEST(Loader, CancelledReadHasNoResult) {
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
    EXPECT_LE(woken, 1);  // It may have been ready before it was cancelled.
}

/// A triangle and a degenerate triangle.
std::shared_ptr<const Scene> collapsed() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 1, 3}};
    Scene scene;
    scene.meshes.emplace_back(std::move(mesh));
    scene.instances.push_back({});
    return std::make_shared<const Scene>(std::move(scene));
}

TEST(HealthSearch, FindsMeshProblems) {
    HealthSearch search([] {});
    search.start({collapsed(), HealthChoice::problem});
    std::optional<HealthResult> found;
    ASSERT_TRUE(eventually([&] { return (found = search.take()).has_value(); }));
    EXPECT_EQ(found->error, "");
    ASSERT_TRUE(found->markers.markers);
    EXPECT_FALSE(found->markers.markers->empty());
    EXPECT_FALSE(search.is_running());
}

TEST(HealthSearch, CancelledSearchHasNoResult) {
    HealthSearch search([] {});
    search.start({collapsed(), HealthChoice::all});
    search.start({collapsed(), std::nullopt});
    EXPECT_FALSE(search.is_running());
    EXPECT_FALSE(search.take());
}

TEST(HealthSearch, InvalidSceneIsAnError) {
    auto broken = std::make_shared<Scene>(*collapsed());
    broken->meshes[0].edit().triangles.push_back({0, 1, 9});
    HealthSearch search([] {});
    search.start({broken, HealthChoice::problem});
    std::optional<HealthResult> found;
    ASSERT_TRUE(eventually([&] { return (found = search.take()).has_value(); }));
    EXPECT_NE(found->error, "");
}

}  // namespace
}  // namespace relief::tools
