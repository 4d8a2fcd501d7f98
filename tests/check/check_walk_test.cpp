// SPDX-License-Identifier: Apache-2.0
#include "check_walk.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "common/command.h"
#include "support/shared_data.h"

namespace relief::tools {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;

TEST(FilePattern, MatchesNamesFoldersAndPaths) {
    const auto fits = [](const char* path, const char* pattern) {
        return matches_pattern(path, pattern);
    };
    EXPECT_TRUE(fits("a/b/rock.glb", "*.glb"));
    EXPECT_TRUE(fits("rock.glb", "rock.???"));
    EXPECT_FALSE(fits("rock.glb", "rock.??"));
    EXPECT_TRUE(fits("a/b/rock.glb", "a/*/rock.glb"));
    EXPECT_FALSE(fits("a/b/c/rock.glb", "a/*/rock.glb"));
    EXPECT_TRUE(fits("a/b/c/rock.glb", "a/**/rock.glb"));
    EXPECT_TRUE(fits("a/rock.glb", "a/**/rock.glb"));
    EXPECT_FALSE(fits("ab/rock.glb", "a/**/rock.glb"));
    EXPECT_FALSE(fits("a/brock.glb", "a/**/rock.glb"));
    EXPECT_TRUE(fits("a/b/rock.glb", "a/**"));
    EXPECT_TRUE(fits("rock.glb", "**"));
    EXPECT_FALSE(fits("a/rock.glb", "b/**"));
    EXPECT_TRUE(fits("a*b", "a**b"));
    EXPECT_TRUE(fits("", "*"));
    EXPECT_FALSE(fits("", "?"));
    // The time is linear in both lengths.
    EXPECT_FALSE(matches_pattern(std::string(500, 'a') + "/x",
                                 "a*a*a*a*a*a*a*a*a*a*a*a*a*a*a*a*a*a*a*a*b/x"));
}

class Walk : public testing::Test {
  protected:
    void write(const std::string& name) const {
        const fs::path file = folder / name;
        fs::create_directories(file.parent_path());
        std::ofstream(file) << "x";
    }
    [[nodiscard]] std::vector<std::string> names(const WalkedFiles& walked) const {
        std::vector<std::string> list;
        for (const CheckInput& input : walked.files)
            list.push_back(input.file.lexically_relative(folder.path()).string());
        return list;
    }
    static bool none(const fs::path&) { return false; }

    test::TemporaryDirectory folder;
};

TEST_F(Walk, FindsModelsAndImagesInOrder) {
    for (const char* name : {"b.glb", "a/x.PNG", "a/notes.txt", "a/y.obj", ".git/z.glb", "c.stl"})
        write(name);
    const WalkedFiles walked = walk_files({folder.path()}, none);
    EXPECT_THAT(names(walked), ElementsAre("a/x.PNG", "a/y.obj", "b.glb", "c.stl"));
    EXPECT_TRUE(walked.findings.empty());
    EXPECT_THAT(names(walk_files({folder / "b.glb", folder.path(), folder / "b.glb"}, none)),
                ElementsAre("b.glb", "a/x.PNG", "a/y.obj", "c.stl"));
    EXPECT_THAT(names(walk_files({folder.path()},
                                 [](const fs::path& path) { return path.filename() == "a"; })),
                ElementsAre("b.glb", "c.stl"));
    EXPECT_THROW(walk_files({folder / "a/notes.txt"}, none), UsageError);
}

TEST_F(Walk, DoesNotFollowLinksToFolders) {
    write("a/x.glb");
    fs::create_directory_symlink("..", folder / "a/loop");
    fs::create_symlink("b.glb", folder / "b.glb");
    fs::create_symlink("a/x.glb", folder / "c.glb");
    const WalkedFiles walked = walk_files({folder.path()}, none);
    EXPECT_THAT(names(walked), testing::UnorderedElementsAre("a/x.glb", "b.glb", "c.glb"));
    ASSERT_EQ(walked.findings.size(), 1U);
    EXPECT_EQ(walked.findings[0].findings.at(0).rule->id, "file/folder-link");
}

TEST_F(Walk, PairsMeshesWithMapsByName) {
    for (const char* name : {"Rock.obj", "rock_normal.png", "rock_ao.png", "other_normal.png",
                             "rock.glb", "a/rock_normal.png"})
        write(name);
    const WalkedFiles walked = walk_files({folder.path()}, none);
    for (const CheckInput& input : walked.files) {
        if (input.kind == CheckedKind::image) continue;
        std::vector<std::string> paired;
        for (const UsedImage& image : input.paired)
            paired.push_back(image.file.filename().string());
        if (input.file.extension() == ".glb")
            EXPECT_TRUE(paired.empty());
        else
            EXPECT_THAT(paired, ElementsAre("rock_ao.png", "rock_normal.png"));
    }
}

}  // namespace
}  // namespace relief::tools
