// SPDX-License-Identifier: Apache-2.0
// `relief-accuracy report REPORT` writes the HTML page of an existing report from its JSON. The
// page is built from page/page.html: tables, then the sections of subjects and experiments. plots.h
// draws the plots. The base64 encoding is that of [RFC 4648].
// Tests: tests/tools/accuracy_page/report_html_test.cpp, tests/tools/accuracy_report_test.cpp.
#include "report_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <vector>

#include "accuracy_report.h"
#include "commands.h"
#include "common/file_jobs.h"
#include "common/options.h"
#include "common/text.h"
#include "files.h"
#include "plots.h"
#include "relief/accuracy/experiment.h"
#include "relief/mesh/report.h"

namespace relief::tools {
using namespace relief::accuracy;
using namespace relief::detail;

// Texts of the page.

namespace {

constexpr std::string_view none = "–";

std::string base64(std::string_view bytes) {
    constexpr std::string_view letters =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t given = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8 | (k < given ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k)
            text += k <= given ? letters[group >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

/// Returns three digits without exponent, for values from 0.001 to a million.
std::string plain(double value) {
    const int before_point = static_cast<int>(std::floor(std::log10(std::abs(value)))) + 1;
    if (before_point < 3) return fmt::format("{:.{}f}", value, 3 - before_point);
    const double unit = std::pow(10.0, before_point - 3);
    return fmt::format("{:.0f}", std::round(value / unit) * unit);
}

}  // namespace

std::string html_escaped(std::string_view text) {
    std::string escaped;
    escaped.reserve(text.size());
    for (const char letter : text) {
        switch (letter) {
            case '&':
                escaped += "&amp;";
                break;
            case '<':
                escaped += "&lt;";
                break;
            case '>':
                escaped += "&gt;";
                break;
            case '"':
                escaped += "&quot;";
                break;
            case '\'':
                escaped += "&#39;";
                break;
            default:
                escaped += letter;
        }
    }
    return escaped;
}

std::string data_uri(std::string_view bytes, std::string_view type) {
    return fmt::format("data:{};base64,{}", type, base64(bytes));
}

std::string number_text(std::optional<double> value) {
    if (!value || !std::isfinite(*value)) return std::string(none);
    const double size = std::abs(*value);
    if (size == 0.0) return "0";
    if (size < 0.9995e-3 || size >= 0.9995e6) return fmt::format("{:.2e}", *value);
    if (*value == std::round(*value)) return fmt::format("{:.0f}", *value);
    // Rounding first: 9.996 becomes 10.0.
    return plain(std::stod(fmt::format("{:.2e}", *value)));
}

std::string seconds_text(std::optional<double> seconds) {
    return seconds && std::isfinite(*seconds) ? format_seconds(*seconds) : std::string(none);
}

std::string range_text(double from, double to) {
    std::string begin = format_seconds(from);
    const std::string end = format_seconds(to);
    const std::string unit = end.substr(end.rfind(' '));
    if (begin.ends_with(unit)) begin.resize(begin.size() - unit.size());
    return begin + "–" + end;
}

std::string bytes_text(std::optional<double> bytes) {
    if (!bytes || !std::isfinite(*bytes)) return std::string(none);
    if (*bytes < 1000.0) return number_text(bytes) + " B";
    return byte_size(static_cast<std::uintmax_t>(std::llround(*bytes)));
}

std::string_view report_part(std::string_view name) {
    const std::vector<ReportPart>& parts = report_parts();
    const auto part = std::find_if(parts.begin(), parts.end(),
                                   [&](const ReportPart& one) { return one.name == name; });
    assert(part != parts.end());
    return part->text;
}

// The page.

namespace {

using nlohmann::ordered_json;
using plots::number_at;

/// Returns a median time with the 10th and the 90th percentile.
std::string timing_cell(const ordered_json& measurement, const std::string& path) {
    const std::optional<double> median = number_at(measurement, path + "/median");
    if (!median) return html_escaped(seconds_text(median));
    const std::optional<double> p10 = number_at(measurement, path + "/p10");
    const std::optional<double> p90 = number_at(measurement, path + "/p90");
    if (!p10 || !p90) return seconds_text(median);
    return fmt::format("{} <small>{}</small>", seconds_text(median), range_text(*p10, *p90));
}

struct HtmlColumn {
    std::string head;
    std::string path;  ///< The path of the sorted number in a measurement.
    std::function<std::string(const ordered_json& measurement)> cell;
};

/// Returns a column of numbers.
HtmlColumn column(const std::string& head, const std::string& path,
                  std::string (*text)(std::optional<double>)) {
    return {head, path, [path, text](const ordered_json& measurement) {
                return text(number_at(measurement, path));
            }};
}

HtmlColumn time_column(const std::string& head, const std::string& path) {
    return {head, path + "/median",
            [path](const ordered_json& measurement) { return timing_cell(measurement, path); }};
}

/// Returns the column of results without error: "128826 (35 %)".
HtmlColumn undefined_column() {
    const std::string path = "/error/undefined";
    return {"undefined", path, [path](const ordered_json& measurement) {
                const double undefined = number_at(measurement, path).value_or(0.0);
                const double all = undefined + number_at(measurement, "/error/count").value_or(0.0);
                if (undefined == 0.0) return std::string("0");
                const double percent = 100.0 * undefined / all;
                return percent < 9.95 ? fmt::format("{:.0f} ({:.2g} %)", undefined, percent)
                                      : fmt::format("{:.0f} ({:.0f} %)", undefined, percent);
            }};
}

/// Returns the column of expected errors: "1.35", or a range, "1.35–8.50".
HtmlColumn expected_column() {
    return {"expected", "/expected_error/total", [](const ordered_json& measurement) {
                const auto upper = number_at(measurement, "/expected_error/total_upper");
                return number_text(number_at(measurement, "/expected_error/total")) +
                       (upper ? "–" + number_text(upper) : "");
            }};
}

/// Returns whether a measurement has a number other than 0 at a path.
bool has_values(const ordered_json& measurements, const std::string& path) {
    return std::any_of(measurements.begin(), measurements.end(), [&](const ordered_json& one) {
        return number_at(one, path).value_or(0.0) != 0.0;
    });
}

std::vector<HtmlColumn> columns_of(const ordered_json& measurements) {
    std::vector<HtmlColumn> columns = {
        column("RMS", "/error/rms", number_text), column("mean", "/error/mean", number_text),
        column("99 %", "/error/p99", number_text), column("max", "/error/max", number_text)};
    for (const HtmlColumn& optional :
         {column("PSNR, dB", "/error/psnr", number_text), undefined_column(), expected_column(),
          time_column("one thread", "/cost/one_thread"),
          time_column("all threads", "/cost/all_threads"),
          column("memory", "/cost/peak_bytes", bytes_text),
          column("stored", "/cost/stored_bytes", bytes_text)}) {
        if (has_values(measurements, optional.path)) columns.push_back(optional);
    }
    return columns;
}

/// Returns the note that all of several measurements have, or an empty text.
std::string common_note(const ordered_json& measurements) {
    if (measurements.size() < 2) return "";
    std::string note = measurements[0].value("note", "");
    const bool is_common =
        std::all_of(measurements.begin(), measurements.end(),
                    [&](const ordered_json& one) { return one.value("note", "") == note; });
    return is_common ? note : "";
}

/// Returns the explanation of the columns and marks of a table.
std::string caption_text(const ordered_json& measurements, const std::string& common_note) {
    std::string words;
    if (has_values(measurements, "/error/undefined"))
        words += "Undefined results are counted, and excluded from the other figures. ";
    if (has_values(measurements, "/expected_error/total"))
        words +=
            "Expected is the root of the sum of squares of the reference error and the error of "
            "the method. ";
    if (has_values(measurements, "/cost/one_thread/median") ||
        has_values(measurements, "/cost/all_threads/median"))
        words +=
            "Times are medians, with the range from the 10th to the 90th percentile; ◆ marks "
            "efficient methods: faster than all efficient ones that are more accurate. ";
    if (has_values(measurements, "/cost/stored_bytes"))
        words += "Stored is the size of one result (a vertex's frame, a texel). ";
    return words + html_escaped(common_note);
}

/// Returns the text of HTML without tags.
std::string without_tags(const std::string& html) {
    std::string text;
    bool is_tag = false;
    for (const char letter : html) {
        is_tag = is_tag || letter == '<';
        if (!is_tag) text += letter;
        is_tag = is_tag && letter != '>';
    }
    return text;
}

/// Returns the tooltips of methods: the name, and a line for each value of the table.
std::vector<std::string> method_tips(const ordered_json& experiment) {
    const ordered_json& measurements = experiment.at("measurements");
    const std::string unit = experiment.value("error_unit", "");
    const std::string common = common_note(measurements);
    const double items = number_at(experiment, "/items").value_or(0.0);
    std::vector<std::string> tips;
    for (const ordered_json& one : measurements) {
        std::string tip = one.value("method", "");
        for (const HtmlColumn& column : columns_of(measurements)) {
            const std::string text = without_tags(column.cell(one));
            const bool is_error = column.path.starts_with("/error/") &&
                                  column.path != "/error/psnr" && column.path != "/error/undefined";
            if (text != none)
                tip += fmt::format("\n{}: {}{}", column.head, text, is_error ? " " + unit : "");
        }
        const std::optional<double> seconds = number_at(one, "/cost/one_thread/median");
        if (items > 0.0 && seconds)
            tip += fmt::format("\nper {}: {}, one thread", experiment.value("item", ""),
                               plots::tick_text(*seconds / items, "seconds"));
        const std::string note = one.value("note", "");
        if (common.empty() && !note.empty()) tip += "\nnote: " + note;
        tips.push_back(tip);
    }
    return tips;
}

std::string method_cell(const ordered_json& measurement, bool has_note) {
    std::string cell = html_escaped(measurement.value("method", ""));
    if (measurement.value("efficient", false))
        cell +=
            R"( <span class="efficient" title="efficient: faster than all efficient methods that are )"
            R"(more accurate"><span aria-hidden="true">◆</span><span class="unseen">efficient</span></span>)";
    const std::string note = measurement.value("note", "");
    if (has_note && !note.empty())
        cell += fmt::format(R"( <small class="note">{}</small>)", html_escaped(note));
    return cell;
}

/// Returns a footer row of a chart's table, or an empty text if no curve has the number.
std::string curve_facts(const ordered_json& chart, const std::string& head,
                        const std::string& path) {
    std::string cells;
    bool is_empty = true;
    for (const ordered_json& curve : chart.at("curves")) {
        const std::optional<double> value = number_at(curve, path);
        is_empty = is_empty && !value;
        cells += fmt::format("<td>{}</td>", number_text(value));
    }
    if (is_empty) return "";
    return fmt::format(R"(<tr><th scope="row">{}</th>{}</tr>)", head, cells);
}

/// Returns a curve's error at x: a number, "no result", or an empty text without measurement.
std::string curve_cell(const ordered_json& curve, double x) {
    for (const ordered_json& point : curve.at("points")) {
        if (point.at(0).get<double>() != x) continue;
        const double error = point.at(1).is_number() ? point.at(1).get<double>() : NAN;
        return std::isfinite(error) ? number_text(error) : "no result";
    }
    return "";
}

std::set<double> all_x(const ordered_json& chart) {
    std::set<double> all;
    for (const ordered_json& curve : chart.at("curves")) {
        for (const ordered_json& point : curve.at("points"))
            all.insert(point.at(0).get<double>());
    }
    return all;
}

/// Returns the tooltips of a chart's points, curve by curve.
std::vector<std::string> point_tips(const ordered_json& chart) {
    std::vector<std::string> tips;
    for (const ordered_json& curve : chart.at("curves")) {
        const std::optional<double> order = number_at(curve, "/order");
        for (const ordered_json& point : curve.at("points")) {
            const double x = point.at(0).get<double>();
            std::string tip = fmt::format("{}\n{}: {}\n{}: {}", curve.value("method", ""),
                                          chart.value("x_label", ""), number_text(x),
                                          chart.value("y_label", ""), curve_cell(curve, x));
            if (number_at(curve, "/breaks_at") == x) tip += "\nhere: breaks";
            if (order) tip += fmt::format("\nslope: {:.2f}", *order);
            tips.push_back(tip);
        }
    }
    return tips;
}

/// Returns a cell with its number, by which the script sorts.
std::string table_cell(const ordered_json& measurement, const HtmlColumn& column) {
    const std::optional<double> value = number_at(measurement, column.path);
    return fmt::format("<td{}>{}</td>", value ? fmt::format(" data-value=\"{}\"", *value) : "",
                       column.cell(measurement));
}

/// A row per method with errors, times and memory. Columns without values are omitted.
std::string measurements_table(const ordered_json& experiment) {
    const ordered_json& measurements = experiment.at("measurements");
    const std::vector<HtmlColumn> columns = columns_of(measurements);
    const std::string common = common_note(measurements);
    std::string head = R"(<th scope="col">method</th>)";
    for (const HtmlColumn& one : columns)
        head += fmt::format(R"(<th scope="col">{}</th>)", one.head);
    std::string rows;
    for (std::size_t i = 0; i < measurements.size(); ++i) {
        rows += fmt::format(R"(<tr data-index="{}"><th scope="row">{}</th>)", i,
                            method_cell(measurements[i], common.empty()));
        for (const HtmlColumn& one : columns)
            rows += table_cell(measurements[i], one);
        rows += "</tr>\n";
    }
    return fmt::format(
        "<table class=\"measurements\"><caption>Errors in {}. {}</caption>\n"
        "<thead><tr>{}</tr></thead>\n<tbody>\n{}</tbody></table>\n",
        html_escaped(experiment.value("error_unit", "")), caption_text(measurements, common), head,
        rows);
}

/// A row per x and a column per curve, and below them the slopes and the points where curves break.
std::string chart_table(const ordered_json& chart) {
    std::string head;
    for (const ordered_json& curve : chart.at("curves"))
        head += fmt::format(R"(<th scope="col">{}</th>)", html_escaped(curve.value("method", "")));
    std::string rows;
    for (const double x : all_x(chart)) {
        rows += fmt::format(R"(<tr><th scope="row">{}</th>)", number_text(x));
        for (const ordered_json& curve : chart.at("curves"))
            rows += "<td>" + curve_cell(curve, x) + "</td>";
        rows += "</tr>\n";
    }
    return fmt::format(
        "<table class=\"points\"><caption>{}</caption>\n<thead><tr><th scope=\"col\">{}</th>{}</tr>"
        "</thead>\n<tbody>\n{}</tbody>\n<tfoot>{}{}{}</tfoot></table>\n",
        html_escaped(chart.value("y_label", "")), html_escaped(chart.value("x_label", "")), head,
        rows, curve_facts(chart, "slope, fitted", "/order"),
        curve_facts(chart, "slope, in theory", "/expected_order"),
        curve_facts(chart, "breaks at", "/breaks_at"));
}

/// The number of findings per subject that are visible at first.
constexpr std::size_t max_findings = 4;

using relief::detail::text_of;

/// Returns an escaped text, or an empty one.
std::string text_of(const ordered_json& json, const char* key) {
    const auto text = json.find(key);
    return text == json.end() || !text->is_string() ? "" : html_escaped(text->get<std::string>());
}

/// Returns a number, or 0.
double number_of(const ordered_json& json, const char* key) {
    const auto number = json.find(key);
    return number == json.end() || !number->is_number() ? 0.0 : number->get<double>();
}

std::string capitalized(std::string word) {
    if (!word.empty())
        word[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(word[0])));
    return word;
}

/// Returns a definition, or an empty text if there is no value.
std::string entry(const std::string& term, const std::string& html) {
    if (html.empty()) return "";
    return fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", term, html);
}

/// Returns whether a path is relative and stays within its folder.
bool is_within_folder(const std::filesystem::path& file) {
    return file.is_relative() &&
           std::none_of(file.begin(), file.end(), [](const auto& part) { return part == ".."; });
}

/// Returns an <img> with the picture as data, or a note if the report has no picture files.
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

/// The experiments of a subject.
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

/// Returns a link without the subject in its text: "Normals: torus" becomes "Torus".
std::string link_to(const ordered_json& experiment) {
    std::string title = experiment.value("title", "");
    const std::string subject = capitalized(experiment.value("subject", "")) + ": ";
    if (title.starts_with(subject)) title = capitalized(title.substr(subject.size()));
    return fmt::format(R"(<a href="#{}">{}</a>)", text_of(experiment, "id"), html_escaped(title));
}

/// Returns a table that scrolls if it is too wide, also by keyboard.
std::string scrolled(const std::string& name, const std::string& table) {
    return fmt::format(
        "<div class=\"scrolled\" role=\"region\" aria-label=\"{}\" tabindex=\"0\">\n{}</div>\n",
        name, table);
}

std::string charts_html(const ordered_json& experiment) {
    std::string html;
    for (const ordered_json& chart : experiment.value("charts", ordered_json::array())) {
        const std::string title = text_of(chart, "title");
        html += fmt::format(
            "<figure class=\"chart\">\n<figcaption><h4>{}</h4></figcaption>\n{}"
            "<details><summary>Numbers of this chart</summary>\n{}</details></figure>\n",
            title, chart_plot(chart, point_tips(chart)), scrolled(title, chart_table(chart)));
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
            "<figure class=\"pair\">\n<div class=\"sides\">{}{}</div>\n<figcaption>{}"
            "<label><input type=\"checkbox\"> difference × 8</label></figcaption></figure>\n",
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

std::string experiment_html(const ordered_json& experiment, const std::filesystem::path& folder) {
    const std::string finding = text_of(experiment, "finding");
    std::string html = fmt::format(
        "<article class=\"experiment\" id=\"{}\">\n<h3>{}</h3>\n<p class=\"question\">{}</p>\n",
        text_of(experiment, "id"), text_of(experiment, "title"), text_of(experiment, "question"));
    if (!finding.empty()) html += fmt::format("<p class=\"finding\">{}</p>\n", finding);
    html += fmt::format(
                "<details class=\"body\" open><summary>Plots and numbers <small>{}</small>"
                "</summary>\n<dl class=\"facts\">\n",
                counted(experiment.at("measurements").size(), "method")) +
            entry("Ground truth", text_of(experiment, "truth")) +
            entry("Input", text_of(experiment, "input")) +
            entry("Findings", findings_html(experiment)) +
            entry("Command", command_html(experiment)) + "</dl>\n";
    if (!experiment.at("measurements").empty())
        html +=
            scatter_figure(experiment, method_tips(experiment)) +
            scrolled("Methods of " + text_of(experiment, "title"), measurements_table(experiment));
    return html + charts_html(experiment) + heat_maps_html(experiment, folder) +
           pairs_html(experiment, folder) + "</details></article>\n";
}

/// Returns the load by other programs during the run; empty if it is unknown.
std::string other_programs_text(const ordered_json& settings) {
    if (!settings.contains("other_programs")) return "";
    const ordered_json& others = settings["other_programs"];
    return to_string(OtherPrograms{number_of(others, "processors"),
                                   static_cast<unsigned>(number_of(others, "available"))});
}

/// Returns <dt> and <dd> of machine, versions and settings.
std::string machine_html(const ordered_json& report) {
    const ordered_json machine = report.value("machine", ordered_json::object());
    const ordered_json settings = report.value("settings", ordered_json::object());
    const double memory = number_of(machine, "memory_bytes");
    std::string repeats;
    if (!settings.value("timed", true)) {
        repeats = "not measured";
    } else if (number_of(settings, "repeats") > 0.0) {
        repeats = fmt::format("medians of {} interleaved rounds", number_of(settings, "repeats"));
        const double passes = number_of(settings, "passes");
        if (passes > 1.0) repeats += fmt::format(", in {} passes over all experiments", passes);
    }
    return entry("Processor", text_of(machine, "processor")) +
           entry("Cores", number_text(number_of(machine, "cores"))) +
           entry("Memory", memory > 0.0 ? bytes_text(memory) : "") +
           entry("System", text_of(machine, "system")) +
           entry("Compiler", text_of(machine, "compiler")) +
           entry("Build", text_of(machine, "build")) + entry("OpenGL", text_of(machine, "opengl")) +
           entry("relief", text_of(report, "relief")) + entry("Times", repeats) +
           entry("Other programs", other_programs_text(settings)) +
           entry("Inputs", settings.value("quick", false) ? "small (--quick)" : "");
}

/// Returns the list of subjects with links to their experiments.
std::string contents_html(const ordered_json& report) {
    std::string html = "<ul>\n";
    for (const SubjectPart& subject : subjects_of(report)) {
        html += fmt::format(
            "<li><details open><summary><a href=\"#subject-{}\">{}</a></summary>\n<ul>\n",
            html_escaped(subject.name), html_escaped(capitalized(subject.name)));
        for (const std::size_t i : subject.experiments)
            html += "<li>" + link_to(report.at("experiments")[i]) + "</li>\n";
        html += "</ul></details></li>\n";
    }
    return html + "</ul>\n";
}

/// Returns the findings of each subject.
std::string summary_html(const ordered_json& report) {
    std::string html;
    for (const SubjectPart& subject : subjects_of(report)) {
        html += fmt::format("<section class=\"card\"><h3>{}</h3>\n<ul>\n",
                            html_escaped(capitalized(subject.name)));
        for (std::size_t place = 0; place < subject.experiments.size(); ++place) {
            const std::size_t left = subject.experiments.size() - place;
            if (place == max_findings && left > 1)
                html += fmt::format("</ul>\n<details><summary>{} more</summary>\n<ul>\n", left);
            const ordered_json& experiment = report.at("experiments")[subject.experiments[place]];
            const std::string findings = findings_html(experiment);
            html += fmt::format("<li>{} <span>{}</span>{}</li>\n", link_to(experiment),
                                text_of(experiment, "finding"),
                                findings.empty() ? "" : "<br><strong>" + findings + "</strong>");
        }
        html += subject.experiments.size() > max_findings + 1 ? "</ul></details></section>\n"
                                                              : "</ul></section>\n";
    }
    return html;
}

/// Returns a section per subject with an article per experiment.
std::string experiments_html(const ordered_json& report, const std::filesystem::path& folder) {
    std::string html;
    for (const SubjectPart& subject : subjects_of(report)) {
        html += fmt::format(
            "<section id=\"subject-{0}\" aria-labelledby=\"heading-{0}\">\n"
            "<h2 id=\"heading-{0}\">{1}</h2>\n",
            html_escaped(subject.name), html_escaped(capitalized(subject.name)));
        for (const std::size_t i : subject.experiments)
            html += experiment_html(report.at("experiments")[i], folder);
        html += "</section>\n";
    }
    return html;
}

/// Returns the template with each {{name}} replaced. Inserted text is not searched again.
std::string filled(std::string_view page, const std::map<std::string, std::string>& places) {
    std::string text;
    for (;;) {
        const std::size_t begin = page.find("{{");
        text += page.substr(0, begin);
        if (begin == std::string_view::npos) return text;
        const std::size_t end = page.find("}}", begin);
        const auto place = places.find(std::string(page.substr(begin + 2, end - begin - 2)));
        assert(place != places.end());
        text += place->second;
        page.remove_prefix(end + 2);
    }
}

struct ReportCommandOptions {
    std::filesystem::path report;
    std::optional<std::filesystem::path> output;
    bool quiet = false;
};

ExitCode run(const ReportCommandOptions& options) {
    const std::filesystem::path folder = options.report.parent_path();
    const std::filesystem::path page = options.output.value_or(folder / "report.html");
    if (identity_of(page) == identity_of(options.report))
        throw UsageError(fmt::format("{}: would replace the report", page.string()));
    require_folder_of(page);
    read_report(options.report);  // Checks the file. The page uses its JSON unchanged.
    const auto json = nlohmann::ordered_json::parse(read_file(options.report));
    write_text(page, about(options.report, [&] { return report_html(json, folder); }));
    if (!options.quiet) print_entry("written", file_and_size(page));
    return ExitCode::done;
}

}  // namespace

MethodTable method_table(const ordered_json& experiment) {
    const ordered_json& measurements = experiment.at("measurements");
    const std::vector<HtmlColumn> columns = columns_of(measurements);
    MethodTable table;
    for (const HtmlColumn& one : columns)
        table.columns.push_back(one.head);
    for (const ordered_json& measurement : measurements) {
        std::vector<std::string>& row = table.rows.emplace_back();
        for (const HtmlColumn& one : columns) {
            const std::string cell = one.cell(measurement);
            row.push_back(cell.substr(0, cell.find(" <small>")));
        }
    }
    return table;
}

std::string report_html(const ordered_json& report, const std::filesystem::path& folder) {
    return filled(report_part("page.html"),
                  {{"style", fmt::format("{}{}", report_part("plot.css"), report_part("page.css"))},
                   {"script", std::string(report_part("page.js"))},
                   {"command", html_escaped(report.value("command", ""))},
                   {"machine", machine_html(report)},
                   {"contents", contents_html(report)},
                   {"summary", summary_html(report)},
                   {"experiments", experiments_html(report, folder)}});
}

Command add_page_command(CLI::App& tool) {
    CLI::App& app =
        add_subcommand(tool, "report", "Writes the HTML page of an existing report from its JSON.");
    const auto options = std::make_shared<ReportCommandOptions>();
    add_file(app, "REPORT", options->report,
             "accuracy.json of an earlier run, with its pictures beside it.");
    add_path(app, "--output", options->output,
             "The page to write. Default: report.html beside the JSON.");
    add_switch(app, "--quiet", options->quiet, "Print only errors.");
    set_examples(app, {"relief-accuracy run storage --quick --no-times --output out/accuracy",
                       "relief-accuracy report out/accuracy/accuracy.json",
                       "relief-accuracy report out/accuracy/accuracy.json --output out/page.html"});
    return {&app, [options] { return run(*options); }};
}

}  // namespace relief::tools
