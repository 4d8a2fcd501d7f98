// SPDX-License-Identifier: Apache-2.0
// docs/normal-maps.md says what is measured, not what once was.
#include "normal_map_errors/error_tables.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "support/resized_waves.h"

namespace relief::test {
namespace {

TEST(NormalMapErrorTables, AreThoseOfThePage) {
    const std::string page = contents_of_page(RELIEF_SOURCE_DIR "/docs/normal-maps.md");
    for (const PageSection& section : normal_map_tables()) {
        EXPECT_EQ(section_in(page, section.begin), section.text)
            << "run relief-normal-map-errors-page docs/normal-maps.md";
    }
}

TEST(NormalMapErrorTables, MapsHaveTheSlopesThatRowsState) {
    for (const double slope : {0.05, 0.4, 1.5}) {
        EXPECT_NEAR(rms_slope_of(64, 64, waves_with_slope(64, 60, 4, slope, 51)), slope,
                    1e-12 * slope);
    }
    // Slopes of waves that tile have mean 0, so the variance along each axis is half of the mean
    // square.
    const std::string table = mip_tables();
    for (const double slope : {0.05, 0.1, 0.2, 0.4, 0.8, 1.6}) {
        const std::string row = fmt::format("| rms slope {:g} | ", slope);
        const std::size_t start = table.find(row);
        ASSERT_NE(start, std::string::npos) << row;
        // The second column, after the mean length.
        const std::size_t second = table.find("| ", start + row.size()) + 2;
        // The table has four digits, and normals are rounded to float.
        EXPECT_NEAR(std::stod(table.substr(second)), slope * slope / 2.0, 5.1e-5) << row;
    }
}

}  // namespace
}  // namespace relief::test
