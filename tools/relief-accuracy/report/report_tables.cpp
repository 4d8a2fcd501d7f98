// SPDX-License-Identifier: Apache-2.0
// Columns as data, so that a column is one line. Tests:
// tests/tools/accuracy_page/report_html_test.cpp.
#include "report/report_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <vector>

#include "report/html_text.h"

namespace relief::tools {
namespace {

using nlohmann::ordered_json;

/// The number at a path, "/error/rms"; nothing where it is absent or null.
std::optional<double> number_at(const ordered_json& json, const std::string& path) {
    const ordered_json::json_pointer pointer(path);
    if (!json.contains(pointer) || !json.at(pointer).is_number()) return std::nullopt;
    return json.at(pointer).get<double>();
}

/// A time's median with its tenth and ninetieth percentile.
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
    std::string path;  ///< In a measurement, to the number by which rows are sorted.
    std::function<std::string(const ordered_json& measurement)> cell;
};

/// A column of plain numbers.
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

/// How many results have no error: "128826 (35 %)" of all.
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

/// Whether any measurement has a number other than 0 there.
bool says_something(const ordered_json& measurements, const std::string& path) {
    return std::any_of(measurements.begin(), measurements.end(), [&](const ordered_json& one) {
        return number_at(one, path).value_or(0.0) != 0.0;
    });
}

std::vector<HtmlColumn> columns_of(const ordered_json& measurements) {
    std::vector<HtmlColumn> columns = {
        column("RMS", "/error/rms", number_text), column("mean", "/error/mean", number_text),
        column("99 %", "/error/p99", number_text), column("max", "/error/max", number_text)};
    for (const HtmlColumn& optional :
         {column("PSNR, dB", "/error/psnr", number_text), undefined_column(),
          column("expected", "/expected_error/total", number_text),
          time_column("one thread", "/cost/one_thread"),
          time_column("all threads", "/cost/all_threads"),
          column("memory", "/cost/peak_bytes", bytes_text),
          column("stored", "/cost/stored_bytes", bytes_text)}) {
        if (says_something(measurements, optional.path)) columns.push_back(optional);
    }
    return columns;
}

/// The note that all measurements have; empty where they differ, or one stands alone.
std::string common_note(const ordered_json& measurements) {
    if (measurements.size() < 2) return "";
    std::string note = measurements[0].value("note", "");
    const bool is_common =
        std::all_of(measurements.begin(), measurements.end(),
                    [&](const ordered_json& one) { return one.value("note", "") == note; });
    return is_common ? note : "";
}

/// What the columns and marks of a table mean, of those that it has.
std::string caption_words(const ordered_json& measurements, const std::string& common_note) {
    std::string words;
    if (says_something(measurements, "/error/undefined"))
        words += "Undefined results are counted, and left out of the other figures. ";
    if (says_something(measurements, "/expected_error/total"))
        words +=
            "Expected is the error of the reference itself and that of the method, as the root of "
            "the sum of squares. ";
    if (says_something(measurements, "/cost/one_thread/median") ||
        says_something(measurements, "/cost/all_threads/median"))
        words +=
            "Times are medians, with the range from the 10th to the 90th percentile; ◆ marks "
            "methods that no other one beats in both error and time. ";
    if (says_something(measurements, "/cost/stored_bytes"))
        words += "Stored is the size of one result (a vertex's frame, a texel). ";
    return words + html_escaped(common_note);
}

std::string method_cell(const ordered_json& measurement, bool has_note) {
    std::string cell = html_escaped(measurement.value("method", ""));
    if (measurement.value("efficient", false))
        cell +=
            R"( <span class="efficient" title="on the frontier: nothing is both faster and more )"
            R"(exact"><span aria-hidden="true">◆</span><span class="unseen">efficient</span></span>)";
    const std::string note = measurement.value("note", "");
    if (has_note && !note.empty())
        cell += fmt::format(R"( <small class="note">{}</small>)", html_escaped(note));
    return cell;
}

/// A row of a chart's table below its numbers; empty where no curve has such a number.
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

/// A curve's error at an x: a number, "no result", or nothing where the curve was not measured.
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

}  // namespace

std::string measurements_table(const ordered_json& experiment) {
    const ordered_json& measurements = experiment.at("measurements");
    const std::vector<HtmlColumn> columns = columns_of(measurements);
    const std::string common = common_note(measurements);
    std::string head = R"(<th scope="col" data-path="/method">method</th>)";
    for (const HtmlColumn& one : columns)
        head += fmt::format(R"(<th scope="col" data-path="{}">{}</th>)", one.path, one.head);
    std::string rows;
    for (std::size_t i = 0; i < measurements.size(); ++i) {
        rows += fmt::format(R"(<tr data-index="{}"><th scope="row">{}</th>)", i,
                            method_cell(measurements[i], common.empty()));
        for (const HtmlColumn& one : columns)
            rows += "<td>" + one.cell(measurements[i]) + "</td>";
        rows += "</tr>\n";
    }
    return fmt::format(
        "<table class=\"measurements\"><caption>Errors in {}. {}</caption>\n"
        "<thead><tr>{}</tr></thead>\n<tbody>\n{}</tbody></table>\n",
        html_escaped(experiment.value("error_unit", "")), caption_words(measurements, common), head,
        rows);
}

std::string chart_table(const ordered_json& chart) {
    std::string head;
    for (const ordered_json& curve : chart.at("curves"))
        head += fmt::format(R"(<th scope="col">{}</th>)", html_escaped(curve.value("method", "")));
    std::string rows;
    for (const double x : all_x(chart)) {
        rows += fmt::format(R"(<tr data-x="{}"><th scope="row">{}</th>)", x, number_text(x));
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

}  // namespace relief::tools
