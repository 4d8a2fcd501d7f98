// SPDX-License-Identifier: Apache-2.0
// Writes a report to a folder: CSV tables, pictures, the JSON report and the HTML page; and formats
// an experiment as text for a terminal. Tests: tests/tools/accuracy_report_test.cpp,
// accuracy_run_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <array>
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

/// Returns a cell of a CSV table. Numbers are the shortest texts that are read as the same number.
std::string csv_cell(const Json& value) {
    if (value.is_number_float())
        return std::isfinite(value.get<double>()) ? fmt::format("{}", value.get<double>()) : "";
    if (value.is_null()) return "";
    if (value.is_boolean()) return value.get<bool>() ? "1" : "0";
    const std::string text = value.is_string() ? value.get<std::string>() : value.dump();
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string cell = "\"";
    for (const char letter : text)
        cell += letter == '"' ? std::string("\"\"") : std::string(1, letter);
    return cell + "\"";
}

std::string csv_line(const std::vector<Json>& cells) {
    std::vector<std::string> texts;
    for (const Json& cell : cells)
        texts.push_back(csv_cell(cell));
    return fmt::format("{}\n", fmt::join(texts, ","));
}

/// The columns of the table of measurements: the name, and the path in the JSON of an experiment or
/// of a measurement.
struct CsvColumn {
    const char* name;
    const char* path;
    bool is_of_experiment = false;
};
constexpr std::array csv_columns = {CsvColumn{"experiment", "/id", true},
                                    CsvColumn{"subject", "/subject", true},
                                    CsvColumn{"method", "/method"},
                                    CsvColumn{"choices", "/choices"},
                                    CsvColumn{"error_unit", "/error_unit", true},
                                    CsvColumn{"count", "/error/count"},
                                    CsvColumn{"undefined", "/error/undefined"},
                                    CsvColumn{"rms", "/error/rms"},
                                    CsvColumn{"mean", "/error/mean"},
                                    CsvColumn{"p99", "/error/p99"},
                                    CsvColumn{"max", "/error/max"},
                                    CsvColumn{"psnr", "/error/psnr"},
                                    CsvColumn{"item", "/item", true},
                                    CsvColumn{"items", "/items", true},
                                    CsvColumn{"one_thread_seconds", "/cost/one_thread/median"},
                                    CsvColumn{"one_thread_p10", "/cost/one_thread/p10"},
                                    CsvColumn{"one_thread_p90", "/cost/one_thread/p90"},
                                    CsvColumn{"one_thread_rounds", "/cost/one_thread/rounds"},
                                    CsvColumn{"all_threads_seconds", "/cost/all_threads/median"},
                                    CsvColumn{"all_threads_p10", "/cost/all_threads/p10"},
                                    CsvColumn{"all_threads_p90", "/cost/all_threads/p90"},
                                    CsvColumn{"all_threads_rounds", "/cost/all_threads/rounds"},
                                    CsvColumn{"peak_bytes", "/cost/peak_bytes"},
                                    CsvColumn{"stored_bytes", "/cost/stored_bytes"},
                                    CsvColumn{"efficient", "/efficient"}};

/// Returns the value of a column: "a=b; c=d" for choices, and the number of rounds.
Json csv_value(const Json& experiment, const Json& measurement, const CsvColumn& column) {
    const Json::json_pointer path(column.path);
    const Json& owner = column.is_of_experiment ? experiment : measurement;
    if (!owner.contains(path)) return nullptr;
    const Json& value = owner.at(path);
    if (value.is_array()) return value.size();
    if (!value.is_object()) return value;
    std::string text;
    for (const auto& [choice, name] : value.items())
        text += (text.empty() ? "" : "; ") + choice + "=" + name.get<std::string>();
    return text;
}

constexpr std::array role_names = {"heat", "before", "after"};  ///< By PictureRole.

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
    std::vector<Json> names;
    for (const CsvColumn& column : csv_columns)
        names.emplace_back(column.name);
    std::string text = csv_line(names);
    for (const Experiment& experiment : report.experiments) {
        const Json json = json_of(experiment, false);
        for (const Json& measurement : json.at("measurements")) {
            std::vector<Json> cells;
            for (const CsvColumn& column : csv_columns)
                cells.push_back(csv_value(json, measurement, column));
            text += csv_line(cells);
        }
    }
    return text;
}

std::string curves_csv(const AccuracyReport& report) {
    std::string text =
        csv_line({"experiment", "chart", "method", "x_label", "x", "error_unit", "error"});
    for (const Experiment& experiment : report.experiments) {
        for (const Chart& chart : experiment.charts) {
            for (const Curve& curve : chart.curves) {
                for (const CurvePoint& point : curve.points)
                    text += csv_line({experiment.id, chart.id, curve.method, chart.x_label, point.x,
                                      experiment.error_unit, point.error});
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
    return fmt::format("pictures/{}-{}-{}.png", name, role_names.at(static_cast<std::size_t>(role)),
                       index + 1);
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

/// Returns the table of methods. The names are aligned to the left, numbers to the right; rows of
/// efficient methods begin with an asterisk.
std::string rows_of(const Experiment& experiment) {
    const MethodTable table = method_table(json_of(experiment, false));
    std::vector<std::vector<std::string>> rows = {{""}};
    rows[0].insert(rows[0].end(), table.columns.begin(), table.columns.end());
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
        rows.push_back({experiment.measurements[i].method});
        for (const MethodCell& cell : table.rows[i])
            rows.back().push_back(cell.text + (cell.range.empty() ? "" : " (" + cell.range + ")"));
    }
    std::vector<std::size_t> widths(rows[0].size());
    for (const std::vector<std::string>& row : rows) {
        for (std::size_t c = 0; c < row.size(); ++c)
            widths[c] = std::max(widths[c], code_points_in(row[c]));
    }
    std::string text;
    for (std::size_t r = 0; r < rows.size(); ++r) {
        std::string line =
            r > 0 && experiment.measurements[r - 1].is_pareto_optimal ? "  * " : "    ";
        for (std::size_t c = 0; c < rows[r].size(); ++c) {
            const std::string space(widths[c] - code_points_in(rows[r][c]), ' ');
            line += c == 0 ? rows[r][c] + space : "  " + space + rows[r][c];
        }
        line.erase(line.find_last_not_of(' ') + 1);
        text += line + "\n";
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
        text += fmt::format(" {} at {:.4g}, {} at {:.4g}", number_text(curve.points.front().error),
                            curve.points.front().x, number_text(curve.points.back().error),
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
    if (!experiment.measurements.empty()) text += rows_of(experiment);
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
