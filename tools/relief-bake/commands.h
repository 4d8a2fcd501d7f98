// SPDX-License-Identifier: Apache-2.0
/// \file
/// The commands of relief-bake, and what they share: converting one map or many files, and the
/// options for how a normal map is stored. Tests: tests/tools/relief_bake_bump_test.cpp,
/// relief_bake_convert_test.cpp.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/command.h"
#include "common/file_jobs.h"
#include "common/options.h"
#include "common/summary.h"
#include "engines.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/normal_map.h"

namespace relief::tools {

/// The whole tool, for main() and for tests that run it in their own process.
Tool relief_bake();

Command add_bump_command(CLI::App& tool);
Command add_mesh_command(CLI::App& tool);
Command add_merge_command(CLI::App& tool);
Command add_convert_command(CLI::App& tool);
Command add_map_check_command(CLI::App& tool);
Command add_heights_command(CLI::App& tool);
Command add_pack_command(CLI::App& tool);
Command add_textures_command(CLI::App& tool);

/// Returns whether a file is a texture for GPUs, by its extension.
bool is_texture(const std::filesystem::path& file);

/// Adds --outside drop|repeat. Target: bool or an optional of it, true for repeat.
template <typename Target>
AddedOption add_outside_option(CLI::App& app, Target& repeats, const std::string& description) {
    return add_choice(app, "--outside", repeats, Choices<bool>{{"drop", false}, {"repeat", true}},
                      description);
}

// Commands that convert maps, one by one.

/// The options of every command that converts maps.
struct MapFiles {
    FileWords words;
    ReportOptions report;
    GeneralOptions general;
};

/// The conversion of a single map.
struct MapWork {
    Json head;  ///< The first entries of the report: tool, version.
    /// Throws UsageError if the command line alone shows that the conversion is impossible.
    std::function<void(const Job& job)> check;
    std::function<FileOutcome(const Job& job, Stages& stages)> work;
};

/// Adds the file arguments.
/// \param input    what an input file is: "normal map"; its plural adds an s
/// \param output   what an output file is
/// \param details  more sentences for the help text
void add_map_files(CLI::App& app, MapFiles& files, const std::string& input,
                   const std::string& details, const std::string& output = "normal map");

/// Adds -o. A command calls this before it adds its other output options, so that --help lists it
/// first.
void add_map_folder(CLI::App& app, MapFiles& files);

/// \param kind  what the file is: "height map"
/// \throws UsageError if the output of the job would replace the file
void refuse_to_replace(const std::filesystem::path& file, const std::string& kind, const Job& job);

/// Converts one map and prints a summary, or many maps and prints a line for each.
/// \throws UsageError, FileError before any file is read, if the command line is wrong
ExitCode run_map_jobs(const CLI::App& app, const MapFiles& files, const MapWork& work);

// The storage of normal maps.

/// Options for how a normal map is stored. Absent: the default of the command.
struct MapOutputOptions {
    std::optional<Engine> engine;
    std::optional<int> bits;
    std::optional<Green> green;
    std::optional<FlatCode> flat;
    std::optional<Dither> dither;
    bool half = false;
    bool fast = false;
    bool small = false;
};

/// The defaults of a command.
struct MapOutputDefaults {
    /// Absent, or not supported by the file format: the largest integer depth of the format.
    std::optional<int> bits{};
    Green green = Green::up;
    FlatCode flat = FlatCode::half;
};

/// Adds --for, --bits, --green, --zero-code, --dither, --half, --fast and --small.
/// \param follows_input  whether --help names the input's format as the default
void add_map_output_options(CLI::App& app, MapOutputOptions& options, bool follows_input = false);

/// Sets the direction of green and the bits that the engine of --for needs, unless they are given.
/// \throws UsageError if another direction or zero code is given
void apply_engine(MapOutputOptions& options);

/// The bit depths in which a file format can store normals, the default first; empty if it cannot
/// store them.
std::vector<int> depths_of(const std::filesystem::path& output);

/// \param option  for the message: "--bits"
/// \throws UsageError if the depth is none of those of the file format
void check_depth(const char* option, int bits, const std::filesystem::path& output,
                 const std::vector<int>& depths, const std::string& remedy = "");

/// \throws UsageError if the file format cannot store normals, or not with this depth, or if an
///         option has no effect
NormalMapFormat format_of(const MapOutputOptions& options, const std::filesystem::path& output,
                          const MapOutputDefaults& defaults = {});

/// \throws UsageError if options contradict each other, or have no effect on this file
ImageWriteOptions write_options_of(const MapOutputOptions& options,
                                   const std::filesystem::path& output);

/// "8 bit, zero at 127.5 of 255 (the glTF decoding; ...), green up"
std::string to_string(const NormalMapFormat& format);

}  // namespace relief::tools
