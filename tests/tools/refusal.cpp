// SPDX-License-Identifier: Apache-2.0
#include "tools/refusal.h"

#include <gmock/gmock.h>

namespace relief::test {

// GoogleTest finds this by its name.
void PrintTo(const Refused& refused,
             std::ostream* stream) {  // NOLINT(readability-identifier-naming)
    *stream << refused.line;
}

void expect_refusal(const Workplace& workplace, const std::string& tool, const Refused& refused,
                    const std::string& old_file) {
    workplace.write("out/" + old_file, "old");
    const ProgramResult result = workplace.run(refused.line);
    EXPECT_EQ(result.exit_code, refused.exit_code);
    EXPECT_THAT(result.first_error_line(), testing::HasSubstr(tool + ": error: " + refused.error));
    EXPECT_EQ(result.error, result.first_error_line() + "\n");
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(workplace.outputs(), old_file);
    EXPECT_EQ(workplace.read("out/" + old_file), "old");
}

}  // namespace relief::test
