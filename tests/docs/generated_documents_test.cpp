// SPDX-License-Identifier: Apache-2.0
// Generated documents equal new measurements, and relief-documents writes and checks them.
#include "docs/generated_documents.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "relief/mesh/image_file.h"
#include "support/images.h"
#include "support/labels.h"
#include "support/shared_data.h"

namespace relief::test {
namespace {

using testing::HasSubstr;

class GeneratedDocuments : public testing::TestWithParam<GeneratedDocument> {};

TEST_LABELS(slow);
TEST_P(GeneratedDocuments, EqualANewMeasurement) {
    if (GetParam().file != nullptr &&
        !std::filesystem::exists(shared_directory() / GetParam().file))
        GTEST_SKIP() << "needs " << GetParam().file;
    const std::string path = (source_directory() / "docs" / GetParam().page).string();
    const std::string page = contents_of_page(path);
    for (const PageSection& section : GetParam().sections())
        EXPECT_EQ(section_in(page, section.begin), section.text)
            << "run relief-documents " << GetParam().page;
}

INSTANTIATE_TEST_SUITE_P(All, GeneratedDocuments, testing::ValuesIn(generated_documents()),
                         [](const auto& document) { return document.param.name; });

// Another version of Mesa may round differently, but a changed method or sample changes more.
TEST_LABELS(slow);
TEST(DocumentPictures, EqualTheirScript) {
    const TemporaryDirectory folder;
    const std::filesystem::path script = source_directory() / "scripts/dev/document-pictures";
    const std::string command = fmt::format("RELIEF_TOOLS='{}' '{}' --folder '{}'", RELIEF_TOOLS,
                                            script.string(), folder.path().string());
    ASSERT_EQ(std::system(command.c_str()), 0) << command;
    std::size_t compared = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
        const std::filesystem::path name = entry.path().filename();
        const Image drawn = read_image(entry.path(), ImageUse::color);
        const Image stored = read_image(source_directory() / "docs/images" / name, ImageUse::color);
        ASSERT_EQ(drawn.sample_count(), stored.sample_count()) << name;
        const auto a = drawn.as<std::uint8_t>();
        const auto b = stored.as<std::uint8_t>();
        double sum = 0.0;
        for (std::size_t i = 0; i < a.size(); ++i)
            sum += std::abs(static_cast<int>(a[i]) - static_cast<int>(b[i]));
        EXPECT_LT(sum / static_cast<double>(a.size()), 0.25)
            << "run scripts/dev/document-pictures " << name.stem();
        ++compared;
    }
    EXPECT_GE(compared, 7U);
}

TEST(NormalMapErrorTables, MapsHaveTheSlopesThatRowsState) {
    for (const double slope : {0.05, 0.4, 1.5}) {
        EXPECT_NEAR(rms_slope_of(64, 64, waves_with_slope(64, 60, 4, slope, 51)), slope,
                    1e-12 * slope);
    }
    // Slopes of tiling waves have mean 0, so the variance along each axis is half of the mean
    // square.
    const std::string table = mip_tables();
    for (const double slope : {0.05, 0.1, 0.2, 0.4, 0.8, 1.6}) {
        const std::string row = fmt::format("| rms slope {:g} | ", slope);
        const std::size_t start = table.find(row);
        ASSERT_NE(start, std::string::npos) << row;
        const std::size_t second_column = table.find("| ", start + row.size()) + 2;
        // The table has four digits, and normals are rounded to float.
        EXPECT_NEAR(std::stod(table.substr(second_column)), slope * slope / 2.0, 5.1e-5) << row;
    }
}

TEST(PageSections, AreReplacedBetweenTheirLines) {
    const std::string page = "a\n<!-- x -->\nold\n<!-- end of tables -->\nb\n";
    EXPECT_EQ(with_sections(page, {{"<!-- x -->\n", "new\n"}}),
              "a\n<!-- x -->\nnew\n<!-- end of tables -->\nb\n");
    EXPECT_EQ(with_sections(page, {{"", "all"}}), "all");
    EXPECT_EQ(section_in(page, "<!-- x -->\n"), "old\n");
    EXPECT_THROW(section_in(page, "<!-- y -->\n"), std::runtime_error);
}

TEST(DocumentsProgram, CheckReportsADifferenceAndWritesNothing) {
    const TemporaryDirectory docs;
    const std::filesystem::path page = docs / "hard-cases.md";
    std::ofstream(page) << "old\n";
    EXPECT_EQ(run_documents({"--check", "hard-cases.md"}, docs.path()), 1);
    EXPECT_EQ(contents_of_page(page.string()), "old\n");
    EXPECT_EQ(run_documents({"hard-cases.md"}, docs.path()), 0);
    EXPECT_THAT(contents_of_page(page.string()), HasSubstr("`relief-documents` writes this page"));
    EXPECT_EQ(run_documents({"--check", "hard-cases.md"}, docs.path()), 0);
}

TEST(AccuracyOfAssets, StatesTheRecommendationAndTheEfficientMethods) {
    const TemporaryDirectory folder;
    std::ofstream(folder / "accuracy.json") << R"({"experiments": [
        {"id": "own/a.png/bump", "title": "Normals from heights of a.png", "input": "8 x 8 texels",
         "command": "relief-accuracy own a.png", "truth": "The best.", "error_unit": "degrees",
         "finding": "max: 1 degree. To do it: relief-bake bump a.png OUT.png",
         "measurements": [
           {"method": "area", "efficient": false, "error": {"rms": 2, "p99": 3, "max": 4},
            "cost": {"one_thread": {"median": 0.002, "p10": 0.001, "p90": 0.003}}},
           {"method": "max", "efficient": true, "error": {"rms": 1, "p99": 1.5, "max": 2},
            "cost": {"one_thread": {"median": 0.001, "p10": 0.001, "p90": 0.002}}}]}]})";
    const AccuracySection section = accuracy_of_assets({folder.path()});
    EXPECT_EQ(section.section.text,
              "\n### Normals from heights of a.png\n"
              "`relief-accuracy own a.png` recommends max: 1 degree. To do it: "
              "`relief-bake bump a.png OUT.png`\n\nReference: The best.\n\n"
              "`own/a.png/bump`, 8 x 8 texels; errors in degrees:\n\n"
              "| | RMS | 99 % | max | one thread |\n|---|---|---|---|---|\n"
              "| area | 2 | 3 | 4 | 2.00 ms |\n| **max** | 1 | 1.50 | 2 | 1.00 ms |\n");
    EXPECT_EQ(run_documents({"--accuracy", folder.path().string()}, folder.path()), 1)
        << "the report has no main experiments";
}

TEST(DocumentsProgram, RefusesUnknownPagesAndOptions) {
    const TemporaryDirectory docs;
    for (const std::vector<std::string>& arguments : {std::vector<std::string>{"--help"},
                                                      {"unknown.md"},
                                                      {""},
                                                      {"--accuracy"},
                                                      {"--accuracy", "--check", "folder"}}) {
        EXPECT_EQ(run_documents(arguments, docs.path()), 2);
    }
    EXPECT_EQ(run_documents({"--accuracy", "no-folder"}, docs.path()), 1);
    EXPECT_TRUE(std::filesystem::is_empty(docs.path()));
}

}  // namespace
}  // namespace relief::test
