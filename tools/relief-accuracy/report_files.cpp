// SPDX-License-Identifier: Apache-2.0
// Writes a report to a folder: CSV tables, pictures, the JSON report and the HTML page.
// Tests: tests/tools/accuracy_report_test.cpp, accuracy_run_test.cpp.
#include "accuracy_report.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "common/command.h"
#include "common/text.h"
#include "file_replacement.h"
#include "relief/accuracy/subjects.h"
#include "relief/mesh/image.h"
#include "relief/mesh/image_file.h"
#include "report_page.h"

namespace relief::tools {
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
    const ErrorFigures& error = one.error;
    Row row = {experiment.id,
               std::string(name_of(experiment.subject)),
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
    write_pictures(folder, report);
    write_text(folder / "accuracy.csv", measurements_csv(report));
    write_text(folder / "accuracy-curves.csv", curves_csv(report));
    const nlohmann::ordered_json json = json_of(report, true);
    write_text(folder / "report.html", report_html(json, folder));
    write_json(folder / "accuracy.json", json);
    return {folder / "report.html", folder / "accuracy.json", folder / "accuracy.csv",
            folder / "accuracy-curves.csv"};
}

}  // namespace relief::tools
