// SPDX-License-Identifier: Apache-2.0
#include "docs/shown_commands.h"

#include <gtest/gtest.h>

namespace relief::test {
namespace {

TEST(ShownCommands, StandBehindAPromptOrInAShellBlock) {
    const std::vector<ShownCommand> commands = shown_commands(
        "relief-mesh turns meshes\n"            // prose
        "$ relief-mesh info a.obj\n"            // 2
        "```sh\n"                               //
        "build/release/bin/relief-bake bump\n"  // 4
        "git clone somewhere\n"                 //
        "  $ scripts/demo --fast\n"             // 6
        "```\n"                                 //
        "```cpp\n"                              //
        "relief-mesh in code\n"                 //
        "```\n"                                 //
        "```console\n"                          //
        "$ relief-view a.obj \\\n"              // 12
        "      --output b.png\n"                //
        "relief-view: error: said so\n"         // 14: output that looks like a command
        "```\n");
    ASSERT_EQ(commands.size(), 4U);
    EXPECT_EQ(commands[0].line, 2);
    EXPECT_EQ(commands[0].text, "relief-mesh info a.obj");
    EXPECT_EQ(commands[1].text, "build/release/bin/relief-bake bump");
    EXPECT_EQ(commands[2].text, "scripts/demo --fast");
    EXPECT_EQ(commands[3].line, 12);
    EXPECT_EQ(commands[3].text, "relief-view a.obj --output b.png");
}

TEST(ShownCommands, KnowWhichScriptTheyCall) {
    EXPECT_EQ(called_script("scripts/demo --fast"), "scripts/demo");
    EXPECT_EQ(called_script("./scripts/test"), "scripts/test");
    EXPECT_EQ(called_script("relief-mesh info scripts/demo"), "");
}

}  // namespace
}  // namespace relief::test
