// SPDX-License-Identifier: Apache-2.0
// relief-bake: makes normal maps. Each command stands in its own file.
// Tests: tests/tools/relief_bake_test.cpp.
#include "commands.h"

int main(int argc, char** argv) {
    using namespace relief::tools;
    return run_tool({"relief-bake",
                     "Makes normal maps.",
                     {add_bump_command, add_mesh_command, add_convert_command,
                      add_map_check_command, add_heights_command}},
                    argc, argv);
}
