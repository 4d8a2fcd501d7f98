// SPDX-License-Identifier: Apache-2.0
// relief-view: a model and what is asked of it, in a window or drawn to an image file.
// Tests: tests/tools/relief_view_test.cpp.
#include "view_command.h"

int main(int argc, char** argv) {
    using namespace relief::tools;
    return run_tool(
        {"relief-view",
         "Shows a model with normal, height, diffuse and environment maps, or draws it to a file.",
         {add_view_command}},
        argc, argv);
}
