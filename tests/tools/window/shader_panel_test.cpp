// SPDX-License-Identifier: Apache-2.0
#include "window/shader_panel.h"

#include <gtest/gtest.h>

namespace relief::tools {
namespace {

TEST(ShaderPanel, NumbersLinesInAColumn) {
    EXPECT_EQ(numbered_lines("#version 330 core\n\nvoid main() {}\n"),
              "1  #version 330 core\n2  \n3  void main() {}\n");
    std::string ten;
    for (int i = 0; i < 10; ++i)
        ten += "x\n";
    EXPECT_EQ(numbered_lines(ten).substr(0, 10), " 1  x\n 2  ");
    EXPECT_EQ(numbered_lines(ten).substr(54), "10  x\n");
    EXPECT_EQ(numbered_lines("no end"), "1  no end\n");
    EXPECT_EQ(numbered_lines(""), "");
}

}  // namespace
}  // namespace relief::tools
