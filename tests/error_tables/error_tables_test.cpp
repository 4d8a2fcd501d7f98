// SPDX-License-Identifier: Apache-2.0
// The tables in docs/ equal new measurements.
#include "error_tables/error_tables.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "support/images.h"

namespace relief::test {
namespace {

/// \param topic  as in the name of the program that writes the page
void expect_in_page(const std::string& topic, const std::string& page_name,
                    const std::vector<PageSection>& sections) {
    const std::string page = contents_of_page(RELIEF_SOURCE_DIR "/docs/" + page_name);
    for (const PageSection& section : sections) {
        EXPECT_EQ(section_in(page, section.begin), section.text)
            << "run relief-" << topic << "-errors-page docs/" << page_name;
    }
}

TEST(NormalErrorTables, AreThoseOfThePage) {
    expect_in_page("normal", "normals.md", normal_tables());
}

TEST(TangentErrorTables, AreThoseOfThePage) {
    expect_in_page("tangent", "tangents.md", tangent_tables());
}

TEST(BumpErrorTables, OfKernelsAreThoseOfThePage) {
    expect_in_page("bump", "bump.md", {kernel_tables()});
}

TEST(BumpErrorTables, OfChoicesAreThoseOfThePage) {
    expect_in_page("bump", "bump.md", {choice_tables()});
}

TEST(BumpErrorTables, OfStepsAreThoseOfThePage) {
    expect_in_page("bump", "bump.md", {step_tables()});
}

TEST(BumpErrorTables, OfDepthsAreThoseOfThePage) {
    expect_in_page("bump", "bump.md", {depth_tables()});
}

TEST(NormalMapErrorTables, AreThoseOfThePage) {
    expect_in_page("normal-map", "normal-maps.md", normal_map_tables());
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

TEST(BakeErrorTables, AreThoseOfThePage) {
    expect_in_page("bake", "bake.md", bake_tables());
}

TEST(ErrorPages, AreNotWrittenUnderTheNameOfAnOption) {
    for (const char* argument : {"--help", "-h", ""}) {
        const std::array<const char*, 2> arguments = {"relief-normal-errors-page", argument};
        EXPECT_EQ(write_sections(2, arguments.data(),
                                 []() -> std::vector<PageSection> {
                                     ADD_FAILURE() << "measures";
                                     return {};
                                 }),
                  2);
        EXPECT_FALSE(std::filesystem::exists(argument));
    }
}

}  // namespace
}  // namespace relief::test
