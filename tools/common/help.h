// SPDX-License-Identifier: Apache-2.0
/// \file
/// The description of a tool for its users: help pages and their JSON form, written from the
/// options as the commands add them. scripts/dev/make-manuals writes manual pages and completions
/// from the JSON.
///
/// Tests: tests/tools/help_test.cpp, command_test.cpp.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace relief::tools {

struct Tool;

/// Gives a tool the layout of relief's help pages: one sentence, usage, commands or arguments,
/// options by heading, examples. Subcommands that are added later inherit it.
void use_help_pages(CLI::App& tool);

/// "relief-mesh process"
std::string full_name(const CLI::App& app);

/// Makes the help pages list all options, also the advanced ones.
void show_advanced_options(CLI::App& tool);

/// Sets the words that the option accepts, for completions.
void set_words(CLI::App& app, const CLI::Option& option, const std::vector<std::string>& words);

/// Describes a tool or a command as JSON:
///
/// - `name`, `description`, `version` (of a tool),
/// - `commands`: an array of the same objects, for a tool with commands,
/// - `arguments`: an array of `name`, `description`, `required`, `repeats`,
/// - `options`: an array of `name`, `short` (if any), `value` (null for a switch), `words` (if only
///   these are valid), `heading`, `description`, `advanced`,
/// - `examples`: an array of command lines.
nlohmann::ordered_json describe(const CLI::App& app);

/// The same for a tool that does not run.
nlohmann::ordered_json describe(const Tool& tool);

}  // namespace relief::tools
