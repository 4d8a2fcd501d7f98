// SPDX-License-Identifier: Apache-2.0
// Writes a report to a folder: CSV tables, pictures, the JSON report and the HTML page; and formats
// an experiment as text for a terminal. Tests: tests/tools/accuracy_report_test.cpp,
// accuracy_run_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "accuracy_report.h"
#include "common/command.h"
#include "common/text.h"
#include "file_replacement.h"
#include "relief/accuracy/experiment.h"
#include "relief/mesh/image.h"
#include "relief/mesh/image_file.h"
#include "report_page.h"

namespace relief::tools {
using namespace relief::accuracy;
using namespace relief::detail;

namespace {

using Row = std::vector<std::string>;

std::string csv_quoted(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string cell = "\"";
    for (const char letter : text)
        cell += letter == '"' ? std::string("\"\"") : std::string(1, letter);
    return cell + "\"";
}

std::string line_of(const Row& row) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
        if (i > 0) line += ',';
        line += csv_quoted(row[i]);
    }
    return line + "\n";
}

/// Returns the shortest text that is read as the same number.
std::string csv_number(double value) {
    return std::isfinite(value) ? fmt::format("{}", value) : "";
}

std::string choices_of(const Measurement& one) {
    std::string text;
    for (const auto& [choice, value] : one.choices)
        text += fmt::format("{}{}={}", text.empty() ? "" : "; ", choice, value);
    return text;
}

void add_times(Row& row, const std::optional<Timing>& timing) {
    if (!timing) {
        row.insert(row.end(), 4, "");
        return;
    }
    const TimeStatistics spread = timing->spread();
    for (const double seconds : {spread.median, spread.p10, spread.p90})
        row.push_back(csv_number(seconds));
    row.push_back(fmt::to_string(spread.count));
}

Row row_of(const Experiment& experiment, const Measurement& one) {
    const ErrorStats& error = one.error;
    Row row = {experiment.id,
               std::string(enum_name(experiment.subject)),
               one.method,
               choices_of(one),
               experiment.error_unit,
               fmt::to_string(error.count),
               fmt::to_string(error.undefined),
               csv_number(error.rms),
               csv_number(error.mean),
               csv_number(error.p99),
               csv_number(error.max),
               error.psnr ? csv_number(*error.psnr) : "",
               experiment.item,
               csv_number(experiment.items)};
    add_times(row, one.cost.one_thread);
    add_times(row, one.cost.all_threads);
    row.push_back(one.cost.peak_bytes ? fmt::to_string(*one.cost.peak_bytes) : "");
    row.push_back(one.cost.stored_bytes > 0.0 ? csv_number(one.cost.stored_bytes) : "");
    row.emplace_back(one.is_pareto_optimal ? "1" : "0");
    return row;
}

const char* role_name(PictureRole role) {
    switch (role) {
        case PictureRole::heat:
            return "heat";
        case PictureRole::before:
            return "before";
        case PictureRole::after:
            break;
    }
    return "after";
}

/// Writes all pictures as PNG to folder/pictures. \throws FileError
void write_pictures(const std::filesystem::path& folder, const AccuracyReport& report) {
    const auto write = [&](const std::string& file, const Image& image) {
        make_folder(folder / "pictures");
        write_image(folder / file, image);
    };
    for (const Experiment& one : report.experiments) {
        for (std::size_t i = 0; i < one.heat_maps.size(); ++i) {
            const HeatMap& map = one.heat_maps[i];
            write(picture_file(one, PictureRole::heat, i),
                  false_color_image(map.errors, map.brightest));
        }
        for (std::size_t i = 0; i < one.pictures.size(); ++i) {
            write(picture_file(one, PictureRole::before, i), one.pictures[i].before);
            write(picture_file(one, PictureRole::after, i), one.pictures[i].after);
        }
    }
}

}  // namespace

std::string measurements_csv(const AccuracyReport& report) {
    std::string text = line_of({"experiment",
                                "subject",
                                "method",
                                "choices",
                                "error_unit",
                                "count",
                                "undefined",
                                "rms",
                                "mean",
                                "p99",
                                "max",
                                "psnr",
                                "item",
                                "items",
                                "one_thread_seconds",
                                "one_thread_p10",
                                "one_thread_p90",
                                "one_thread_rounds",
                                "all_threads_seconds",
                                "all_threads_p10",
                                "all_threads_p90",
                                "all_threads_rounds",
                                "peak_bytes",
                                "stored_bytes",
                                "efficient"});
    for (const Experiment& experiment : report.experiments) {
        for (const Measurement& one : experiment.measurements)
            text += line_of(row_of(experiment, one));
    }
    return text;
}

std::string curves_csv(const AccuracyReport& report) {
    std::string text =
        line_of({"experiment", "chart", "method", "x_label", "x", "error_unit", "error"});
    for (const Experiment& experiment : report.experiments) {
        for (const Chart& chart : experiment.charts) {
            for (const Curve& curve : chart.curves) {
                for (const CurvePoint& point : curve.points)
                    text += line_of({experiment.id, chart.id, curve.method, chart.x_label,
                                     csv_number(point.x), experiment.error_unit,
                                     csv_number(point.error)});
            }
        }
    }
    return text;
}

std::string picture_file(const Experiment& experiment, PictureRole role, std::size_t index) {
    std::string name = experiment.id;
    for (char& letter : name) {
        const bool is_plain = (letter >= 'a' && letter <= 'z') ||
                              (letter >= 'A' && letter <= 'Z') ||
                              (letter >= '0' && letter <= '9') || letter == '.';
        if (!is_plain) letter = '-';
    }
    return fmt::format("pictures/{}-{}-{}.png", name, role_name(role), index + 1);
}

void write_text(const std::filesystem::path& file, const std::string& text) {
    replace_file(file, std::as_bytes(std::span(text)));
}

std::vector<std::filesystem::path> write_report(const std::filesystem::path& folder,
                                                const AccuracyReport& report) {
    FileSet files;
    write_pictures(folder, report);
    write_text(folder / "accuracy.csv", measurements_csv(report));
    write_text(folder / "accuracy-curves.csv", curves_csv(report));
    const nlohmann::ordered_json json = json_of(report, true);
    write_text(folder / "report.html", report_html(json, folder));
    write_json(folder / "accuracy.json", json);
    files.commit();
    return {folder / "report.html", folder / "accuracy.json", folder / "accuracy.csv",
            folder / "accuracy-curves.csv"};
}

// The table for a terminal.

namespace {

/// A column of cells. Numbers are aligned to the right.
struct TextColumn {
    std::string heading;
    std::vector<std::string> cells;
    bool is_text = false;

    [[nodiscard]] bool empty() const {
        return std::all_of(cells.begin(), cells.end(),
                           [](const std::string& cell) { return cell.empty(); });
    }
    /// Returns the width in code points of UTF-8.
    [[nodiscard]] std::size_t width() const {
        std::size_t width = letters_of(heading);
        for (const std::string& cell : cells)
            width = std::max(width, letters_of(cell));
        return width;
    }
    static std::size_t letters_of(const std::string& text) {
        return static_cast<std::size_t>(std::count_if(
            text.begin(), text.end(), [](char byte) { return (byte & 0xC0) != 0x80; }));
    }
};

std::string padded(const std::string& text, std::size_t width, bool is_text) {
    const std::string space(width - TextColumn::letters_of(text), ' ');
    return is_text ? text + space : space + text;
}

std::string line_of(const std::vector<TextColumn>& columns, const std::string& begin,
                    const std::vector<std::size_t>& widths, std::size_t row, bool is_heading) {
    std::string line = begin;
    for (std::size_t i = 0; i < columns.size(); ++i) {
        const TextColumn& column = columns[i];
        const std::string& text = is_heading ? column.heading : column.cells[row];
        if (i > 0) line += "  ";
        line += padded(text, widths[i], column.is_text);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    return line + "\n";
}

std::string table_number(double value) {
    return std::isfinite(value) ? fmt::format("{:.3g}", value) : "-";
}

/// Returns the range from the 10th to the 90th percentile: "11.9–12.8 ms".
std::string time_statistics(const std::optional<Timing>& timing) {
    if (!timing) return "";
    const TimeStatistics spread = timing->spread();
    return range_text(spread.p10, spread.p90);
}

/// Returns the expected error, "1.35", or its range, "1.35–8.5".
std::string expected_text(const Experiment& experiment, const Measurement& one) {
    if (!one.expected) return "";
    const std::optional<double>& upper = experiment.reference_error_upper;
    return table_number(one.expected->total()) +
           (upper ? "–" + table_number(ExpectedError{*upper, one.expected->added}.total()) : "");
}

std::string median_of(const std::optional<Timing>& timing) {
    return timing ? format_seconds(timing->spread().median) : "";
}

std::vector<TextColumn> columns_of(const Experiment& experiment) {
    std::vector<TextColumn> columns = {
        {"", {}, true},    {"RMS", {}},      {"mean", {}},   {"99 %", {}},     {"max", {}},
        {"undefined", {}}, {"expected", {}}, {"PSNR", {}},   {"1 thread", {}}, {"", {}},
        {"all", {}},       {"", {}},         {"memory", {}}, {"stored", {}}};
    for (const Measurement& one : experiment.measurements) {
        const ErrorStats& error = one.error;
        const std::vector<std::string> cells = {
            one.method,
            table_number(error.rms),
            table_number(error.mean),
            table_number(error.p99),
            table_number(error.max),
            error.undefined > 0 ? fmt::to_string(error.undefined) : "",
            expected_text(experiment, one),
            error.psnr ? fmt::format("{:.1f} dB", *error.psnr) : "",
            median_of(one.cost.one_thread),
            time_statistics(one.cost.one_thread),
            median_of(one.cost.all_threads),
            time_statistics(one.cost.all_threads),
            one.cost.peak_bytes ? byte_size(*one.cost.peak_bytes) : "",
            one.cost.stored_bytes > 0.0 ? fmt::format("{:.3g} B", one.cost.stored_bytes) : ""};
        for (std::size_t i = 0; i < columns.size(); ++i)
            columns[i].cells.push_back(cells[i]);
    }
    std::erase_if(columns, [](const TextColumn& column) { return column.empty(); });
    return columns;
}

std::string rows_of(const Experiment& experiment) {
    if (experiment.measurements.empty()) return "";
    const std::vector<TextColumn> columns = columns_of(experiment);
    std::vector<std::size_t> widths;
    widths.reserve(columns.size());
    for (const TextColumn& column : columns)
        widths.push_back(column.width());
    std::string text = line_of(columns, "    ", widths, 0, true);
    for (std::size_t row = 0; row < experiment.measurements.size(); ++row) {
        const Measurement& one = experiment.measurements[row];
        text += line_of(columns, one.is_pareto_optimal ? "  * " : "    ", widths, row, false);
    }
    return text;
}

/// Returns each note once, after the names of its methods unless it applies to all.
std::string notes_of(const Experiment& experiment) {
    std::vector<std::pair<std::string, std::vector<std::string>>> notes;
    for (const Measurement& one : experiment.measurements) {
        if (one.note.empty()) continue;
        const auto known = std::find_if(notes.begin(), notes.end(),
                                        [&](const auto& note) { return note.first == one.note; });
        if (known == notes.end())
            notes.push_back({one.note, {one.method}});
        else
            known->second.push_back(one.method);
    }
    std::string text;
    for (const auto& [note, methods] : notes) {
        const bool is_general = methods.size() == experiment.measurements.size();
        text += is_general ? fmt::format("  {}\n", note)
                           : fmt::format("  {}: {}\n", fmt::join(methods, "; "), note);
    }
    return text;
}

/// "sobel3: order 1.99 of 2, breaks at 1e-12"
std::string line_of(const Curve& curve) {
    std::string text = curve.method + ":";
    if (curve.points.size() > 1) {
        text += fmt::format(" {} at {:.4g}, {} at {:.4g}", table_number(curve.points.front().error),
                            curve.points.front().x, table_number(curve.points.back().error),
                            curve.points.back().x);
    }
    if (curve.order) text += fmt::format(", order {:.2f}", *curve.order);
    if (curve.expected_order) text += fmt::format(" (in theory {:.3g})", *curve.expected_order);
    if (curve.breaks_at) text += fmt::format(", breaks at {:.3g}", *curve.breaks_at);
    return text;
}

}  // namespace

std::string table_of(const Experiment& experiment) {
    std::string text =
        fmt::format("{}: {}\n  {}\n", experiment.id, experiment.title, experiment.question);
    text += fmt::format("  input         {}\n  ground truth  {}\n  error         {}\n",
                        experiment.input, experiment.ground_truth, experiment.error_unit);
    if (experiment.reference_error) {
        text += fmt::format(
            "  expected: RMS, the root of the sum of squares of the reference error, {:.3g}{}, and "
            "the "
            "error of the method\n",
            *experiment.reference_error,
            experiment.reference_error_upper
                ? fmt::format(" to {:.3g} (the input does not show it)",
                              *experiment.reference_error_upper)
                : "");
    }
    text += rows_of(experiment);
    text += notes_of(experiment);
    for (const Chart& chart : experiment.charts) {
        text += fmt::format("  {} (by {})\n", chart.title, chart.x_label);
        for (const Curve& curve : chart.curves)
            text += fmt::format("    {}\n", line_of(curve));
    }
    if (!experiment.finding.empty()) text += fmt::format("  {}\n", experiment.finding);
    return text;
}

}  // namespace relief::tools
