// SPDX-License-Identifier: Apache-2.0
#include "window/input_files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <fstream>

#include "support/gl_environment.h"
#include "support/shared_data.h"
#include "tools/window/display.h"

namespace relief::tools {
namespace {

using test::eventually;

using Purpose = FileWatch::Purpose;

bool has(const FileWatch::Changes& changes, Purpose purpose) {
    return changes[static_cast<std::size_t>(purpose)];
}

class Watching : public testing::Test {
  protected:
    [[nodiscard]] std::filesystem::path path(const std::string& name) const {
        return folder_ / name;
    }
    std::filesystem::path write(const std::string& name, const std::string& text) {
        std::ofstream(path(name)) << text;
        return path(name);
    }
    FileWatch::Files stamped(const std::vector<std::string>& names) {
        FileWatch::Files files;
        for (const std::string& name : names)
            files[path(name)] = stamp_of(path(name));
        return files;
    }
    FileWatch& watch() { return watch_; }
    /// Returns whether changes are reported for this purpose only.
    bool reports(Purpose purpose) {
        FileWatch::Changes changes{};
        const auto is_reported = [&] {
            changes = watch_.take();
            return changes != FileWatch::Changes{};
        };
        const bool is_any = eventually(is_reported);
        changes[static_cast<std::size_t>(purpose)] ^= true;
        return is_any && changes == FileWatch::Changes{};
    }
    /// Waits for several checks.
    bool reports_nothing() {
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        return watch_.take() == FileWatch::Changes{};
    }
    [[nodiscard]] int woken() const { return woken_; }

  private:
    test::TemporaryDirectory folder_;
    std::atomic<int> woken_ = 0;
    FileWatch watch_{[this] { ++woken_; }, std::chrono::milliseconds(10)};
};

TEST_F(Watching, ReportsEachChangeOnceAndWakes) {
    write("a", "1");
    write("b", "1");
    watch().watch(Purpose::scene, stamped({"a"}));
    watch().watch(Purpose::picture, stamped({"b"}));
    EXPECT_EQ(watch().count(), 2U);
    EXPECT_TRUE(reports_nothing());
    EXPECT_EQ(woken(), 0);
    write("b", "22");
    EXPECT_TRUE(reports(Purpose::picture));
    EXPECT_EQ(woken(), 1);
    EXPECT_TRUE(reports_nothing());
    write("b", "333");
    EXPECT_TRUE(reports(Purpose::picture)) << "from how it was told";
}

TEST_F(Watching, ReplacedRemovedAndCreatedFilesHaveChanged) {
    write("a", "1");
    watch().watch(Purpose::scene, stamped({"a", "missing"}));
    write("beside", "1");
    std::filesystem::last_write_time(path("beside"), std::filesystem::last_write_time(path("a")));
    std::filesystem::rename(path("beside"), path("a"));  // Same size, same time.
    EXPECT_TRUE(reports(Purpose::scene));
    write("missing", "");
    EXPECT_TRUE(reports(Purpose::scene));
    std::filesystem::remove(path("a"));
    EXPECT_TRUE(reports(Purpose::scene));
    EXPECT_TRUE(reports_nothing());
}

TEST_F(Watching, ChangeAfterTheStampIsReported) {
    write("a", "1");
    const FileWatch::Files files = stamped({"a"});
    write("a", "22");
    watch().watch(Purpose::attempt, files);
    EXPECT_TRUE(reports(Purpose::attempt));
}

TEST_F(Watching, SlowWritesAreReportedWhenTheFileIsStable) {
    using Clock = std::chrono::steady_clock;
    const std::chrono::milliseconds period(100);
    write("a", "");
    write("b", "1");
    FileWatch watch([] {}, period);
    watch.watch(Purpose::scene, stamped({"a", "b"}));
    std::ofstream slow(path("a"));
    bool is_reported = false;
    Clock::duration longest_pause{0};
    const Clock::time_point begin = Clock::now();
    for (Clock::time_point last = begin; last - begin < 5 * period;) {
        slow << "more" << std::flush;
        is_reported |= watch.take() != FileWatch::Changes{};
        longest_pause = std::max(longest_pause, Clock::now() - last);
        last = Clock::now();
    }
    // The file counts as stable if no write happened for the time of a check.
    EXPECT_FALSE(is_reported && longest_pause < period / 2);
    slow << "the end" << std::flush;
    EXPECT_TRUE(eventually([&] { return has(watch.take(), Purpose::scene); }));
}

TEST_F(Watching, FilesThatAreNoLongerWatchedAreNotReported) {
    write("a", "1");
    watch().watch(Purpose::scene, stamped({"a"}));
    watch().watch(Purpose::scene, {});
    write("a", "22");
    EXPECT_TRUE(reports_nothing());
    EXPECT_EQ(watch().count(), 0U);
}

using Changed = WatchedFiles::Changed;

class Following : public testing::Test {
  protected:
    std::filesystem::path write(const std::string& name, const std::string& text) {
        std::filesystem::create_directories((folder_ / name).parent_path());
        std::ofstream(folder_ / name) << text;
        return folder_ / name;
    }
    FileWatch::Files stamped(const std::vector<std::string>& names) {
        FileWatch::Files files;
        for (const std::string& name : names)
            files[folder_ / name] = stamp_of(folder_ / name);
        return files;
    }
    void loaded(const std::vector<std::string>& names, bool is_good = true) {
        Loaded result;
        if (is_good) result.composed.emplace();
        result.files = stamped(names);
        files_.follow(result);
    }
    void drawn(const std::vector<std::string>& names, const std::string& error = "") {
        RenderedPicture picture;
        picture.error = error;
        picture.files = std::make_shared<const FileWatch::Files>(stamped(names));
        files_.follow(picture);
    }
    /// The next reported change, for example "scene " or "shaders ".
    std::string reported() {
        std::string words;
        EXPECT_TRUE(eventually([&] { return !(words = reported_now()).empty(); }));
        return words;
    }
    std::string reported_later() {
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        return reported_now();
    }
    WatchedFiles& files() { return files_; }

  private:
    std::string reported_now() {
        const Changed now = files_.take();
        return std::string(now.scene ? "scene " : "") + (now.attempt ? "attempt " : "") +
               (now.picture ? "picture " : "") + (now.shaders ? "shaders " : "");
    }

    test::TemporaryDirectory folder_;
    test::ScopedVariable variable_{"RELIEF_SHADER_DIR", (folder_ / "shaders").c_str()};
    WatchedFiles files_{[] {}, std::chrono::milliseconds(10)};
};

TEST_F(Following, ReportsTheActionForTheUseOfAFile) {
    write("model.obj", "1");
    write("image.png", "1");
    write("shaders/light.glsl", "1");
    loaded({"model.obj"});
    drawn({"image.png", "shaders/light.glsl", "shaders/missing.glsl"});
    EXPECT_EQ(files().count(), 4U);
    write("model.obj", "22");
    EXPECT_EQ(reported(), "scene ");
    write("image.png", "22");
    EXPECT_EQ(reported(), "picture ");
    write("shaders/missing.glsl", "");
    EXPECT_EQ(reported(), "shaders ");
}

TEST_F(Following, FilesOfAFailedAttemptAreWatchedToo) {
    write("model.obj", "1");
    loaded({"model.obj"});
    loaded({"broken.obj"}, false);
    write("broken.obj", "1");
    EXPECT_EQ(reported(), "attempt ");
    write("model.obj", "22");
    EXPECT_EQ(reported(), "scene ");
    loaded({"model.obj"});
    write("broken.obj", "22");
    EXPECT_EQ(reported_later(), "") << "it is of no interest any more";
}

TEST_F(Following, FilesOfLinkedProgramsStayWatched) {
    write("shaders/light.glsl", "1");
    write("image.png", "1");
    drawn({"shaders/light.glsl", "image.png"});
    drawn({"image.png"});
    write("shaders/light.glsl", "22");
    EXPECT_EQ(reported(), "shaders ");
    drawn({"image.png"});  // Another picture is prepared before programs are linked again.
    EXPECT_EQ(reported_later(), "") << "once a change";
    drawn({"shaders/light.glsl", "image.png"});
    write("shaders/light.glsl", "333");
    EXPECT_EQ(reported(), "shaders ");
}

TEST_F(Following, ImagesStayWatchedAfterAnError) {
    write("a.png", "1");
    write("b.png", "1");
    drawn({"a.png", "b.png"});
    drawn({"a.png"}, "a.png: broken");
    write("b.png", "22");
    EXPECT_EQ(reported(), "picture ");
    drawn({"a.png"}, "a.png: broken");
    EXPECT_EQ(reported_later(), "") << "once a change";
    drawn({"a.png"});
    write("b.png", "333");
    EXPECT_EQ(reported_later(), "") << "no more of the picture";
}

using Files = std::vector<std::filesystem::path>;

TEST(DroppedFiles, AreClassifiedByName) {
    EXPECT_EQ(dropped_as("a/Helmet.GLB"), DroppedAs::model);
    EXPECT_EQ(dropped_as("scene.json"), DroppedAs::model);
    EXPECT_EQ(dropped_as("bricks_Normal-ogl.png"), DroppedAs::normal_map);
    EXPECT_EQ(dropped_as("bricks_n.png"), DroppedAs::normal_map);
    EXPECT_EQ(dropped_as("bricks-height.png"), DroppedAs::height_map);
    EXPECT_EQ(dropped_as("bricks_h.tif"), DroppedAs::height_map);
    EXPECT_EQ(dropped_as("Displacement.exr"), DroppedAs::height_map);
    EXPECT_EQ(dropped_as("studio.hdr"), DroppedAs::environment);
    EXPECT_EQ(dropped_as("sky.png"), DroppedAs::environment);
    EXPECT_EQ(dropped_as("bricks.png"), DroppedAs::diffuse_map);
    EXPECT_EQ(dropped_as("green.png"), DroppedAs::diffuse_map);
}

TEST(DroppedFiles, AMapReplacesTheMapOfItsKind) {
    ViewOptions options;
    options.model = "a.obj";
    options.normal_map = "old.png";
    const ViewOptions with_height = with_dropped(options, {"b-height.png"});
    EXPECT_EQ(with_height.height_map, "b-height.png");
    EXPECT_FALSE(with_height.normal_map);
    EXPECT_EQ(with_height.model, "a.obj");
    const ViewOptions with_normals = with_dropped(with_height, {"c-normal.png"});
    EXPECT_FALSE(with_normals.height_map);
    EXPECT_EQ(with_normals.normal_map, "c-normal.png");
    EXPECT_EQ(with_dropped(options, {"b.glb"}).model, "b.glb");
}

TEST(DroppedFiles, CanBeDroppedTogether) {
    const ViewOptions all = with_dropped({}, {"b.glb", "b_n.png", "b.png", "studio.hdr"});
    EXPECT_EQ(all.model, "b.glb");
    EXPECT_EQ(all.normal_map, "b_n.png");
    EXPECT_EQ(all.diffuse_map, "b.png");
    EXPECT_EQ(all.environment, Files{"studio.hdr"});
}

TEST(DroppedFiles, SixImagesAreACube) {
    const Files faces{"s_posx.png", "s_negx.png", "s_posy.png",
                      "s_negy.png", "s_posz.png", "s_negz.png"};
    Files sorted = faces;
    std::sort(sorted.begin(), sorted.end());
    EXPECT_EQ(with_dropped({}, sorted).environment, faces);
    EXPECT_EQ(with_dropped(
                  {}, {"Back.png", "Bottom.png", "Front.png", "Left.png", "Right.png", "Top.png"})
                  .environment,
              (Files{"Right.png", "Left.png", "Top.png", "Bottom.png", "Front.png", "Back.png"}));
    EXPECT_EQ(with_dropped({}, {"6.png", "2.png", "3.png", "4.png", "5.png", "1.png"}).environment,
              (Files{"1.png", "2.png", "3.png", "4.png", "5.png", "6.png"}));
}

TEST(Folders, ListTheirFoldersAndWhatTheWindowShows) {
    const test::TemporaryDirectory folder;
    const std::filesystem::path root = std::filesystem::path(folder / "root");
    std::filesystem::create_directories(root / "inner");
    for (const char* name :
         {"b.glb", "a.obj", "Box.obj", "map.PNG", "notes.txt", ".hidden.obj", "c.json"})
        std::ofstream(root / name) << "x";
    const FolderListing listing = list_folder(root / "inner" / ".." / "");
    EXPECT_EQ(listing.folder, root);
    EXPECT_EQ(listing.folders, (Files{root.parent_path(), root / "inner"}));
    EXPECT_EQ(listing.files, (Files{root / "a.obj", root / "b.glb", root / "Box.obj",
                                    root / "c.json", root / "map.PNG"}));
    EXPECT_EQ(listing.error, "");
    EXPECT_NE(list_folder(root / "missing").error, "");
    const FolderListing top = list_folder("/");
    EXPECT_EQ(top.folder, "/");
    EXPECT_EQ(std::count(top.folders.begin(), top.folders.end(), "/"), 0)
        << "the root has no parent";
}

TEST(Folders, ModelsHaveNeighbors) {
    const test::TemporaryDirectory folder;
    for (const char* name : {"a.obj", "b.png", "c.glb", "d.json"})
        std::ofstream(folder / name) << "x";
    EXPECT_EQ(neighbor_of(folder / "a.obj", true), folder / "c.glb");
    EXPECT_EQ(neighbor_of(folder / "d.json", true), folder / "a.obj");
    EXPECT_EQ(neighbor_of(folder / "a.obj", false), folder / "d.json");
    EXPECT_FALSE(neighbor_of(folder / "gone.obj", true));
    std::filesystem::remove(folder / "c.glb");
    std::filesystem::remove(folder / "d.json");
    EXPECT_FALSE(neighbor_of(folder / "a.obj", true));
}

}  // namespace
}  // namespace relief::tools
