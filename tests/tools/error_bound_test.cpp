// SPDX-License-Identifier: Apache-2.0
// --max-error has the same meaning in all commands.
#include "common/error_bound.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tools/help_pages.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using namespace relief::test;
using testing::HasSubstr;

ErrorStats four_errors() {
    ErrorStats errors;
    errors.mean = 1.0;
    errors.rms = 2.0;
    errors.p99 = 3.0;
    errors.max = 4.0;
    return errors;
}

TEST(ErrorBound, LimitsThe99PercentErrorUnlessAnotherStatisticIsGiven) {
    ErrorBound bound;
    EXPECT_TRUE(bound.allows(four_errors()));
    bound.degrees = 2.5;
    EXPECT_EQ(bound.error(four_errors()), 3.0);
    EXPECT_FALSE(bound.allows(four_errors()));
    EXPECT_EQ(to_string(bound), "2.5 degrees (99 %)");
    bound.kind = ErrorKind::mean;
    EXPECT_EQ(bound.error(four_errors()), 1.0);
    EXPECT_EQ(to_string(bound), "2.5 degrees (mean)");
    bound.kind = ErrorKind::rms;
    EXPECT_TRUE(bound.allows(four_errors()));
    EXPECT_EQ(to_string(bound), "2.5 degrees (RMS)");
    bound.kind = ErrorKind::max;
    EXPECT_FALSE(bound.allows(four_errors()));
    EXPECT_EQ(to_string(bound), "2.5 degrees (maximum)");
}

TEST(ErrorBound, AKindNeedsALimit) {
    ErrorBound bound;
    bound.kind = ErrorKind::rms;
    EXPECT_THROW(check(bound), UsageError);
    EXPECT_NO_THROW(check(bound, true));
    bound.degrees = 1.0;
    EXPECT_NO_THROW(check(bound));
}

/// The page with every run of white space as one blank.
std::string in_one_line(const std::string& page) {
    std::string line;
    for (const char letter : page) {
        const bool is_blank = letter == ' ' || letter == '\n';
        if (!is_blank || (!line.empty() && line.back() != ' ')) line += is_blank ? ' ' : letter;
    }
    return line;
}

TEST(MaxError, HasOneMeaningInAllCommands) {
    const Workplace workplace;
    int of_angles = 0, of_distances = 0;
    for (const std::string& command : commands_with_help(workplace)) {
        const std::string page = in_one_line(workplace.run(command + " --help all").out);
        if (page.find("--max-error DEG") != std::string::npos) {
            ++of_angles;
            EXPECT_THAT(page, HasSubstr("--max-error-kind mean|rms|p99|max")) << command;
            EXPECT_THAT(page, HasSubstr("or the maximum. Default: p99.")) << command;
        } else if (page.find("--max-error ") != std::string::npos) {
            ++of_distances;
            EXPECT_THAT(page, HasSubstr("--max-error E Maximum distance")) << command;
        }
    }
    EXPECT_EQ(of_angles, 7);     // bump, mesh, check, convert, own, fidelity and make
    EXPECT_EQ(of_distances, 2);  // decimate and displace
}

}  // namespace
}  // namespace relief::tools
