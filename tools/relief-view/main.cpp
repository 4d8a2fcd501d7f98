// SPDX-License-Identifier: Apache-2.0
// relief-view: a model and what is asked of it, drawn to an image file.
// Tests: tests/tools/relief_view_test.cpp.
#include "view_command.h"

int main(int argc, char** argv) {
    using namespace relief::tools;
    return run_tool(
        {"relief-view",
         "Draws a model with normal, height, diffuse and environment maps to an image file.",
         {add_view_command}},
        argc, argv);
}
