// SPDX-License-Identifier: Apache-2.0
// Writes the page of a report from its JSON: page/page.html with the sections of subjects and
// experiments. Also holds the command `relief-accuracy report REPORT`.
#include "report_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "accuracy_report.h"
#include "commands.h"
#include "common/file_jobs.h"
#include "common/html.h"
#include "common/options.h"
#include "common/text.h"
#include "files.h"
#include "plots.h"
#include "relief/accuracy/experiment.h"
#include "relief/mesh/report.h"

namespace relief::tools {
using nlohmann::ordered_json;

// Texts.

std::string number_text(std::optional<double> value) {
    if (!value || !std::isfinite(*value)) return "–";
    const double size = std::abs(*value);
    if (size == 0.0) return "0";
    if (size < 0.9995e-3 || size >= 0.9995e6) return fmt::format("{:.2e}", *value);
    if (*value == std::round(*value)) return fmt::format("{:.0f}", *value);
    const double rounded = std::stod(fmt::format("{:.2e}", *value));  // 9.996 becomes 10.0.
    const int before_point = static_cast<int>(std::floor(std::log10(std::abs(rounded)))) + 1;
    return fmt::format("{:.{}f}", rounded, std::max(3 - before_point, 0));
}

std::string range_text(double from, double to) {
    std::string begin = accuracy::format_seconds(from);
    const std::string end = accuracy::format_seconds(to);
    const std::string unit = end.substr(end.rfind(' '));
    if (begin.ends_with(unit)) begin.resize(begin.size() - unit.size());
    return begin + "–" + end;
}

std::string bytes_text(std::optional<double> bytes) {
    if (!bytes || *bytes < 1000.0) return number_text(bytes) + (bytes ? " B" : "");
    return byte_size(static_cast<std::uintmax_t>(std::llround(*bytes)));
}

std::size_t code_points_in(std::string_view text) {
    return static_cast<std::size_t>(
        std::ranges::count_if(text, [](char byte) { return (byte & 0xC0) != 0x80; }));
}

std::string_view report_part(std::string_view name) {
    const std::vector<ReportPart>& parts = report_parts();
    const auto part = std::find_if(parts.begin(), parts.end(),
                                   [&](const ReportPart& one) { return one.name == name; });
    assert(part != parts.end());
    return part->text;
}

// The table of methods.

namespace {

std::string seconds_text(std::optional<double> seconds) {
    return seconds ? accuracy::format_seconds(*seconds) : number_text(seconds);
}

/// A column, and the paths of its numbers in a measurement.
struct Column {
    const char* head;
    const char* path;
    std::string (*text)(std::optional<double>) = number_text;
    const char* from = "";  ///< The range beside a time.
    const char* to = "";
    bool is_always_shown = false;
};
constexpr std::array method_columns = {
    Column{.head = "RMS", .path = "/error/rms", .is_always_shown = true},
    Column{.head = "mean", .path = "/error/mean", .is_always_shown = true},
    Column{.head = "99 %", .path = "/error/p99", .is_always_shown = true},
    Column{.head = "max", .path = "/error/max", .is_always_shown = true},
    Column{"PSNR, dB", "/error/psnr"},
    Column{"undefined", "/error/undefined"},
    Column{"expected", "/expected_error/total"},
    Column{"one thread", "/cost/one_thread/median", seconds_text, "/cost/one_thread/p10",
           "/cost/one_thread/p90"},
    Column{"all threads", "/cost/all_threads/median", seconds_text, "/cost/all_threads/p10",
           "/cost/all_threads/p90"},
    Column{"memory", "/cost/peak_bytes", bytes_text},
    Column{"stored", "/cost/stored_bytes", bytes_text}};

MethodCell cell_of(const ordered_json& measurement, const Column& column) {
    const std::optional<double> value = number_at(measurement, column.path);
    MethodCell cell{column.text(value), "", value};
    const std::string_view head = column.head;
    const auto from = number_at(measurement, column.from);
    const auto to = number_at(measurement, column.to);
    if (*column.from != '\0' && from && to) cell.range = range_text(*from, *to);
    if (const auto upper = number_at(measurement, "/expected_error/total_upper");
        upper && head == "expected")
        cell.text += "–" + number_text(upper);
    if (head == "undefined" && value.value_or(0.0) > 0.0) {
        const double all = *value + number_at(measurement, "/error/count").value_or(0.0);
        const double percent = 100.0 * *value / all;
        cell.text += percent < 9.95 ? fmt::format(" ({:.2g} %)", percent)
                                    : fmt::format(" ({:.0f} %)", percent);
    }
    return cell;
}

std::vector<Column> columns_of(const ordered_json& measurements) {
    std::vector<Column> columns;
    for (const Column& column : method_columns) {
        const bool has_values =
            std::any_of(measurements.begin(), measurements.end(), [&](const ordered_json& one) {
                return number_at(one, column.path).value_or(0.0) != 0.0;
            });
        if (has_values || column.is_always_shown) columns.push_back(column);
    }
    return columns;
}

}  // namespace

MethodTable method_table(const ordered_json& experiment) {
    const ordered_json& measurements = experiment.at("measurements");
    MethodTable table;
    for (const Column& column : columns_of(measurements)) {
        table.columns.emplace_back(column.head);
        table.rows.resize(measurements.size());
        for (std::size_t i = 0; i < measurements.size(); ++i)
            table.rows[i].push_back(cell_of(measurements[i], column));
    }
    return table;
}

// The page.

namespace {

/// Returns an escaped text, or an empty one.
std::string escaped_at(const ordered_json& json, const char* key) {
    const auto text = json.find(key);
    return text == json.end() || !text->is_string() ? "" : html_escaped(text->get<std::string>());
}

/// Returns an array, or an empty one.
ordered_json list_at(const ordered_json& json, const char* key) {
    return json.value(key, ordered_json::array());
}

std::string capitalized(std::string word) {
    if (!word.empty())
        word[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(word[0])));
    return word;
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

/// Returns the tooltips of methods: the name, and a line for each value of the table.
std::vector<std::string> method_tips(const ordered_json& experiment, const MethodTable& table) {
    const ordered_json& measurements = experiment.at("measurements");
    const double items = number_at(experiment, "/items").value_or(0.0);
    std::vector<std::string> tips;
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
        std::string tip = measurements[i].value("method", "");
        for (std::size_t c = 0; c < table.columns.size(); ++c) {
            const MethodCell& cell = table.rows[i][c];
            const bool is_error = c < 4;
            if (cell.value)
                tip += fmt::format("\n{}: {}{}{}", table.columns[c], cell.text,
                                   cell.range.empty() ? "" : " " + cell.range,
                                   is_error ? " " + experiment.value("error_unit", "") : "");
        }
        const auto seconds = number_at(measurements[i], "/cost/one_thread/median");
        if (items > 0.0 && seconds)
            tip += fmt::format("\nper {}: {}, one thread", experiment.value("item", ""),
                               tick_text(*seconds / items, "seconds"));
        tips.push_back(tip);
    }
    return tips;
}

std::string data_value(std::optional<double> value) {
    return value ? fmt::format(" data-value=\"{}\"", *value) : "";
}

/// A row per method. The script sorts by data-value.
std::string measurements_table(const ordered_json& experiment, const MethodTable& table) {
    const ordered_json& measurements = experiment.at("measurements");
    const std::string common = common_note(measurements);
    std::string head, rows;
    for (const std::string& column : table.columns)
        head += "<th scope=\"col\">" + column + "</th>";
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
        const std::string note = common.empty() ? escaped_at(measurements[i], "note") : "";
        rows += fmt::format("<tr data-index=\"{}\"><th scope=\"row\">{}{}{}</th>", i,
                            escaped_at(measurements[i], "method"),
                            measurements[i].value("efficient", false)
                                ? " <span class=\"efficient\" title=\"efficient\">◆</span>"
                                : "",
                            note.empty() ? "" : " <small class=\"note\">" + note + "</small>");
        for (const MethodCell& cell : table.rows[i])
            rows += fmt::format("<td{}>{}{}</td>", data_value(cell.value), cell.text,
                                cell.range.empty() ? "" : " <small>" + cell.range + "</small>");
        rows += "</tr>\n";
    }
    return fmt::format(
        "<div class=\"scrolled\" tabindex=\"0\"><table class=\"measurements\">"
        "<caption>Errors in {}. {}</caption>\n<thead><tr><th scope=\"col\">method</th>{}</tr>"
        "</thead>\n<tbody>\n{}</tbody></table></div>\n",
        escaped_at(experiment, "error_unit"), html_escaped(common), head, rows);
}

/// Returns a curve's error at x: a number, "no result", or an empty text without measurement.
std::string error_at(const ordered_json& curve, double x) {
    for (const ordered_json& point : curve.at("points")) {
        if (point.at(0).get<double>() == x)
            return number_at(point, "/1") ? number_text(number_at(point, "/1")) : "no result";
    }
    return "";
}

/// A row per x and a column per curve, and below them the slopes and the points where curves break.
std::string chart_table(const ordered_json& chart) {
    std::string head, rows;
    std::set<double> all_x;
    const auto row = [&](const std::string& name, const auto& cell) {
        rows += "<tr><th scope=\"row\">" + name + "</th>";
        for (const ordered_json& curve : chart.at("curves"))
            rows += "<td>" + cell(curve) + "</td>";
        rows += "</tr>\n";
    };
    for (const ordered_json& curve : chart.at("curves")) {
        head += "<th scope=\"col\">" + escaped_at(curve, "method") + "</th>";
        for (const ordered_json& point : curve.at("points"))
            all_x.insert(point.at(0).get<double>());
    }
    for (const double x : all_x)
        row(number_text(x), [x](const ordered_json& curve) { return error_at(curve, x); });
    for (const auto& [name, path] :
         {std::pair("slope, fitted", "/order"), std::pair("slope, in theory", "/expected_order"),
          std::pair("breaks at", "/breaks_at")}) {
        const ordered_json& curves = chart.at("curves");
        if (std::any_of(curves.begin(), curves.end(), [key = path](const ordered_json& curve) {
                return number_at(curve, key).has_value();
            }))
            row(name, [key = path](const ordered_json& curve) {
                return number_text(number_at(curve, key));
            });
    }
    return fmt::format(
        "<div class=\"scrolled\" tabindex=\"0\"><table><caption>{}</caption>\n<thead><tr>"
        "<th scope=\"col\">{}</th>{}</tr></thead>\n<tbody>\n{}</tbody></table></div>\n",
        escaped_at(chart, "y_label"), escaped_at(chart, "x_label"), head, rows);
}

std::string charts_html(const ordered_json& experiment) {
    std::string html;
    for (const ordered_json& chart : list_at(experiment, "charts")) {
        std::vector<std::string> tips;
        for (const ordered_json& curve : chart.at("curves")) {
            for (const ordered_json& point : curve.at("points")) {
                const double x = point.at(0).get<double>();
                tips.push_back(fmt::format("{}\n{}: {}\n{}: {}{}", curve.value("method", ""),
                                           chart.value("x_label", ""), number_text(x),
                                           chart.value("y_label", ""), error_at(curve, x),
                                           number_at(curve, "/breaks_at") == x ? "\nbreaks" : ""));
            }
        }
        html += fmt::format(
            "<figure class=\"chart\"><figcaption><h4>{}</h4></figcaption>\n{}<details><summary>"
            "Numbers of this chart</summary>\n{}</details></figure>\n",
            escaped_at(chart, "title"), plot_html(curves_plot(chart, tips)), chart_table(chart));
    }
    return html;
}

/// Returns an <img> with the picture as data and a caption, or a note if no file was written.
std::string picture(const ordered_json& owner, const char* key, const std::string& caption,
                    const std::filesystem::path& folder) {
    const auto name = owner.find(key);
    if (name == owner.end() || !name->is_string())
        return fmt::format("<p class=\"absent\">{}: no picture was written</p>",
                           html_escaped(caption));
    const std::filesystem::path file = name->get<std::string>();
    const bool is_inside =
        file.is_relative() &&
        std::none_of(file.begin(), file.end(), [](const auto& part) { return part == ".."; });
    if (!is_inside)
        throw InvalidInput(
            fmt::format("names the picture {}, which is outside its folder", file.string()));
    return fmt::format(
        "<figure><img src=\"data:image/png;base64,{}\" alt=\"{}\"><figcaption>{}</figcaption>"
        "</figure>\n",
        base64(relief::detail::read_file(folder / file)), html_escaped(caption),
        html_escaped(caption));
}

std::string pictures_html(const ordered_json& experiment, const std::filesystem::path& folder) {
    std::string html;
    for (const ordered_json& map : list_at(experiment, "heat_maps"))
        html +=
            picture(map, "file",
                    fmt::format("{}, {}: black is 0, the brightest color {} {}",
                                map.value("title", ""), map.value("method", ""),
                                number_text(map.value("brightest", 1.0)), map.value("unit", "")),
                    folder);
    for (const ordered_json& pair : list_at(experiment, "pictures")) {
        for (const std::string side : {"before", "after"})
            html +=
                picture(pair, side.c_str(),
                        pair.value("title", "") + ": " + pair.value(side + "_label", side), folder);
    }
    return html.empty() ? "" : "<div class=\"pictures\">\n" + html + "</div>\n";
}

/// Returns a definition, or an empty text if there is no value.
std::string entry(const std::string& term, const std::string& html) {
    return html.empty() ? "" : fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", term, html);
}

/// Formats the findings on the input, one line each.
std::string input_findings(const ordered_json& experiment) {
    std::string html;
    for (const ordered_json& finding : list_at(experiment, "input_findings"))
        html += (html.empty() ? "" : "<br>") + html_escaped(finding.get<std::string>());
    return html;
}

std::string experiment_html(const ordered_json& experiment, const std::filesystem::path& folder) {
    const std::string command = escaped_at(experiment, "command");
    std::string html = fmt::format(
                           "<article id=\"{}\">\n<h3>{}</h3>\n<p class=\"question\">{}</p>\n"
                           "<p class=\"finding\">{}</p>\n<dl>\n",
                           escaped_at(experiment, "id"), escaped_at(experiment, "title"),
                           escaped_at(experiment, "question"), escaped_at(experiment, "finding")) +
                       entry("Ground truth", escaped_at(experiment, "truth")) +
                       entry("Input", escaped_at(experiment, "input")) +
                       entry("Findings", input_findings(experiment)) +
                       entry("Command", command.empty() ? "" : "<code>" + command + "</code>") +
                       "</dl>\n";
    if (!experiment.at("measurements").empty()) {
        const MethodTable table = method_table(experiment);
        html += "<figure class=\"scatter\"><figcaption><h4>Error against cost</h4></figcaption>\n" +
                plot_html(scatter_plot(experiment, method_tips(experiment, table))) +
                "</figure>\n" + measurements_table(experiment, table);
    }
    return html + charts_html(experiment) + pictures_html(experiment, folder) + "</article>\n";
}

/// Returns the load by other programs during the run; empty if it is unknown.
std::string other_programs_text(const ordered_json& settings) {
    const std::optional<double> processors = number_at(settings, "/other_programs/processors");
    const std::optional<double> available = number_at(settings, "/other_programs/available");
    if (!processors || !available) return "";
    return to_string(OtherPrograms{*processors, static_cast<unsigned>(*available)});
}

/// Returns <dt> and <dd> of machine, versions and settings.
std::string machine_html(const ordered_json& report) {
    const ordered_json machine = report.value("machine", ordered_json::object());
    const ordered_json settings = report.value("settings", ordered_json::object());
    const double memory = number_at(machine, "/memory_bytes").value_or(0.0);
    const double rounds = number_at(settings, "/repeats").value_or(0.0);
    const double passes = number_at(settings, "/passes").value_or(1.0);
    std::string times;
    if (!settings.value("timed", true))
        times = "not measured";
    else if (rounds > 0.0)
        times = fmt::format("medians of {} interleaved rounds", rounds);
    if (rounds > 0.0 && passes > 1.0)
        times += fmt::format(", in {} passes over all experiments", passes);
    return entry("Processor", escaped_at(machine, "processor")) +
           entry("Cores", number_text(number_at(machine, "/cores"))) +
           entry("Memory", memory > 0.0 ? bytes_text(memory) : "") +
           entry("System", escaped_at(machine, "system")) +
           entry("Compiler", escaped_at(machine, "compiler")) +
           entry("Build", escaped_at(machine, "build")) +
           entry("OpenGL", escaped_at(machine, "opengl")) +
           entry("relief", escaped_at(report, "relief")) + entry("Times", times) +
           entry("Other programs", other_programs_text(settings)) +
           entry("Inputs", settings.value("quick", false) ? "small (--quick)" : "");
}

/// Adds an experiment to the section of its subject in the summary: a link and its findings.
void add_to_summary(std::string& summary, const ordered_json& experiment) {
    std::string title = experiment.value("title", "");
    const std::string subject = capitalized(experiment.value("subject", "")) + ": ";
    if (title.starts_with(subject)) title = capitalized(title.substr(subject.size()));
    const std::string findings = input_findings(experiment);
    summary += fmt::format("<li><a href=\"#{}\">{}</a> <span>{}</span>{}</li>\n",
                           escaped_at(experiment, "id"), html_escaped(title),
                           escaped_at(experiment, "finding"),
                           findings.empty() ? "" : " <strong>" + findings + "</strong>");
}

/// Returns the template with each {{name}} replaced. Inserted text is not searched again.
std::string filled(std::string_view page, const std::map<std::string, std::string>& places) {
    std::string text;
    for (;;) {
        const std::size_t begin = page.find("{{");
        text += page.substr(0, begin);
        if (begin == std::string_view::npos) return text;
        const std::size_t end = page.find("}}", begin);
        text += places.at(std::string(page.substr(begin + 2, end - begin - 2)));
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
    const auto json = ordered_json::parse(relief::detail::read_file(options.report));
    write_text(page, about(options.report, [&] { return report_html(json, folder); }));
    if (!options.quiet) print_entry("written", file_and_size(page));
    return ExitCode::done;
}

}  // namespace

std::string report_html(const ordered_json& report, const std::filesystem::path& folder) {
    std::string summary, experiments, subject;
    for (const ordered_json& experiment : report.at("experiments")) {
        const std::string name = escaped_at(experiment, "subject");
        if (name != subject) {
            summary +=
                (subject.empty() ? "<h3>" : "</ul>\n<h3>") + capitalized(name) + "</h3>\n<ul>\n";
            experiments += "<h2>" + capitalized(name) + "</h2>\n";
            subject = name;
        }
        add_to_summary(summary, experiment);
        experiments += experiment_html(experiment, folder);
    }
    return filled(report_part("page.html"),
                  {{"style", fmt::format("{}{}", report_part("plot.css"), report_part("page.css"))},
                   {"script", std::string(report_part("page.js"))},
                   {"command", escaped_at(report, "command")},
                   {"machine", machine_html(report)},
                   {"summary", subject.empty() ? "" : summary + "</ul>\n"},
                   {"experiments", experiments}});
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
