// SPDX-License-Identifier: Apache-2.0
// relief-mesh: what can be done to a mesh file. Each command stands in its own file.
// Tests: tests/tools/relief_mesh_test.cpp.
#include "commands.h"

int main(int argc, char** argv) {
    using namespace relief::tools;
    return run_tool(
        {"relief-mesh",
         "Computes normals and tangents of meshes, makes them coarser or finer, and says what is "
         "in mesh files and what is wrong with them.",
         {add_process_command, add_decimate_command, add_subdivide_command, add_info_command,
          add_check_command}},
        argc, argv);
}
