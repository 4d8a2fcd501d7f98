// SPDX-License-Identifier: Apache-2.0
// The index page of a batch of `relief make`.
#include "make_index.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tools/workplace.h"

namespace relief::tools {
namespace {

using test::ProgramResult;
using test::Workplace;
using testing::ElementsAre;
using testing::HasSubstr;

IndexEntry entry_of(const std::string& input, const std::string& error, const Json& facts) {
    return {{input, input + ".glb"}, error, facts};
}

TEST(MakeIndex, HasTheWorstModelsFirst) {
    std::vector<IndexEntry> entries = {
        entry_of("unknown", "", nullptr),
        entry_of("damaged", "", {{"flip", "0.9"}, {"findings", 3}}),
        entry_of("sound", "", {{"flip", nullptr}, {"findings", Json::array()}}),
        entry_of("finding", "", {{"flip", nullptr}, {"findings", {"a"}}}),
        entry_of("good", "", {{"flip", 0.01}, {"findings", {"a", "b"}}}),
        entry_of("bad", "", {{"flip", 0.2}, {"findings", Json::array()}}),
        entry_of("failed", "no triangles", nullptr)};
    sort_worst_first(entries);
    std::vector<std::string> names;
    for (const IndexEntry& entry : entries)
        names.push_back(entry.job.input.string());
    EXPECT_THAT(names,
                ElementsAre("failed", "bad", "good", "finding", "unknown", "damaged", "sound"));
}

TEST(MakeIndex, ShowsEveryModelAndLoadsNothing) {
    const Workplace workplace;
    std::filesystem::create_directory(workplace / "in");
    workplace.write_square("in/a&b.obj");
    workplace.write_square("in/b.obj");
    workplace.write("in/empty.ply", "");
    const std::string line =
        "relief make 'in/a&b.obj' in/b.obj in/empty.ply -o out/ --size 32 --padding 2 "
        "--occlusion-rays 0 --report out/index.html";
    for (const bool unchanged : {false, true}) {
        const ProgramResult result = workplace.run(line);
        EXPECT_EQ(result.exit_code, 1);
        EXPECT_EQ(result.out.find("unchanged") != std::string::npos, unchanged);
        const std::string page = workplace.read("out/index.html");
        EXPECT_THAT(page, HasSubstr("3 models, of which 1 failed."));
        EXPECT_THAT(page, HasSubstr("Failed: in/empty.ply: "));
        EXPECT_THAT(page, HasSubstr("<h2>a&amp;b.glb</h2>\n<p class=\"figures\">2 triangles of 2"));
        EXPECT_THAT(page, HasSubstr("source with fewer triangles than requested"));
        EXPECT_LT(page.find("empty.ply"), page.find("b.glb"));
        EXPECT_EQ(page.find("could not be drawn"), std::string::npos);
        std::size_t pictures = 0;
        for (std::size_t at = page.find("src=\"data:image/png"); at != std::string::npos;
             at = page.find("src=\"data:image/png", at + 1))
            ++pictures;
        EXPECT_EQ(pictures, 2U);
        for (const char* address : {"http://", "https://"})
            EXPECT_EQ(page.find(address), std::string::npos) << address;
        EXPECT_EQ(page.find("{{"), std::string::npos);
    }
    EXPECT_EQ(workplace.outputs(), "a&b.glb b.glb index.html relief-make.json");
}

}  // namespace
}  // namespace relief::tools
