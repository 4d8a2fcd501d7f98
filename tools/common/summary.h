// SPDX-License-Identifier: Apache-2.0
/// \file
/// The summary of a command: one structure, which is rendered as text or as JSON.
/// Tests: tests/tools/text_test.cpp.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/command.h"
#include "common/text.h"
#include "relief/mesh/statistics.h"

namespace relief::tools {

/// Returns an array with the value of `json_of` for each thing.
template <typename Things, typename Function>
Json json_list(const Things& things, const Function& json_of) {
    Json list = Json::array();
    for (const auto& thing : things)
        list.push_back(json_of(thing));
    return list;
}

template <typename T>
Json or_null(const std::optional<T>& value) {
    return value ? Json(*value) : Json(nullptr);
}

/// [{"up_to", "corners"}]
Json histogram_json(const ErrorStats& angles);

/// A list of entries. An entry has lines of text, the members of a JSON object that hold the values
/// of these lines, or both.
class Summary {
  public:
    using Lines = std::vector<std::string>;

    /// \param label    stands before the first line
    /// \param members  a JSON object
    void add(const std::string& label, const Lines& lines, Json members = Json::object());
    /// An empty text is no line.
    void add(const std::string& label, const std::string& text, Json members = Json::object());
    /// Adds values that only the JSON has.
    void add_json(Json members) { add("", Lines{}, std::move(members)); }
    /// Appends a part. Its JSON object becomes the member `key`; if `key` is empty, its members are
    /// appended.
    void add_part(const std::string& key, const Summary& part);
    /// Appends the lines of a part, whose JSON is elsewhere.
    void add_lines(const Summary& part);

    /// "tool" and "version", which only the JSON has.
    void add_tool(const std::string& tool);
    /// Adds the findings as text and JSON. \param none  the text if there are none
    void add_findings(const Findings& findings, const std::string& none = "none");
    /// \param note  follows the times in the text
    void add_times(const Stages& stages, const std::string& note = "");

    void print() const;
    [[nodiscard]] Json json() const;

  private:
    struct Entry {
        std::string label;
        Lines lines;
        Json members;
    };
    std::vector<Entry> entries_;
};

/// The number of checked files by verdict.
struct Verdicts {
    std::size_t sound = 0;
    std::size_t with_problems = 0;
    std::size_t unreadable = 0;

    [[nodiscard]] std::size_t all() const { return sound + with_problems + unreadable; }
};

/// Returns the numbers, and the document that describes the findings.
/// \param files  the JSON of each file
Summary summary_of(const std::string& tool, const Verdicts& verdicts, const std::string& document,
                   Json files);

/// Prints a warning if --strict was given and files have problems.
/// \return failed if a file is unreadable; else fell_back after the warning; else done
ExitCode exit_code_for(const CLI::App& app, const Verdicts& verdicts, bool strict);

}  // namespace relief::tools
