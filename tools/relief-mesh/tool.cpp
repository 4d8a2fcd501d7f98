// SPDX-License-Identifier: Apache-2.0
// relief-mesh: what can be done to a mesh file. Each command stands in its own file.
#include "commands.h"

namespace relief::tools {

Tool relief_mesh() {
    return {
        "relief-mesh",
        "Gives meshes normals, tangents and other resolutions; says what is in them, and wrong.",
        {add_process_command, add_decimate_command, add_subdivide_command, add_info_command,
         add_check_command, add_compare_command, add_conformance_command}};
}

}  // namespace relief::tools
