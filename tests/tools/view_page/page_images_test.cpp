// SPDX-License-Identifier: Apache-2.0
// Images of pages in less space. view_page_test.py compares their pictures in a browser.
#include "page_images.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::ProgramResult;
using test::Workplace;
using testing::ElementsAre;

TEST(PackedSamples, AreDifferencesToTheLeft) {
    const std::vector<std::uint8_t> codes = {10, 200, 12, 190, 0, 255};
    EXPECT_THAT(packed_samples(codes, 4, 2), ElementsAre(10, 200, 2, 246, 0, 255));
    // 0x0102, then 0x0202 - 0x0102 and 0x0000 - 0x0202 = 0xfdfe: lower bytes first.
    const std::vector<std::uint16_t> wide = {0x0102, 0x0202, 0x0000};
    EXPECT_THAT(packed_samples(wide, 3, 1), ElementsAre(0x02, 0x00, 0xfe, 0x01, 0x01, 0xfd));
}

TEST(UnitNormals, HaveAZThatFollows) {
    // (0.6, 0, 0.8) and flat, with both codes of zero; then a vector that is too short.
    const auto middle =
        unit_normal_codes(std::vector<std::uint16_t>{52428, 32768, 58982, 32768, 32768, 65535});
    ASSERT_TRUE(middle);
    EXPECT_EQ(middle->zero, 32768.0);
    const auto half = unit_normal_codes(
        std::vector<std::uint16_t>{13107, 32768, 58982, 26214, 32768, 64873, 32768, 32768, 65535});
    ASSERT_TRUE(half);
    EXPECT_FALSE(unit_normal_codes(std::vector<std::uint16_t>{52428, 32768, 58988}));
    EXPECT_FALSE(unit_normal_codes(std::vector<std::uint16_t>{52428, 32768, 6554})) << "z < 0";
}

TEST(PageImages, MakePagesOfHeightMapsSmall) {
    const Workplace workplace;
    const std::string page =
        "relief-view data/vase.obj --output out/vase.html --json --quiet --height-map "
        "data/bricks-height.png ";
    // The map of 1024 x 1024 normals of 48 bits deflates to 5.7 MB, which are 7.6 MB in base64.
    for (const auto& [option, megabytes] :
         {std::pair{"", 1.7}, {"--compare kernel=scharr3", 1.8}, {"--height-as bump_map", 1.7}}) {
        const ProgramResult result = workplace.run(page + option);
        ASSERT_EQ(result.exit_code, 0) << result.error;
        const double bytes = json::parse(result.out)["page"]["bytes"];
        EXPECT_LT(bytes, 1e6 * megabytes) << option;
        EXPECT_GT(bytes, 1e6) << option;
    }
}

}  // namespace
}  // namespace relief::tools
