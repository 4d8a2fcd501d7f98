// SPDX-License-Identifier: Apache-2.0
// relief-view: a model and what is asked of it, in a window or drawn to an image file.
#include "view_command.h"

namespace relief::tools {

Tool relief_view() {
    return {
        "relief-view",
        "Shows a model with normal, height, diffuse and environment maps, or draws it to a file.",
        {add_view_command}};
}

}  // namespace relief::tools
