// SPDX-License-Identifier: Apache-2.0
// `relief mesh ...` becomes `relief-mesh ...`. Tests: tests/tools/relief_make_test.cpp.
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "driver.h"

namespace relief::tools {
namespace {

/// Returns the folder of this program; empty if the system does not state it.
std::filesystem::path own_folder(const char* called) {
    std::error_code error;
    const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
    if (!error) return self.parent_path();
    return std::filesystem::path(called).parent_path();
}

Command add_sibling(CLI::App& tool, const SiblingTool& sibling) {
    CLI::App& app = add_subcommand(tool, sibling.command, sibling.sentence);
    const std::string name = sibling.command;
    return {&app, [name]() -> ExitCode {
                throw UsageError(fmt::format("{}: must be the first argument", name),
                                 fmt::format("relief {} ...", name));
            }};
}

}  // namespace

std::filesystem::path sibling_program(const std::string& name) {
    const std::filesystem::path beside = own_folder("") / name;
    std::error_code error;
    return std::filesystem::exists(beside, error) ? beside : std::filesystem::path(name);
}

void become_tool(int argc, char** argv) {
    if (argc < 2) return;
    for (const SiblingTool& sibling : sibling_tools) {
        if (std::strcmp(argv[1], sibling.command) != 0) continue;
        const std::string name = fmt::format("relief-{}", sibling.command);
        const std::string beside = (own_folder(argv[0]) / name).string();
        std::vector<char*> arguments(argv + 1, argv + argc);
        arguments.push_back(nullptr);
        std::string shown = name;
        arguments.front() = shown.data();
        ::execv(beside.c_str(), arguments.data());
        if (errno == ENOENT) ::execvp(name.c_str(), arguments.data());
        fmt::print(stderr, "relief: error: {}: {} (install the tools of relief together)\n", name,
                   std::strerror(errno));
        std::exit(static_cast<int>(ExitCode::failed));
    }
}

Command add_mesh_tool(CLI::App& tool) {
    return add_sibling(tool, sibling_tools[0]);
}

Command add_bake_tool(CLI::App& tool) {
    return add_sibling(tool, sibling_tools[1]);
}

Command add_view_tool(CLI::App& tool) {
    return add_sibling(tool, sibling_tools[2]);
}

Command add_accuracy_tool(CLI::App& tool) {
    return add_sibling(tool, sibling_tools[3]);
}

}  // namespace relief::tools
