// SPDX-License-Identifier: Apache-2.0
// Sections from the report's JSON; what it leaves out is left out here.
// Tests: tests/tools/accuracy_page/report_html_test.cpp.
#include "report/report_sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>
#include <vector>

#include "common/text.h"
#include "file_bytes.h"
#include "relief/mesh/error.h"
#include "report/html_text.h"
#include "report/report_tables.h"

namespace relief::tools {
namespace {

using nlohmann::ordered_json;

/// Of a subject at once; the others are shown when they are asked for.
constexpr std::size_t findings_shown = 4;

/// A text, escaped; empty where there is none.
std::string text_of(const ordered_json& json, const char* key) {
    const auto text = json.find(key);
    return text == json.end() || !text->is_string() ? "" : html_escaped(text->get<std::string>());
}

/// A number; 0 where there is none.
double number_of(const ordered_json& json, const char* key) {
    const auto number = json.find(key);
    return number == json.end() || !number->is_number() ? 0.0 : number->get<double>();
}

std::string capitalised(std::string word) {
    if (!word.empty())
        word[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(word[0])));
    return word;
}

/// A term with what it means; nothing where there is nothing to say.
std::string entry(const std::string& term, const std::string& html) {
    if (html.empty()) return "";
    return fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", term, html);
}

/// Whether a report may name this file as one of its own: below its folder.
bool is_within_folder(const std::filesystem::path& file) {
    return file.is_relative() &&
           std::none_of(file.begin(), file.end(), [](const auto& part) { return part == ".."; });
}

/// An <img> that holds its picture; words where the report was made without files.
std::string picture(const ordered_json& owner, const char* key, const std::string& alternative,
                    const std::filesystem::path& folder) {
    const auto name = owner.find(key);
    if (name == owner.end() || !name->is_string())
        return fmt::format("<p class=\"absent\">{}: no picture was written</p>",
                           html_escaped(alternative));
    const std::filesystem::path file = name->get<std::string>();
    if (!is_within_folder(file))
        throw InvalidInput(
            fmt::format("names the picture {}, which is outside its folder", file.string()));
    const std::string bytes = read_file(folder / file);
    return fmt::format(R"(<img src="{}" alt="{}">)", data_uri(bytes, "image/png"),
                       html_escaped(alternative));
}

/// The experiments by subject, in the order in which subjects come first.
struct SubjectPart {
    std::string name;
    std::vector<std::size_t> experiments;
};
std::vector<SubjectPart> subjects_of(const ordered_json& report) {
    std::vector<SubjectPart> subjects;
    const ordered_json& experiments = report.at("experiments");
    for (std::size_t i = 0; i < experiments.size(); ++i) {
        const std::string name = experiments[i].value("subject", "");
        std::size_t place = 0;
        while (place < subjects.size() && subjects[place].name != name)
            ++place;
        if (place == subjects.size()) subjects.push_back({name, {}});
        subjects[place].experiments.push_back(i);
    }
    return subjects;
}

/// Where the subject stands above, the title need not say it again: "Normals: torus" is "Torus".
std::string link_to(const ordered_json& experiment) {
    std::string title = experiment.value("title", "");
    const std::string subject = capitalised(experiment.value("subject", "")) + ": ";
    if (title.starts_with(subject)) title = capitalised(title.substr(subject.size()));
    return fmt::format(R"(<a href="#{}">{}</a>)", text_of(experiment, "id"), html_escaped(title));
}

/// A table that scrolls by itself where it is too wide, and can be reached by keyboard to do so.
std::string scrolled(const std::string& name, const std::string& table) {
    return fmt::format(
        "<div class=\"scrolled\" role=\"region\" aria-label=\"{}\" tabindex=\"0\">\n{}</div>\n",
        name, table);
}

std::string charts_html(const ordered_json& experiment) {
    std::string html;
    const ordered_json charts = experiment.value("charts", ordered_json::array());
    for (std::size_t i = 0; i < charts.size(); ++i) {
        const std::string title = text_of(charts[i], "title");
        html += fmt::format(
            "<figure class=\"chart\" data-chart=\"{}\">\n<figcaption><h4>{}</h4></figcaption>\n"
            "<details open><summary>The numbers of this chart</summary>\n{}</details></figure>\n",
            i, title, scrolled(title, chart_table(charts[i])));
    }
    return html;
}

std::string heat_maps_html(const ordered_json& experiment, const std::filesystem::path& folder) {
    std::string html;
    for (const ordered_json& map : experiment.value("heat_maps", ordered_json::array())) {
        const std::string words =
            fmt::format("{}, {}", map.value("title", ""), map.value("method", ""));
        html += fmt::format(
            "<figure class=\"heat\">{}\n<figcaption><strong>{}</strong> {}"
            "<span class=\"scale\"><span>0</span><i aria-hidden=\"true\"></i><span>{} {}</span>"
            "</span></figcaption></figure>\n",
            picture(map, "file", "Error map: " + words, folder), text_of(map, "title"),
            text_of(map, "method"), number_text(map.value("brightest", 1.0)), text_of(map, "unit"));
    }
    return html.empty() ? "" : "<div class=\"heat-maps\">\n" + html + "</div>\n";
}

std::string side(const ordered_json& pair, const char* key, const std::string& label,
                 const std::filesystem::path& folder) {
    return fmt::format("<div class=\"{}\">{}<span>{}</span></div>", key,
                       picture(pair, key, pair.value("title", "") + ": " + label, folder),
                       html_escaped(label));
}

std::string pairs_html(const ordered_json& experiment, const std::filesystem::path& folder) {
    std::string html;
    for (const ordered_json& pair : experiment.value("pictures", ordered_json::array())) {
        html += fmt::format(
            "<figure class=\"pair\">\n<div class=\"sides\">{}{}</div>\n"
            "<figcaption>{}</figcaption></figure>\n",
            side(pair, "before", pair.value("before_label", "before"), folder),
            side(pair, "after", pair.value("after_label", "after"), folder),
            text_of(pair, "title"));
    }
    return html.empty() ? "" : "<div class=\"pairs\">\n" + html + "</div>\n";
}

std::string command_html(const ordered_json& experiment) {
    const std::string command = text_of(experiment, "command");
    return command.empty() ? "" : fmt::format("<code class=\"command\">{}</code>", command);
}

/// Formats the findings on the input, one line each.
std::string findings_html(const ordered_json& experiment) {
    std::string html;
    for (const ordered_json& finding : experiment.value("input_findings", ordered_json::array()))
        html += (html.empty() ? "" : "<br>") + html_escaped(finding.get<std::string>());
    return html;
}

std::string experiment_html(const ordered_json& experiment, std::size_t index,
                            const std::filesystem::path& folder) {
    const std::string finding = text_of(experiment, "finding");
    std::string html = fmt::format(
        "<article class=\"experiment\" id=\"{}\" data-experiment=\"{}\">\n<h3>{}</h3>\n"
        "<p class=\"question\">{}</p>\n",
        text_of(experiment, "id"), index, text_of(experiment, "title"),
        text_of(experiment, "question"));
    if (!finding.empty()) html += fmt::format("<p class=\"finding\">{}</p>\n", finding);
    html += fmt::format(
                "<details class=\"body\" open><summary>Plots and numbers <small>{}</small>"
                "</summary>\n<dl class=\"facts\">\n",
                counted(experiment.at("measurements").size(), "method")) +
            entry("Ground truth", text_of(experiment, "truth")) +
            entry("Input", text_of(experiment, "input")) +
            entry("Findings", findings_html(experiment)) +
            entry("To repeat", command_html(experiment)) + "</dl>\n";
    if (!experiment.at("measurements").empty())
        html +=
            scrolled("Methods of " + text_of(experiment, "title"), measurements_table(experiment));
    return html + charts_html(experiment) + heat_maps_html(experiment, folder) +
           pairs_html(experiment, folder) + "</details></article>\n";
}

}  // namespace

std::string machine_html(const ordered_json& report) {
    const ordered_json machine = report.value("machine", ordered_json::object());
    const ordered_json settings = report.value("settings", ordered_json::object());
    const double memory = number_of(machine, "memory_bytes");
    std::string repeats;
    if (!settings.value("timed", true)) {
        repeats = "errors alone: nothing was timed";
    } else if (number_of(settings, "repeats") > 0.0) {
        repeats = fmt::format("medians of {} interleaved rounds", number_of(settings, "repeats"));
        const double passes = number_of(settings, "passes");
        if (passes > 1.0)
            repeats += fmt::format(", taken in {} passes over all experiments", passes);
    }
    return entry("Processor", text_of(machine, "processor")) +
           entry("Cores", number_text(number_of(machine, "cores"))) +
           entry("Memory", memory > 0.0 ? bytes_text(memory) : "") +
           entry("System", text_of(machine, "system")) +
           entry("Compiler", text_of(machine, "compiler")) +
           entry("Build", text_of(machine, "build")) + entry("OpenGL", text_of(machine, "opengl")) +
           entry("relief", text_of(report, "relief")) + entry("Times", repeats) +
           entry("Inputs", settings.value("quick", false) ? "small (--quick)" : "");
}

std::string contents_html(const ordered_json& report) {
    std::string html = "<ul>\n";
    for (const SubjectPart& subject : subjects_of(report)) {
        html += fmt::format(
            "<li><details open><summary><a href=\"#subject-{}\">{}</a></summary>\n<ul>\n",
            html_escaped(subject.name), html_escaped(capitalised(subject.name)));
        for (const std::size_t i : subject.experiments)
            html += "<li>" + link_to(report.at("experiments")[i]) + "</li>\n";
        html += "</ul></details></li>\n";
    }
    return html + "</ul>\n";
}

std::string summary_html(const ordered_json& report) {
    std::string html;
    for (const SubjectPart& subject : subjects_of(report)) {
        html += fmt::format("<section class=\"card\"><h3>{}</h3>\n<ul>\n",
                            html_escaped(capitalised(subject.name)));
        for (std::size_t place = 0; place < subject.experiments.size(); ++place) {
            const std::size_t left = subject.experiments.size() - place;
            if (place == findings_shown && left > 1)
                html += fmt::format("</ul>\n<details><summary>{} more</summary>\n<ul>\n", left);
            const ordered_json& experiment = report.at("experiments")[subject.experiments[place]];
            const std::string findings = findings_html(experiment);
            html += fmt::format("<li>{} <span>{}</span>{}</li>\n", link_to(experiment),
                                text_of(experiment, "finding"),
                                findings.empty() ? "" : "<br><strong>" + findings + "</strong>");
        }
        html += subject.experiments.size() > findings_shown + 1 ? "</ul></details></section>\n"
                                                                : "</ul></section>\n";
    }
    return html;
}

std::string experiments_html(const ordered_json& report, const std::filesystem::path& folder) {
    std::string html;
    for (const SubjectPart& subject : subjects_of(report)) {
        html += fmt::format(
            "<section id=\"subject-{0}\" aria-labelledby=\"heading-{0}\">\n"
            "<h2 id=\"heading-{0}\">{1}</h2>\n",
            html_escaped(subject.name), html_escaped(capitalised(subject.name)));
        for (const std::size_t i : subject.experiments)
            html += experiment_html(report.at("experiments")[i], i, folder);
        html += "</section>\n";
    }
    return html;
}

}  // namespace relief::tools
