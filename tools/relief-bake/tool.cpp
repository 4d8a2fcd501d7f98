// SPDX-License-Identifier: Apache-2.0
// relief-bake: makes normal maps. Each command stands in its own file.
#include "commands.h"

namespace relief::tools {

Tool relief_bake() {
    return {"relief-bake",
            "Makes normal maps.",
            {add_bump_command, add_mesh_command, add_convert_command, add_map_check_command,
             add_heights_command}};
}

}  // namespace relief::tools
