// SPDX-License-Identifier: Apache-2.0
// The summary of `relief-bake convert` as text, as a line and as JSON.
// Tests: tests/tools/relief_bake_convert_test.cpp.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "common/choices.h"
#include "common/text.h"
#include "convert.h"

namespace relief::tools {
namespace {

std::string format_text(const MapConversion& conversion) {
    NormalMapFormat format = conversion.format;
    format.green = conversion.green.value_or(Green::up);
    const std::string text = to_string(format);
    if (conversion.green) return text;
    const std::string known = "green up";
    const std::size_t place = text.find(known);
    const bool is_object_space = conversion.content == "normal map, object space";
    return text.substr(0, place) + (is_object_space ? "object space" : "green unknown") +
           text.substr(place + known.size());
}

std::vector<std::string> level_lines(const MapConversion& conversion) {
    std::vector<std::string> lines;
    for (const WrittenLevel& level : conversion.levels) {
        std::string line = file_and_size(level.file);
        if (conversion.levels.size() > 1) {
            line += fmt::format(", {} x {}, mean length {:.4f}", level.width, level.height,
                                level.mean_length);
        }
        if (level.mean_roughness) line += fmt::format(", roughness {:.4f}", *level.mean_roughness);
        lines.push_back(line);
    }
    return lines;
}

nlohmann::ordered_json lengths_json(const std::optional<LengthRange>& lengths) {
    if (!lengths) return nullptr;
    return {{"least", lengths->least}, {"mean", lengths->mean}, {"greatest", lengths->greatest}};
}

nlohmann::ordered_json levels_json(const MapConversion& conversion) {
    nlohmann::ordered_json levels = nlohmann::ordered_json::array();
    for (const WrittenLevel& level : conversion.levels) {
        nlohmann::ordered_json entry = {{"file", level.file.string()},
                                        {"width", level.width},
                                        {"height", level.height},
                                        {"mean_length", level.mean_length},
                                        {"least_length", level.min_length}};
        if (level.roughness_file) {
            entry["roughness_file"] = level.roughness_file->string();
            entry["mean_roughness"] = *level.mean_roughness;
        }
        levels.push_back(std::move(entry));
    }
    return levels;
}

}  // namespace

void print_summary(const Job& job, const MapConversion& conversion, const Stages& stages) {
    print_entry("read",
                fmt::format("{}: {} x {}, {}, {} bit, {}", job.input.string(), conversion.width,
                            conversion.height,
                            counted(static_cast<std::size_t>(conversion.channels), "channel"),
                            conversion.bits_read, conversion.input_text));
    print_entry("steps", conversion.steps);
    print_entry("format", format_text(conversion));
    print_entry("findings", conversion.findings.empty() ? std::vector<std::string>{"none"}
                                                        : conversion.findings.lines());
    print_entry("time", durations(stages.finished()));
    print_entry("wrote", level_lines(conversion));
}

std::string line_of(const Job& job, const MapConversion& conversion, const Stages& stages) {
    double sum = 0;
    for (const Stage& stage : stages.finished())
        sum += stage.milliseconds;
    return fmt::format("{}: {} x {}, {}, {}", job.output.string(), conversion.levels.front().width,
                       conversion.levels.front().height,
                       conversion.findings.empty()
                           ? "no findings"
                           : counted(conversion.findings.all().size(), "finding"),
                       duration(sum));
}

nlohmann::ordered_json results_json(const MapConversion& conversion, const Stages& stages) {
    nlohmann::ordered_json green = nullptr;
    if (conversion.green) green = name_of(*conversion.green, green_choices());
    return {{"width", conversion.levels.front().width},
            {"height", conversion.levels.front().height},
            {"input_size", {conversion.width, conversion.height}},
            {"done", conversion.steps},
            {"input_lengths", lengths_json(conversion.lengths)},
            {"bits", conversion.format.bits},
            {"green", green},
            {"zero_code", name_of(conversion.format.flat, zero_code_choices())},
            {"dither", name_of(conversion.format.dither, dither_choices())},
            {"levels", levels_json(conversion)},
            {"findings", conversion.findings.json()},
            {"milliseconds", durations_json(stages.finished())}};
}

}  // namespace relief::tools
