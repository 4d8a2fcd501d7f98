// SPDX-License-Identifier: Apache-2.0
/// \file
/// The tool relief: its own commands, make, check, merge and farm, and the other tools as commands.
/// Tests: tests/tools/relief_make_test.cpp, farm_test.cpp.
#pragma once

#include <array>
#include <filesystem>
#include <string>

#include "common/command.h"

namespace relief::tools {

/// A tool that is a command of relief: "relief mesh" runs relief-mesh.
struct SiblingTool {
    const char* command;
    const char* sentence;
};

inline constexpr std::array sibling_tools = {
    SiblingTool{"mesh",
                "Runs relief-mesh: normals, tangents, decimation, unwrapping, levels of "
                "detail, checks and comparisons of models."},
    SiblingTool{"bake",
                "Runs relief-bake: normal maps from heights and from dense models, their "
                "conversion, packing and checks."},
    SiblingTool{"view", "Runs relief-view: pictures of models, in a window or as files."},
    SiblingTool{"accuracy",
                "Runs relief-accuracy: the error and the time of each method, on "
                "known surfaces and on your own files."},
};

/// Replaces this process by another tool if the first argument is its command; all further
/// arguments and the exit code are those of the tool. The tool is searched beside this program,
/// then in PATH. If it cannot be run, the process ends with the exit code 1.
void become_tool(int argc, char** argv);

/// Returns the file of another tool beside this program, or only its name, for PATH.
std::filesystem::path sibling_program(const std::string& name);

Command add_make_command(CLI::App& tool);
Command add_check_files_command(CLI::App& tool);
Command add_merge_check_command(CLI::App& tool);
Command add_farm_command(CLI::App& tool);

/// Adds the commands of sibling_tools, for the help page.
Command add_mesh_tool(CLI::App& tool);
Command add_bake_tool(CLI::App& tool);
Command add_view_tool(CLI::App& tool);
Command add_accuracy_tool(CLI::App& tool);

/// The whole tool, for main() and for tests that run it in their own process.
inline Tool relief_driver() {
    return {"relief",
            "Makes assets from dense meshes, checks assets, and runs the other tools of relief.",
            {add_make_command, add_check_files_command, add_merge_check_command, add_farm_command,
             add_mesh_tool, add_bake_tool, add_view_tool, add_accuracy_tool}};
}

}  // namespace relief::tools
