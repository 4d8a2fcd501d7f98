// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/text_test.cpp.
#include "common/summary.h"

#include <fmt/format.h>

#include <utility>

namespace relief::tools {

Json histogram_json(const ErrorStats& angles) {
    Json bins = Json::array();
    for (std::size_t i = 0; i < angles.histogram.size(); ++i)
        bins.push_back({{"up_to", ErrorStats::bounds[i]}, {"corners", angles.histogram[i]}});
    return bins;
}

void Summary::add(const std::string& label, const Lines& lines, Json members) {
    entries_.push_back({label, lines, std::move(members)});
}

void Summary::add(const std::string& label, const std::string& text, Json members) {
    add(label, text.empty() ? Lines{} : Lines{text}, std::move(members));
}

void Summary::add_part(const std::string& key, const Summary& part) {
    Json members = part.json();
    if (!key.empty()) members = Json::object({{key, std::move(members)}});
    add_json(std::move(members));
    add_lines(part);
}

void Summary::add_lines(const Summary& part) {
    for (const Entry& entry : part.entries_)
        add(entry.label, entry.lines);
}

void Summary::add_tool(const std::string& tool) {
    add_json({{"tool", tool}, {"version", version()}});
}

void Summary::add_findings(const Findings& findings, const std::string& none) {
    const Json members = {{"findings", findings.json()}};
    if (findings.empty())
        add("findings", none, members);
    else
        add("findings", findings.lines(), members);
}

void Summary::add_times(const Stages& stages, const std::string& note) {
    Json milliseconds = Json::object();
    for (const Stage& stage : stages.finished())
        milliseconds[stage.name] = stage.milliseconds;
    add("time", durations(stages.finished()) + note, {{"milliseconds", std::move(milliseconds)}});
}

void Summary::print() const {
    for (const Entry& entry : entries_)
        print_entry(entry.label, entry.lines);
}

Json Summary::json() const {
    Json json = Json::object();
    for (const Entry& entry : entries_)
        json.update(entry.members);
    return json;
}

Summary summary_of(const std::string& tool, const Verdicts& verdicts, const std::string& document,
                   Json files) {
    Summary summary;
    summary.add_tool(tool);
    const std::string numbers = fmt::format("{}: {} sound, {} with problems, {} unreadable",
                                            counted(verdicts.all(), "file"), verdicts.sound,
                                            verdicts.with_problems, verdicts.unreadable);
    summary.add("verdict", verdicts.all() < 2 ? "" : numbers,
                {{"sound", verdicts.sound},
                 {"with_problems", verdicts.with_problems},
                 {"unreadable", verdicts.unreadable}});
    const bool has_findings = verdicts.all() > verdicts.unreadable;
    summary.add("details", has_findings ? document + " describes each condition" : "",
                {{"documentation", document}});
    summary.add_json({{"files", std::move(files)}});
    return summary;
}

ExitCode exit_code_for(const CLI::App& app, const Verdicts& verdicts, bool strict) {
    const bool has_problems = strict && verdicts.with_problems > 0;
    if (has_problems) {
        warn(app, fmt::format("{} with problems (exit code 3, because of --strict)",
                              counted(verdicts.with_problems, "file")));
    }
    if (verdicts.unreadable > 0) return ExitCode::failed;
    return has_problems ? ExitCode::fell_back : ExitCode::done;
}

}  // namespace relief::tools
