// SPDX-License-Identifier: Apache-2.0
#include "window/file_browser.h"

#include <gtest/gtest.h>

#include <atomic>

#include "relief/mesh/image_file.h"
#include "tools/window/display.h"
#include "tools/window/panel_frames.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using test::eventually;
using test::PanelFrames;
using test::Workplace;

TEST(ListedFilesTest, AreOnlyImagesForAMap) {
    const Workplace workplace;
    std::filesystem::create_directories(workplace / "folder/inner");
    workplace.write_square("folder/square.obj");
    workplace.write("folder/wood.png", "");
    const FolderListing all = list_folder(workplace / "folder");
    const FolderListing images = list_folder(workplace / "folder", ListedFiles::images);
    EXPECT_EQ(all.files.size(), 2U);
    ASSERT_EQ(images.files.size(), 1U);
    EXPECT_EQ(images.files[0].filename(), "wood.png");
    EXPECT_EQ(images.folders.size(), 2U) << "the parent and the inner one";
}

TEST(FolderToBrowse, IsThatOfTheImageOrElseOfTheModel) {
    const Workplace workplace;
    std::filesystem::create_directories(workplace / "maps");
    workplace.write("maps/wood.png", "");
    workplace.write_square("square.obj");
    const std::string image = (workplace / "maps/wood.png").string();
    EXPECT_EQ(folder_to_browse(image, workplace / "square.obj"), workplace / "maps");
    EXPECT_EQ(folder_to_browse("inside of a GLB", workplace / "square.obj"),
              (workplace / "square.obj").parent_path());
    EXPECT_EQ(folder_to_browse({}, ""), std::filesystem::current_path());
}

TEST(ImagePreviewsTest, AreMadeInBatchesWhenTheyAreWanted) {
    const Workplace workplace;
    std::atomic<int> woken = 0;
    ImagePreviews previews([&] { ++woken; });
    previews.update();
    EXPECT_FALSE(previews.is_running()) << "nothing is wanted";
    const std::filesystem::path map_file = workplace / "data/bricks-height.png";
    const std::filesystem::path broken = workplace / "broken.png";
    workplace.write("broken.png", "no image");
    EXPECT_FALSE(previews.want(map_file));
    EXPECT_FALSE(previews.want(broken));
    previews.update();
    ASSERT_TRUE(eventually([&] { return woken == 1; }));
    const Image picture = previews.take().value();
    EXPECT_EQ(picture.width, Thumbnails::columns * Thumbnails::cell);
    EXPECT_EQ(picture.height, Thumbnails::cell);
    const ImageInfo info = read_image_info(map_file);
    ASSERT_TRUE(previews.want(map_file));
    EXPECT_EQ(previews.want(map_file)->image_size, glm::ivec2(info.width, info.height));
    ASSERT_TRUE(previews.want(broken));
    EXPECT_EQ(previews.want(broken)->size.x, 0) << "it cannot be decoded";
    EXPECT_FALSE(previews.take()) << "each picture comes once";
    previews.update();
    EXPECT_FALSE(previews.is_running()) << "all are there";
    const std::filesystem::path color = workplace / "data/bricks-diffuse.png";
    EXPECT_FALSE(previews.want(color));
    previews.update();
    ASSERT_TRUE(eventually([&] { return woken == 2; }));
    const Image more = previews.take().value();
    EXPECT_EQ(previews.want(color)->min, glm::ivec2(2 * Thumbnails::cell, 0));
    const auto first = [](const Image& image) { return image.as<std::uint8_t>()[3]; };
    EXPECT_EQ(first(more), 255) << "the first preview stays";
}

class Dialog : public testing::Test {
  protected:
    void open(BrowseTarget::Kind kind) {
        std::filesystem::create_directories(workplace_ / "files/inner");
        workplace_.write_square("files/square.obj");
        workplace_.write("files/wood.png", "");
        workplace_.write("files/stone.png", "");
        frames_.dialog().open({.target = {.kind = kind},
                               .title = "Normal map of 'brick'",
                               .folder = workplace_ / "files",
                               .present = "wood.png"});
        frames_.draw();
    }
    PanelFrames& frames() { return frames_; }

  private:
    Workplace workplace_;
    PanelFrames frames_;
};

TEST_F(Dialog, ListsImagesAndFoldersForAMap) {
    open(BrowseTarget::Kind::map);
    EXPECT_TRUE(frames().has("wood.png"));
    EXPECT_TRUE(frames().has("inner/"));
    EXPECT_FALSE(frames().has("square.obj"));
    EXPECT_FALSE(frames().has("Use this folder"));
    frames().click("search names");
    frames().type("ston");
    frames().draw();
    EXPECT_TRUE(frames().has("stone.png"));
    EXPECT_FALSE(frames().has("wood.png"));
    frames().click("stone.png");
    EXPECT_FALSE(frames().dialog().is_open()) << "a file was selected";
}

TEST_F(Dialog, ListsModelsTooAndTakesFoldersForEnvironments) {
    open(BrowseTarget::Kind::input);
    EXPECT_TRUE(frames().has("square.obj"));
    frames().click("inner/");
    frames().draw();
    EXPECT_FALSE(frames().has("square.obj"));
    frames().click("../");
    frames().draw();
    EXPECT_TRUE(frames().has("square.obj"));
    frames().click("Cancel the dialog");
    EXPECT_FALSE(frames().dialog().is_open());
    open(BrowseTarget::Kind::environment);
    EXPECT_TRUE(frames().has("Use this folder"));
    EXPECT_FALSE(frames().has("square.obj"));
}

}  // namespace
}  // namespace relief::tools
