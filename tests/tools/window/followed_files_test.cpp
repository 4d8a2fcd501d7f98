// SPDX-License-Identifier: Apache-2.0
#include "window/followed_files.h"

#include <gtest/gtest.h>

#include <fstream>

#include "support/gl_environment.h"
#include "support/shared_data.h"
#include "tools/window/display.h"

namespace relief::tools {
namespace {

using test::eventually;
using Changed = FollowedFiles::Changed;

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
        DrawnPicture picture;
        picture.error = error;
        picture.files = std::make_shared<const FileWatch::Files>(stamped(names));
        files_.follow(picture);
    }
    /// What is told next, which must come; "scene attempt picture shaders" of it.
    std::string told() {
        std::string words;
        EXPECT_TRUE(eventually([&] { return !(words = told_now()).empty(); }));
        return words;
    }
    std::string told_after_a_while() {
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        return told_now();
    }
    FollowedFiles& files() { return files_; }

  private:
    std::string told_now() {
        const Changed now = files_.take();
        return std::string(now.scene ? "scene " : "") + (now.attempt ? "attempt " : "") +
               (now.picture ? "picture " : "") + (now.shaders ? "shaders " : "");
    }

    test::TemporaryDirectory folder_;
    test::ScopedVariable variable_{"RELIEF_SHADER_DIR", (folder_ / "shaders").c_str()};
    FollowedFiles files_{[] {}, std::chrono::milliseconds(10)};
};

TEST_F(Following, TellsWhatIsToBeDoneByWhatAFileIsFor) {
    write("model.obj", "1");
    write("image.png", "1");
    write("shaders/light.glsl", "1");
    loaded({"model.obj"});
    drawn({"image.png", "shaders/light.glsl", "shaders/missing.glsl"});
    EXPECT_EQ(files().count(), 4U);
    write("model.obj", "22");
    EXPECT_EQ(told(), "scene ");
    write("image.png", "22");
    EXPECT_EQ(told(), "picture ");
    write("shaders/missing.glsl", "");
    EXPECT_EQ(told(), "shaders ");
}

TEST_F(Following, AFailedAttemptIsFollowedBesideTheSceneThatIsShown) {
    write("model.obj", "1");
    loaded({"model.obj"});
    loaded({"broken.obj"}, false);
    write("broken.obj", "1");
    EXPECT_EQ(told(), "attempt ");
    write("model.obj", "22");
    EXPECT_EQ(told(), "scene ");
    loaded({"model.obj"});
    write("broken.obj", "22");
    EXPECT_EQ(told_after_a_while(), "") << "it is of no interest any more";
}

TEST_F(Following, ProgramsThatWereThereKeepTheirFilesFollowed) {
    write("shaders/light.glsl", "1");
    write("image.png", "1");
    drawn({"shaders/light.glsl", "image.png"});
    drawn({"image.png"});
    write("shaders/light.glsl", "22");
    EXPECT_EQ(told(), "shaders ");
    drawn({"image.png"});  // Another picture is prepared before programs are linked anew.
    EXPECT_EQ(told_after_a_while(), "") << "once a change";
    drawn({"shaders/light.glsl", "image.png"});
    write("shaders/light.glsl", "333");
    EXPECT_EQ(told(), "shaders ");
}

TEST_F(Following, ImagesThatWereNotAskedForAfterAnErrorAreStillFollowed) {
    write("a.png", "1");
    write("b.png", "1");
    drawn({"a.png", "b.png"});
    drawn({"a.png"}, "a.png: broken");
    write("b.png", "22");
    EXPECT_EQ(told(), "picture ");
    drawn({"a.png"}, "a.png: broken");
    EXPECT_EQ(told_after_a_while(), "") << "once a change";
    drawn({"a.png"});
    write("b.png", "333");
    EXPECT_EQ(told_after_a_while(), "") << "no more of the picture";
}

}  // namespace
}  // namespace relief::tools
