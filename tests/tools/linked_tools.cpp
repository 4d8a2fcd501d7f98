// SPDX-License-Identifier: Apache-2.0
#include "tools/linked_tools.h"

#include <map>

#include "common/command.h"
#include "relief-accuracy/commands.h"
#include "relief-bake/commands.h"
#include "relief-mesh/commands.h"
#include "relief-view/view_command.h"
#include "relief/driver.h"

namespace relief::test {
namespace {

ToolEntry entry_of(tools::Tool (*tool)()) {
    return [tool](const std::vector<std::string>& arguments, std::FILE* out, std::FILE* err) {
        return tools::run_tool(tool(), arguments, out, err);
    };
}

/// A process would become the tool of its first argument.
int run_driver(const std::vector<std::string>& arguments, std::FILE* out, std::FILE* err) {
    using Entry = tools::Tool (*)();
    const std::map<std::string, Entry> siblings = {{"accuracy", tools::relief_accuracy},
                                                   {"bake", tools::relief_bake},
                                                   {"mesh", tools::relief_mesh},
                                                   {"view", tools::relief_view}};
    const auto sibling = siblings.find(arguments.empty() ? "" : arguments.front());
    if (sibling == siblings.end())
        return tools::run_tool(tools::relief_driver(), arguments, out, err);
    return tools::run_tool(sibling->second(), {arguments.begin() + 1, arguments.end()}, out, err);
}

[[maybe_unused]] const bool are_linked =
    link_tool("relief", run_driver) &&
    link_tool("relief-accuracy", entry_of(tools::relief_accuracy)) &&
    link_tool("relief-bake", entry_of(tools::relief_bake)) &&
    link_tool("relief-mesh", entry_of(tools::relief_mesh)) &&
    link_tool("relief-view", entry_of(tools::relief_view));

}  // namespace
}  // namespace relief::test
