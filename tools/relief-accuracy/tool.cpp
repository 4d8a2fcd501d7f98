// SPDX-License-Identifier: Apache-2.0
// relief-accuracy: what accuracy costs in time. Each command stands in its own file.
#include "commands.h"

namespace relief::tools {

Tool relief_accuracy() {
    return {"relief-accuracy",
            "Says what accuracy costs: each method's error beside the time that it takes.",
            {add_run_command, add_own_command, add_report_compare_command, add_page_command}};
}

}  // namespace relief::tools
