// SPDX-License-Identifier: Apache-2.0
#include "tools/linked_tools.h"

#include "common/command.h"
#include "relief-accuracy/commands.h"
#include "relief-bake/commands.h"
#include "relief-mesh/commands.h"
#include "relief-view/view_command.h"

namespace relief::test {
namespace {

ToolEntry entry_of(tools::Tool (*tool)()) {
    return [tool](const std::vector<std::string>& arguments, std::FILE* out, std::FILE* err) {
        return tools::run_tool(tool(), arguments, out, err);
    };
}

[[maybe_unused]] const bool are_linked =
    link_tool("relief-accuracy", entry_of(tools::relief_accuracy)) &&
    link_tool("relief-bake", entry_of(tools::relief_bake)) &&
    link_tool("relief-mesh", entry_of(tools::relief_mesh)) &&
    link_tool("relief-view", entry_of(tools::relief_view));

}  // namespace
}  // namespace relief::test
