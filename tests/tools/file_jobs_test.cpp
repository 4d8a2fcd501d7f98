// SPDX-License-Identifier: Apache-2.0
// The file arguments of command lines: their jobs and errors, lists of files (@LIST, and - for
// standard input), and reports on standard output (--report -).
#include "common/file_jobs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "common/command.h"
#include "common/text.h"
#include "support/invariants.h"
#include "support/shared_data.h"
#include "tools/file_jobs_words.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::jobs_text;
using test::message_of;
using test::ProgramResult;
using test::TemporaryDirectory;
using test::touch;
using test::Workplace;
using testing::HasSubstr;

std::filesystem::path same_name(const std::filesystem::path& input) {
    return input.filename();
}

JobList jobs(const FileWords& words) {
    return jobs_of(words, "map", same_name);
}

std::string refusal(const FileWords& words) {
    return message_of<UsageError>([&] { jobs(words); });
}

TEST(FileJobs, AFileIsTheSameByAnyPath) {
    const TemporaryDirectory folder;
    touch(folder / "a.png");
    std::filesystem::create_symlink("a.png", folder / "b.png");
    EXPECT_EQ(identity_of(folder / "b.png"), identity_of(folder / "a.png"));
    EXPECT_EQ(identity_of("none.png"), identity_of(std::filesystem::absolute("./none.png")));
    EXPECT_NE(identity_of(folder / "c.png"), identity_of(folder / "a.png"));
    // No file has such a name, but the function accepts it.
    const std::string endless(300, 'x');
    EXPECT_EQ(identity_of("./" + endless), identity_of(endless));
    EXPECT_NE(identity_of(endless + "y"), identity_of(endless));
}

TEST(FileJobs, TwoFilesAreInAndOut) {
    const JobList list = jobs({{"a.png", "b.exr"}, {}});
    EXPECT_EQ(jobs_text(list), "a.png -> b.exr");
    EXPECT_TRUE(list.is_single());
}

TEST(FileJobs, OutputMayBeAFileForOneInput) {
    EXPECT_EQ(jobs_text(jobs({{"a.png"}, "b.exr"})), "a.png -> b.exr");
    EXPECT_TRUE(jobs({{"a.png"}, "b.exr"}).is_single());
}

TEST(FileJobs, InAFolderEachHasTheNameThatTheCallerGives) {
    const JobList list = jobs_of({{"x/a.png", "b.tif"}, "out/"}, "map", [](const auto& input) {
        return input.stem().string() + "-normal.png";
    });
    EXPECT_EQ(jobs_text(list), "x/a.png -> out/a-normal.png, b.tif -> out/b-normal.png");
    EXPECT_EQ(list.folder, "out/");
    EXPECT_FALSE(jobs({{"a.png"}, "out/"}).is_single()) << "in a folder one is a batch of one";
}

TEST(FileJobs, ExistingFolderNeedsNoSlash) {
    const TemporaryDirectory folder;
    EXPECT_EQ(jobs_text(jobs({{"a.png"}, folder.path().string()})),
              "a.png -> " + (folder / "a.png").string());
}

TEST(FileJobs, AFileMayReplaceItselfButNoOther) {
    const TemporaryDirectory folder;
    const std::string here = folder.path().string() + "/";
    EXPECT_EQ(jobs({{here + "a.png", here + "b.png"}, here}).jobs.size(), 2U);
    // Both names are the same folder.
    std::filesystem::create_directory(folder / "x");
    EXPECT_EQ(refusal({{here + "a.png", here + "x/../a.png"}, here}),
              here + "x/../a.png: named twice");
    EXPECT_EQ(refusal({{here + "x/a.png", here + "a.png"}, here + "x/"}),
              here + "x/a.png and " + here + "a.png: have the same output " + here + "x/a.png");
}

TEST(FileJobs, RefusesAmbiguousNames) {
    EXPECT_EQ(refusal({{}, {}}), "IN is missing");
    EXPECT_EQ(refusal({{}, "out/"}), "IN is missing");
    EXPECT_EQ(refusal({{"a.png"}, {}}), "OUT is missing");
    EXPECT_EQ(refusal({{"a.png", "b.png", "c.png"}, {}}),
              "3 files: inputs and output are ambiguous");
    EXPECT_EQ(refusal({{"a.png", "b.png"}, "c.exr"}), "-o c.exr: is a file, but there are 2 maps");
    EXPECT_EQ(refusal({{"a.png"}, "nothing"}), "-o nothing: has no extension");
    EXPECT_EQ(refusal({{"a.png", "x/../a.png"}, "out/"}), "x/../a.png: named twice");
    EXPECT_EQ(refusal({{"a.png", "x/a.png"}, "out/"}),
              "a.png and x/a.png: have the same output out/a.png");
}

TEST(FileJobs, UdimNameYieldsItsTilesInOrder) {
    const TemporaryDirectory folder;
    // The last three are not tiles: a small number, a letter, five digits.
    for (const char* name : {"w.1012.png", "w.1001.png", "w.1002.exr", "v.1003.png", "w.1000.png",
                             "w.10x1.png", "w.10011.png"})
        touch(folder / name);
    const std::string here = folder.path().string() + "/";
    const JobList list = jobs({{here + "w.<UDIM>.png", "n_<UDIM>.exr"}, {}});
    EXPECT_EQ(jobs_text(list),
              here + "w.1001.png -> n_1001.exr, " + here + "w.1012.png -> n_1012.exr");
    EXPECT_FALSE(list.is_single());
    EXPECT_FALSE(list.folder);
    EXPECT_EQ(jobs_text(jobs({{here + "w.<UDIM>.png", here + "v.<UDIM>.png"}, "out/"})),
              here + "w.1001.png -> out/w.1001.png, " + here + "w.1012.png -> out/w.1012.png, " +
                  here + "v.1003.png -> out/v.1003.png");
}

TEST(FileJobs, UdimNamesComeInPairsAndHaveTiles) {
    const TemporaryDirectory folder;
    const std::string name = (folder / "w.<UDIM>.png").string();
    EXPECT_EQ(refusal({{name, "n.png"}, {}}),
              name + ", n.png: <UDIM> must be in both names or in none");
    EXPECT_EQ(refusal({{"n.png", name}, {}}),
              "n.png, " + name + ": <UDIM> must be in both names or in none");
    EXPECT_EQ(message_of<FileError>([&] {
                  jobs({{name, "n.<UDIM>.png"}, {}});
              }),
              name + ": there is no such tile (tiles are numbered 1001 and on)");
}

TEST(FileJobs, OutputsHaveNoUnknownPlaceholders) {
    EXPECT_EQ(refusal({{"w.png", "n_<tile>.png"}, {}}),
              "n_<tile>.png: <tile> is not a placeholder");
    EXPECT_EQ(refusal({{"w.png"}, "n.<udim>.png"}), "n.<udim>.png: <udim> is not a placeholder");
    EXPECT_EQ(jobs_text(jobs({{"w.png", "n_<2>.png"}, {}})), "w.png -> n_<2>.png");
    EXPECT_EQ(jobs_text(jobs({{"w.png", "n_<b.png"}, {}})), "w.png -> n_<b.png");
    EXPECT_EQ(jobs_text(jobs({{"w<tile>.png"}, "out/"})), "w<tile>.png -> out/w<tile>.png");
}

class FileLists : public testing::Test {
  protected:
    FileLists() {
        place_.write_square("a.obj");
        place_.write_square("b c.obj");
    }

    const Workplace place_;
};

TEST_F(FileLists, NameOneFilePerLine) {
    place_.write("list.txt", "a.obj\r\n\nb c.obj");
    const ProgramResult result =
        place_.run("relief-mesh process @list.txt -o out/ --format glb --quiet");
    EXPECT_EQ(result.exit_code, 0) << result.error;
    EXPECT_EQ(place_.outputs(), "a.glb b c.glb");
}

TEST_F(FileLists, MayComeFromStandardInput) {
    const ProgramResult lines = place_.run(
        "printf 'a.obj\\nb c.obj\\n' | relief-mesh process - -o out/ --format glb --quiet");
    EXPECT_EQ(lines.exit_code, 0) << lines.error;
    const ProgramResult zeros = place_.run(
        "printf 'a.obj\\0b c.obj\\0' | relief-mesh subdivide - -o out/ --format ply --quiet");
    EXPECT_EQ(zeros.exit_code, 0) << zeros.error;
    EXPECT_EQ(place_.outputs(), "a.glb a.ply b c.glb b c.ply");
}

TEST_F(FileLists, MayBeMixedWithNames) {
    place_.write("list.txt", "a.obj\n");
    const ProgramResult result = place_.run("relief-mesh check 'b c.obj' @list.txt --json");
    EXPECT_EQ(result.exit_code, 0) << result.error;
    const json report = json::parse(result.out);
    ASSERT_EQ(report["files"].size(), 2U);
    EXPECT_EQ(report["files"][0]["file"], "b c.obj");
    EXPECT_EQ(report["files"][1]["file"], "a.obj");
}

TEST_F(FileLists, BeginWithAByteOrderMarkOfUtf8) {
    place_.write("list.txt",
                 "\xEF\xBB\xBF"
                 "a.obj\r\n");
    const ProgramResult result =
        place_.run("relief-mesh process @list.txt -o out/ --format glb --quiet");
    EXPECT_EQ(result.exit_code, 0) << result.error;
    EXPECT_EQ(place_.outputs(), "a.glb");
}

TEST_F(FileLists, InUtf16AreRefused) {
    place_.write("list.txt", std::string("\xFF\xFE"
                                         "a\0.\0o\0b\0j\0",
                                         12));
    const ProgramResult result = place_.run("relief-mesh process @list.txt -o out/");
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.first_error_line(),
              "relief-mesh: error: @list.txt: is a list in UTF-16 (save it as UTF-8)");
}

TEST_F(FileLists, LeaveFoldersOutWithAWarning) {
    std::filesystem::create_directories(place_ / "models/inner");
    place_.write_square("models/inner/c.obj");
    const ProgramResult result =
        place_.run("find models | relief-mesh process - -o out/ --format glb --quiet");
    EXPECT_EQ(result.exit_code, 0) << result.error;
    EXPECT_EQ(result.error,
              "relief-mesh: warning: -: models is a folder and is left out\n"
              "relief-mesh: warning: -: models/inner is a folder and is left out\n");
    EXPECT_EQ(place_.outputs(), "c.glb");
    EXPECT_EQ(place_.run("relief-mesh process models/inner -o out/").exit_code, 2);
}

TEST_F(FileLists, AreRefusedIfEmpty) {
    place_.write("empty.txt", "\n\n");
    const ProgramResult empty = place_.run("relief-mesh process @empty.txt -o out/");
    EXPECT_EQ(empty.exit_code, 2);
    EXPECT_EQ(empty.first_error_line(),
              "relief-mesh: error: @empty.txt: lists no file (see relief-mesh process --help)");
    const ProgramResult input = place_.run("relief-mesh process - -o out/");
    EXPECT_EQ(input.exit_code, 2);
    EXPECT_THAT(input.error, HasSubstr("-: lists no file"));
    const ProgramResult missing = place_.run("relief-mesh process @none.txt -o out/");
    EXPECT_EQ(missing.exit_code, 1);
    EXPECT_THAT(missing.error, HasSubstr("relief-mesh: error: none.txt: "));
}

TEST_F(FileLists, ReportsOnStandardOutputReplaceTheSummary) {
    for (const std::string quiet : {"", " --quiet"}) {
        const ProgramResult one =
            place_.run("relief-mesh process a.obj out/a.glb --report -" + quiet);
        EXPECT_EQ(one.exit_code, 0) << one.error;
        EXPECT_EQ(json::parse(one.out)["output"], "out/a.glb");
    }
    const ProgramResult several =
        place_.run("relief-mesh process a.obj 'b c.obj' -o out/ --format glb --report -");
    EXPECT_EQ(json::parse(several.out)["files"].size(), 2U);
    // The next command in the same process prints its summary again.
    EXPECT_THAT(place_.run("relief-mesh process a.obj out/a.glb").out, HasSubstr("wrote     "));
    EXPECT_EQ(place_.outputs(), "a.glb b c.glb");
}

TEST(Findings, NameTexelsByColumnAndRow) {
    Report report;
    report.add("bent texel", "texel", 13, "is straightened");
    report.add("bent texel", "texel", 4, "is straightened");
    report.add("bent triangle", "triangle", 13, "is straightened");
    Findings findings;
    findings.add("map 1", report, 4);
    EXPECT_EQ(findings.lines()[0],
              "map 1: 2 x bent texel (column 0, row 1; column 1, row 3): is straightened");
    EXPECT_EQ(findings.lines()[1], "map 1: 1 x bent triangle (triangle 13): is straightened");
    const json list = findings.json();
    EXPECT_EQ(list[0]["texels"], json({{{"column", 0}, {"row", 1}}, {{"column", 1}, {"row", 3}}}));
    EXPECT_FALSE(list[1].contains("texels"));
}

}  // namespace
}  // namespace relief::tools
