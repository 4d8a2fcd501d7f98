// SPDX-License-Identifier: Apache-2.0
// The commit that tools name, and the script that makes a release.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "support/shared_data.h"
#include "tools/workplace.h"

namespace relief::test {
namespace {

using testing::HasSubstr;

/// A folder with the files that hold the version.
class Sources : public testing::Test {
  protected:
    Sources() {
        for (const char* file :
             {"cmake/commit.cmake", ".gitattributes", "scripts/dev/release", "CITATION.cff",
              "debian/changelog", "packaging/vcpkg/relief/vcpkg.json",
              "libmesh/include/relief/version.h", "tests/install/interface.txt"}) {
            create_directories((root / file).parent_path());
            std::filesystem::copy_file(source_directory() / file, root / file);
        }
        std::ofstream(root / "cmake/commit.txt") << "$Format:%H$\n";
        write_changelog(sentences + "\n### Added\n- A change.\n");
        static_cast<void>(shell(
            "sed -i 's/VERSION \".*\"/VERSION \"1.1.0-dev\"/' libmesh/include/relief/version.h"));
    }

    void write_changelog(const std::string& section) const {
        std::ofstream(root / "CHANGELOG.md") << "# Changelog\n\n## Unreleased\n" + section +
                                                    "\n## 1.0.0 - 2026-11-27\n- An old change.\n";
    }

    /// Runs lines of a shell in the folder, with a git of their own.
    [[nodiscard]] ProgramResult shell(const std::string& lines) const {
        return run_program(
            {"/usr/bin/env", "-u", "GIT_DIR", "-u", "GIT_WORK_TREE", "-u", "GIT_INDEX_FILE",
             "GIT_CONFIG_GLOBAL=/dev/null", "GIT_AUTHOR_NAME=a", "GIT_AUTHOR_EMAIL=a@example.org",
             "GIT_COMMITTER_NAME=a", "GIT_COMMITTER_EMAIL=a@example.org", "sh", "-ec", lines},
            root);
    }
    void make_checkout() const {
        const ProgramResult result =
            shell("git init -q -b main . && git add . && git commit -q -m first");
        ASSERT_EQ(result.exit_code, 0) << result.error;
    }
    /// The line with the commit that a build of a folder of sources names.
    [[nodiscard]] std::string commit_of(const std::filesystem::path& sources) const {
        const ProgramResult result =
            shell("cmake -DSOURCE='" + sources.string() + "' -DOUTPUT='" +
                  (folder / "commit.cpp").string() + "' -P '" + sources.string() +
                  "/cmake/commit.cmake' && sed -n 's/.*= \"\\(.*\\)\";/\\1/p' ../commit.cpp");
        EXPECT_EQ(result.exit_code, 0) << result.error;
        return result.out;
    }
    [[nodiscard]] std::string text_of(const std::string& file) const {
        return read_bytes(root / file);
    }

    const std::string sentences =
        "The first one. `b.c` is the second. Is this the third? Four. It is\nthe fifth, by 1.5.\n";
    TemporaryDirectory folder;
    const std::filesystem::path root = folder / "sources";
};

TEST_F(Sources, NameTheirCommit) {
    EXPECT_EQ(commit_of(root), "\n") << "without git";
    make_checkout();
    const std::string commit = shell("git rev-parse HEAD").out.substr(0, 12);
    EXPECT_EQ(commit_of(root), commit + "\n");
    EXPECT_EQ(
        shell("mkdir copy archive && cp -r cmake copy && git archive HEAD | tar -x -C archive")
            .exit_code,
        0);
    EXPECT_EQ(commit_of(root), commit + "\n") << "Files that git does not know change no source.";
    EXPECT_EQ(commit_of(root / "copy"), "\n") << "inside of another checkout";
    EXPECT_EQ(commit_of(root / "archive"), commit + "\n");
    EXPECT_EQ(shell("echo >> CITATION.cff").exit_code, 0);
    EXPECT_EQ(commit_of(root), commit + "-modified\n");
}

TEST_F(Sources, BecomeAReleaseAndTheNextVersion) {
    make_checkout();
    const ProgramResult result =
        shell("scripts/dev/release 1.1.0 --without ci,figures,packages,site");
    ASSERT_EQ(result.exit_code, 0) << result.out << result.error;
    EXPECT_THAT(result.out, HasSubstr("left out  ci\n"));
    EXPECT_EQ(shell("git log --format=%s").out,
              "Begin version 1.2.0\nRelease version 1.1.0\nfirst\n");
    const std::string version = shell("git show v1.1.0:libmesh/include/relief/version.h").out;
    EXPECT_THAT(version, HasSubstr("RELIEF_VERSION \"1.1.0\"\n"));
    EXPECT_THAT(version, HasSubstr("RELIEF_VERSION_MINOR 1\n"));
    EXPECT_THAT(shell("git show v1.1.0:CITATION.cff").out,
                HasSubstr("version: 1.1.0\ndate-released: 20"));
    EXPECT_THAT(shell("git show v1.1.0:CHANGELOG.md").out, HasSubstr("\n## 1.1.0 - 20"));
    EXPECT_THAT(shell("git show v1.1.0:debian/changelog").out,
                testing::StartsWith("relief (1.1.0) unstable; "));
    EXPECT_THAT(text_of("libmesh/include/relief/version.h"),
                HasSubstr("RELIEF_VERSION \"1.2.0-dev\"\n#define RELIEF_VERSION_MAJOR 1\n"
                          "#define RELIEF_VERSION_MINOR 2\n"));
    EXPECT_THAT(text_of("CITATION.cff"), HasSubstr("version: 1.2.0-dev\nlicense"));
    EXPECT_THAT(text_of("packaging/vcpkg/relief/vcpkg.json"),
                HasSubstr("\"version\": \"1.2.0-dev\""));
    EXPECT_THAT(text_of("debian/changelog"),
                testing::StartsWith("relief (1.2.0~dev) UNRELEASED; "));
    EXPECT_THAT(text_of("CHANGELOG.md"), HasSubstr("\n## Unreleased\n\n## 1.1.0 - 20"));
    EXPECT_EQ(shell("git status --porcelain").out, "");

    // The interface of the next release lacks a line.
    write_changelog(sentences + "- Another change.\n");
    EXPECT_EQ(shell("sed -i '$d' tests/install/interface.txt; git commit -qam second").exit_code,
              0);
    EXPECT_THAT(
        shell("scripts/dev/release 1.2.0 --without ci,figures,packages,site").error,
        HasSubstr("the interface of v1.1.0 lost 1 lines, so the major version must change"));
    EXPECT_EQ(shell("git tag --list").out, "v1.1.0\n");
}

/// Instead of CMake: its programs write the commit of their sources instead of figures.
constexpr const char* cmake_stand_in = R"(#!/bin/sh
[ "$1" = --preset ] || exit 0
mkdir -p "$4/bin"
cat >"$4/bin/relief-accuracy" <<END
#!/bin/sh
[ "\$1" = compare ] && exec cat "\$2" "\$3"
mkdir "\$4" && echo figures of $(git rev-parse HEAD) >"\$4/accuracy.json"
END
chmod +x "$4/bin/relief-accuracy"
)";

TEST_F(Sources, AreCheckedAndComparedWithThePreviousVersion) {
    create_directories(folder / "bin");
    std::ofstream(folder / "bin/cmake") << cmake_stand_in;
    std::ofstream(root / "scripts/ci") << "#!/bin/sh\n[ ! -e ../ci-fails ]\n";
    ASSERT_EQ(shell("chmod +x ../bin/cmake scripts/ci").exit_code, 0);
    make_checkout();
    ASSERT_EQ(
        shell("git tag v1.0.0; git commit -q --allow-empty -m second; touch ../ci-fails").exit_code,
        0);
    const std::string release =
        "PATH=$PWD/../bin:$PATH scripts/dev/release 1.1.0 --without packages,site";
    EXPECT_THAT(shell(release).error, HasSubstr("error: scripts/ci failed"));
    EXPECT_EQ(shell("git tag; rm ../ci-fails").out, "v1.0.0\n");
    const ProgramResult result = shell(release);
    EXPECT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out,
                HasSubstr(shell("git log --reverse --format='figures of %H' | head -n 2").out));
    EXPECT_EQ(shell("git tag; git worktree list | wc -l").out, "v1.0.0\nv1.1.0\n1\n");
}

TEST_F(Sources, ThatAreNotReadyAreNoRelease) {
    const std::string release = "scripts/dev/release 1.1.0 --without ci,figures,packages,site";
    write_changelog("One sentence.\n- A change.\n");
    make_checkout();
    EXPECT_THAT(shell(release).error, HasSubstr("begins with 1 sentences, but must begin with 5"));
    EXPECT_THAT(shell("scripts/dev/release 1.0.9 --without ci").error,
                HasSubstr("1.0.9 does not follow the version of the sources, 1.1.0-dev"));
    EXPECT_THAT(shell("scripts/dev/release 1.1").error, HasSubstr("must be three numbers"));
    EXPECT_THAT(shell("scripts/dev/release 1.1.0 --without cj").error,
                HasSubstr("--without cj: the phases are check, interface, ci"));
    EXPECT_EQ(shell("echo >> CITATION.cff").exit_code, 0);
    EXPECT_THAT(shell(release).error, HasSubstr("the checkout has changes (git status)"));
    EXPECT_EQ(shell("git log --format=%s; git tag").out, "first\n");
}

}  // namespace
}  // namespace relief::test
