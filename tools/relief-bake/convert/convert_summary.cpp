// SPDX-License-Identifier: Apache-2.0
// Words and JSON of a conversion of a normal map. Tests: tests/tools/convert_test.cpp.
#include "convert/convert_summary.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "common/choices.h"
#include "common/text.h"

namespace relief::tools {
namespace {

std::string coded_words(const Converted& converted) {
    NormalMapFormat format = converted.format;
    format.green = converted.green.value_or(Green::up);
    const std::string words = format_words(format);
    if (converted.green) return words;
    const std::size_t place = words.find("green up");
    const bool is_object_space = converted.content == "normal map, object space";
    return words.substr(0, place) + (is_object_space ? "object space" : "green unknown") +
           words.substr(place + 8);
}

std::vector<std::string> level_lines(const Converted& converted) {
    std::vector<std::string> lines;
    for (const WrittenLevel& level : converted.levels) {
        std::string line = file_and_size(level.file);
        if (converted.levels.size() > 1) {
            line += fmt::format(", {} x {}, mean length {:.4f}", level.width, level.height,
                                level.mean_length);
        }
        if (level.mean_roughness) line += fmt::format(", roughness {:.4f}", *level.mean_roughness);
        lines.push_back(line);
    }
    return lines;
}

nlohmann::ordered_json lengths_json(const std::optional<LengthSpread>& lengths) {
    if (!lengths) return nullptr;
    return {{"least", lengths->least}, {"mean", lengths->mean}, {"greatest", lengths->greatest}};
}

nlohmann::ordered_json levels_json(const Converted& converted) {
    nlohmann::ordered_json levels = nlohmann::ordered_json::array();
    for (const WrittenLevel& level : converted.levels) {
        nlohmann::ordered_json entry = {{"file", level.file.string()},
                                        {"width", level.width},
                                        {"height", level.height},
                                        {"mean_length", level.mean_length},
                                        {"least_length", level.least_length}};
        if (level.roughness_file) {
            entry["roughness_file"] = level.roughness_file->string();
            entry["mean_roughness"] = *level.mean_roughness;
        }
        levels.push_back(std::move(entry));
    }
    return levels;
}

}  // namespace

void print_summary(const Job& job, const Converted& converted, const Stages& stages) {
    print_entry("read",
                fmt::format("{}: {} x {}, {}, {} bit, {}", job.input.string(), converted.width,
                            converted.height,
                            counted(static_cast<std::size_t>(converted.channels), "channel"),
                            converted.bits_read, converted.input_words));
    print_entry("done", converted.steps);
    print_entry("coded", coded_words(converted));
    print_entry("findings", converted.findings.empty() ? std::vector<std::string>{"none"}
                                                       : converted.findings.lines());
    print_entry("time", durations(stages.finished()));
    print_entry("wrote", level_lines(converted));
}

std::string line_of(const Job& job, const Converted& converted, const Stages& stages) {
    double sum = 0;
    for (const Stage& stage : stages.finished())
        sum += stage.milliseconds;
    return fmt::format("{}: {} x {}, {}, {}", job.output.string(), converted.levels.front().width,
                       converted.levels.front().height,
                       converted.findings.empty()
                           ? "no findings"
                           : counted(converted.findings.all().size(), "finding"),
                       duration(sum));
}

nlohmann::ordered_json results_json(const Converted& converted, const Stages& stages) {
    const auto green = [](const std::optional<Green>& known) {
        return known ? nlohmann::ordered_json(name_of(*known, green_choices())) : nullptr;
    };
    return {{"width", converted.levels.front().width},
            {"height", converted.levels.front().height},
            {"input_size", {converted.width, converted.height}},
            {"done", converted.steps},
            {"input_lengths", lengths_json(converted.lengths)},
            {"bits", converted.format.bits},
            {"green", green(converted.green)},
            {"zero_code", name_of(converted.format.flat, zero_code_choices())},
            {"dither", name_of(converted.format.dither, dither_choices())},
            {"levels", levels_json(converted)},
            {"findings", converted.findings.json()},
            {"milliseconds", durations_json(stages.finished())}};
}

}  // namespace relief::tools
