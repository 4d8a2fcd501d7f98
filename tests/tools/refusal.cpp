// SPDX-License-Identifier: Apache-2.0
#include "tools/refusal.h"

#include <gmock/gmock.h>

namespace relief::test {

void expect_refusal(const Workplace& workplace, const std::string& tool, const Refused& refused,
                    const std::string& old_file) {
    const std::string line =
        refused.line.starts_with(tool) ? refused.line : tool + " " + refused.line;
    SCOPED_TRACE(line);
    std::filesystem::remove_all(workplace / "out");
    std::filesystem::create_directory(workplace / "out");
    workplace.write("out/" + old_file, "old");
    const ProgramResult result = workplace.run(line);
    EXPECT_EQ(result.exit_code, refused.exit_code);
    EXPECT_THAT(result.first_error_line(), testing::HasSubstr(tool + ": error: " + refused.error));
    EXPECT_EQ(result.error, result.first_error_line() + "\n");
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(workplace.outputs(), old_file);
    EXPECT_EQ(workplace.read("out/" + old_file), "old");
}

void expect_refusals(const Workplace& workplace, const std::string& tool,
                     const std::string& old_file, const std::vector<Refused>& rows) {
    for (const Refused& row : rows)
        expect_refusal(workplace, tool, row, old_file);
}

}  // namespace relief::test
