// SPDX-License-Identifier: Apache-2.0
// Writes the sections of docs/accuracy.md from reports of relief-accuracy:
//
//     relief-accuracy run all --quick --output out/accuracy
//     relief-accuracy own data/bricks-height.png --output out/bricks
//     relief-accuracy own --high data/urn-high.ply --low data/urn-low.obj --size 128
//         --output out/urn
//     relief-documents --accuracy out/accuracy out/bricks out/urn
//
// tests/tools/accuracy_page/accuracy_document_test.cpp compares the errors of the page with
// measurements.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "docs/generated_documents.h"
#include "plots.h"
#include "report_page.h"

namespace relief::test {
namespace {

using nlohmann::ordered_json;

/// The experiment of a subject that the page shows.
struct ShownExperiment {
    const char* id;
    bool is_chart = false;  ///< The page shows the first chart instead of the costs.
};
constexpr std::array<ShownExperiment, 11> shown_experiments = {
    {{"normals/torus-jittered"},
     {"tangents/torus-jittered"},
     {"bump/mixed-8"},
     {"storage/frames"},
     {"compression/waves"},
     {"bake/samples"},
     {"decimation/torus-distance"},
     {"unwrapping/noisy-stretch"},
     {"relief/bricks-45-70"},
     {"shading/interpolation"},
     {"stability/tangents-scale", true}}};

ordered_json report_in(const std::filesystem::path& folder) {
    return ordered_json::parse(contents_of_page((folder / "accuracy.json").string()));
}

std::string text_of(const ordered_json& json, const char* key) {
    return json.at(key).get<std::string>();
}

/// Returns the part of a text before a separator, and the part after it.
std::pair<std::string, std::string> split_at(const std::string& text,
                                             const std::string& separator) {
    const std::size_t at = text.find(separator);
    if (at == std::string::npos) return {text, ""};
    return {text.substr(0, at), text.substr(at + separator.size())};
}

/// Returns a Markdown table of errors and times. Efficient methods are bold. A long table has only
/// these and the recommended method.
std::string method_rows(const ordered_json& experiment) {
    constexpr std::size_t max_rows = 16;
    const tools::MethodTable table = tools::method_table(experiment);
    std::vector<std::size_t> columns;
    for (const char* name :
         {"RMS", "99 %", "max", "undefined", "expected", "one thread", "all threads", "stored"}) {
        const auto column = std::find(table.columns.begin(), table.columns.end(), name);
        if (column != table.columns.end())
            columns.push_back(static_cast<std::size_t>(column - table.columns.begin()));
    }
    std::vector<std::string> heads;
    for (const std::size_t column : columns)
        heads.push_back(table.columns[column]);
    std::string text = table_header(heads);
    const ordered_json& measurements = experiment.at("measurements");
    for (std::size_t i = 0; i < measurements.size(); ++i) {
        const std::string method = text_of(measurements[i], "method");
        const bool is_efficient = measurements[i].value("efficient", false);
        const bool is_recommended = text_of(experiment, "finding").starts_with(method + ": ");
        if (measurements.size() > max_rows && !is_efficient && !is_recommended) continue;
        text += is_efficient ? "| **" + method + "** |" : "| " + method + " |";
        for (const std::size_t column : columns)
            text += " " + table.rows[i][column].text + " |";
        text += "\n";
    }
    return text;
}

/// Breaks a paragraph into lines of at most 120 characters, at spaces outside of code spans.
std::string wrapped(const std::string& paragraph) {
    constexpr std::size_t max_length = 120;
    std::string result;
    std::string line;
    const auto add_word = [&](const std::string& word) {
        if (!line.empty() &&
            tools::code_points_in(line) + 1 + tools::code_points_in(word) > max_length) {
            result += line + "\n";
            line.clear();
        }
        if (!line.empty()) line += " ";
        line += word;
    };
    std::string word;
    bool is_code = false;
    for (const char c : paragraph) {
        if (c == '`') is_code = !is_code;
        if (c == ' ' && !is_code) {
            add_word(word);
            word.clear();
        } else {
            word += c;
        }
    }
    add_word(word);
    return result + line + "\n";
}

std::string input_paragraph(const ordered_json& experiment) {
    return wrapped(fmt::format("`{}`, {}; errors in {}:", text_of(experiment, "id"),
                               text_of(experiment, "input"), text_of(experiment, "error_unit"))) +
           "\n";
}

std::string machine_paragraph(const ordered_json& report) {
    const ordered_json& machine = report.at("machine");
    return wrapped(fmt::format(
        "Measured by `{}` on {}, {} cores, {}, {}; times are medians of {} interleaved rounds.",
        text_of(report, "command"), text_of(machine, "processor"), machine.at("cores").get<int>(),
        split_at(text_of(machine, "system"), ",").first, text_of(machine, "compiler"),
        report.at("settings").at("repeats").get<int>()));
}

}  // namespace

AccuracySection accuracy_results(const std::filesystem::path& folder) {
    const ordered_json report = report_in(folder);
    AccuracySection result;
    std::string text = "\n" + machine_paragraph(report);
    for (const ShownExperiment& shown : shown_experiments) {
        const ordered_json& all = report.at("experiments");
        const auto found = std::find_if(all.begin(), all.end(), [&](const ordered_json& one) {
            return text_of(one, "id") == shown.id;
        });
        if (found == all.end()) throw std::runtime_error(fmt::format("no {}", shown.id));
        std::string subject = text_of(*found, "subject");
        const std::string picture = fmt::format("images/accuracy-{}.svg", subject);
        result.pictures.push_back(
            {picture,
             tools::svg_file(shown.is_chart ? tools::curves_plot(found->at("charts").at(0), {})
                                            : tools::scatter_plot(*found, {}))});
        subject[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(subject[0])));
        const std::string title = text_of(*found, "title");
        const std::size_t colon = title.rfind(": ");
        const std::string heading = fmt::format(
            "{}: {}", subject, colon == std::string::npos ? title : title.substr(colon + 2));
        text += fmt::format("\n### {}\n{}\n![{}]({})\n\n{}{}", heading,
                            wrapped(text_of(*found, "question") + " " + text_of(*found, "finding")),
                            heading, picture, input_paragraph(*found), method_rows(*found));
    }
    result.section = {"<!-- tables: written by relief-documents -->\n", text};
    return result;
}

AccuracySection accuracy_of_assets(const std::vector<std::filesystem::path>& folders) {
    std::string text;
    for (const std::filesystem::path& folder : folders) {
        const ordered_json report = report_in(folder);
        for (const ordered_json& one : report.at("experiments")) {
            const auto [finding, command] = split_at(text_of(one, "finding"), " To do it: ");
            text += fmt::format("\n### {}\n{}\n{}\n{}{}", text_of(one, "title"),
                                wrapped(fmt::format("`{}` recommends {} To do it: `{}`",
                                                    text_of(one, "command"), finding, command)),
                                wrapped("Reference: " + text_of(one, "truth")),
                                input_paragraph(one), method_rows(one));
        }
    }
    return {{"<!-- own data: written by relief-documents -->\n", text}, {}};
}

}  // namespace relief::test
