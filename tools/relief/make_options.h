// SPDX-License-Identifier: Apache-2.0
/// \file
/// The options of an asset, one row each. The options of the command, the keys of job files, the
/// options in reports and in the records of unchanged assets, the line that repeats a job, and the
/// checks of the files of --keep-stages derive from these rows.
/// Tests: tests/make/make_options_test.cpp.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/options.h"
#include "common/text.h"
#include "make_job.h"

namespace relief::tools {

/// The values that an option may have in a job file besides text and numbers.
enum class OptionValues {
    one,    ///< A single value.
    many,   ///< Also a list: the option may be repeated.
    files,  ///< The same with names of files, which are relative to the job file.
};

struct MakeOption {
    std::string_view name;  ///< Without dashes, "keep-uvs"; also the key in job files.
    std::string_view key;   ///< In the "options" of reports: "keep_uvs".
    /// The first stage (make::stages_of()) whose result depends on the option; empty: only files
    /// and measurements depend on it, or the files of the model, which have hashes of their own.
    std::string_view stage;
    std::string_view heading;  ///< In the help page.
    OptionValues values = OptionValues::one;
    /// Adds the option. Null: a row before adds it.
    std::optional<AddedOption> (*add)(CLI::App& app, const std::string& option,
                                      MakeRequest& request) = nullptr;
    /// Returns the value for reports. Equal values make equal assets.
    Json (*value)(const MakeRequest& request) = nullptr;
    /// Returns the words after the option, once for each time that it occurs on the command line.
    /// Null: the value of reports, where null and false mean that it does not occur.
    std::vector<std::string> (*words)(const MakeRequest& request) = nullptr;
    /// Returns why the option has no effect: "nothing is remeshed"; empty: it has one.
    std::string (*useless)(const MakeRequest& request) = nullptr;
};

/// All options, in the order of the help page.
const std::vector<MakeOption>& make_options();

/// Adds all options to a command line.
void add_asset_options(CLI::App& app, MakeRequest& request);

/// \throws UsageError if options of an asset have no effect or contradict others
void check_asset_options(const CLI::App& app, const MakeRequest& request);

/// The options of an asset in reports, by MakeOption::key.
Json options_json(const MakeRequest& request);

/// All options with an effect, as on a command line: " --triangles 500 --shell".
std::string options_line(const MakeRequest& request);

/// The value of an option in messages and records: "500", "on", "off", "height,curvature".
std::string option_text(const MakeOption& option, const MakeRequest& request);

}  // namespace relief::tools
