// SPDX-License-Identifier: Apache-2.0
// Checks the errors in docs/accuracy.md against the stored figures of the experiments. Shading is
// excluded, because its errors depend on the driver.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "accuracy/figure_table.h"
#include "plots.h"
#include "support/labels.h"
#include "support/shared_data.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

FILE_LABELS(docs);

/// The cells of a row by the heads of their columns.
using Cells = std::map<std::string, std::string>;
/// The rows by method of each experiment, "`normals/torus-jittered`, torus, ... 8192 triangles".
using Page = std::map<std::string, std::map<std::string, Cells>>;

std::string without_bold(std::string text) {
    std::erase(text, '*');
    return text;
}

/// Returns the lines of the page. A paragraph that begins with code is joined to one line.
std::vector<std::string> lines_of_the_page() {
    std::ifstream file(test::source_directory() / "docs/accuracy.md");
    std::vector<std::string> lines;
    bool continues = false;
    for (std::string line; std::getline(file, line);) {
        if (continues && !line.empty()) {
            lines.back() += " " + line;
        } else {
            lines.push_back(line);
            continues = line.starts_with("`");
        }
    }
    return lines;
}

/// Returns the cells of a line of a table.
std::vector<std::string> cells_of(const std::string& line) {
    std::vector<std::string> cells;
    std::istringstream text(line.substr(1));
    for (std::string cell; std::getline(text, cell, '|');) {
        cell = without_bold(cell);
        const std::size_t begin = cell.find_first_not_of(' ');
        cells.push_back(begin == std::string::npos
                            ? ""
                            : cell.substr(begin, cell.find_last_not_of(' ') + 1 - begin));
    }
    return cells;
}

Page numbers_of_the_page() {
    Page page;
    std::map<std::string, Cells>* rows = nullptr;
    std::vector<std::string> heads;
    for (const std::string& line : lines_of_the_page()) {
        if (line.starts_with("`")) rows = &page[line.substr(0, line.rfind("; errors in "))];
        if (rows == nullptr || !line.starts_with("| ")) continue;
        const std::vector<std::string> cells = cells_of(line);
        if (line.starts_with("| |")) {
            heads = cells;
            continue;
        }
        for (std::size_t i = 1; i < cells.size(); ++i)
            (*rows)[cells.front()][heads.at(i)] = cells[i];
    }
    return page;
}

/// Returns half of the last digit of a printed number, the rounding error, with a margin for the
/// last bits of other C libraries.
double tolerance_of(const std::string& shown) {
    const std::size_t exponent = shown.find_first_of("eE");
    const std::string digits = shown.substr(0, exponent);
    const std::size_t point = digits.find('.');
    const int decimals =
        point == std::string::npos ? 0 : static_cast<int>(digits.size() - point - 1);
    const int power = exponent == std::string::npos ? 0 : std::stoi(shown.substr(exponent + 1));
    return 0.5000001 * std::pow(10.0, power - decimals);
}

/// The columns with figures that are the same in every run, and where a report has them.
struct FigureColumn {
    const char* head;
    const char* path;
    const char* upper_path = nullptr;  ///< Of the upper end of a range.
};
constexpr std::array figure_columns = {
    FigureColumn{"RMS", "/error/rms"},
    FigureColumn{"mean", "/error/mean"},
    FigureColumn{"99 %", "/error/p99"},
    FigureColumn{"max", "/error/max"},
    FigureColumn{"undefined", "/error/undefined"},
    FigureColumn{"expected", "/expected_error/total", "/expected_error/total_upper"},
    FigureColumn{"stored", "/cost/stored_bytes"}};

/// \param shown  "0.453", "28 B", "100 (35 %)", or "–" without a value
void expect_number(const std::string& shown, const Value& value, const std::string& what) {
    const std::string number = shown.substr(0, shown.find(' '));
    if (number == "–" || !value) {
        EXPECT_EQ(number == "–", !value) << what;
        return;
    }
    EXPECT_NEAR(std::stod(number), *value, tolerance_of(number))
        << what << " (run relief-accuracy and relief-documents --accuracy again)";
}

/// Compares all figures of the methods that the page shows.
/// \return the number of these methods
std::size_t compare_with_the_page(const Page& page, const nlohmann::ordered_json& experiment) {
    const auto id = experiment["id"].get<std::string>();
    const auto shown = page.find("`" + id + "`, " + experiment["input"].get<std::string>());
    if (shown == page.end()) return 0;
    std::size_t compared = 0;
    for (const auto& measurement : experiment["measurements"]) {
        const auto method = measurement["method"].get<std::string>();
        const auto row = shown->second.find(method);
        if (row == shown->second.end()) continue;
        ++compared;
        for (const auto& [head, path, upper_path] : figure_columns) {
            const std::string what = id + ": " + method + ": " + head;
            const Value value = number_at(measurement, path);
            const auto cell = row->second.find(head);
            if (cell == row->second.end()) {
                EXPECT_TRUE(std::string(head) != "undefined" || value == 0.0) << what;
                continue;
            }
            const std::size_t dash = cell->second.find("–", 1);
            expect_number(cell->second.substr(0, dash), value, what);
            if (upper_path == nullptr) continue;
            expect_number(dash == std::string::npos
                              ? "–"
                              : cell->second.substr(dash + std::string("–").size()),
                          number_at(measurement, upper_path), what);
        }
    }
    return compared;
}

TEST(AccuracyDocument, HoldsTheStoredFiguresOfTheExperiments) {
    const Page page = numbers_of_the_page();
    std::size_t compared = 0;
    for (const auto& [id, entry] : test::FigureTable().experiments) {
        nlohmann::ordered_json experiment = {
            {"id", id}, {"input", entry.input}, {"measurements", nlohmann::json::array()}};
        for (const auto& [method, values] : entry.figures) {
            if (values.size() != 7) continue;  // It is a curve.
            nlohmann::ordered_json cost = nlohmann::ordered_json::object();
            if (values[6] > 0.0) cost["stored_bytes"] = values[6];  // Pages show 0 as a dash.
            experiment["measurements"].push_back({{"method", method},
                                                  {"error",
                                                   {{"undefined", values[1]},
                                                    {"rms", values[2]},
                                                    {"mean", values[3]},
                                                    {"p99", values[4]},
                                                    {"max", values[5]}}},
                                                  {"cost", std::move(cost)}});
        }
        const std::size_t methods = compare_with_the_page(page, experiment);
        // Long tables have the efficient methods only, whose number depends on measured times.
        EXPECT_TRUE(methods == 0 || methods >= 3) << id;
        compared += methods > 0 ? 1 : 0;
    }
    EXPECT_EQ(compared, 10U) << "an experiment of the page was not found";
}

/// Returns the commands with a recommendation in the page.
std::vector<std::string> commands_of_the_page() {
    std::vector<std::string> commands;
    for (const std::string& line : lines_of_the_page()) {
        const std::size_t end = line.find("` recommends ");
        if (line.starts_with("`relief-accuracy own ") && end != std::string::npos)
            commands.push_back(line.substr(1, end - 1));
    }
    return commands;
}

TEST_LABELS(slow);
TEST(AccuracyDocument, HoldsTheErrorsOfTheSamplesInData) {
    const Page page = numbers_of_the_page();
    const test::Workplace workplace;
    const std::vector<std::string> commands = commands_of_the_page();
    EXPECT_EQ(commands.size(), 2U);
    for (const std::string& command : commands) {
        const test::ProgramResult result = workplace.run(command + " --no-times --json");
        ASSERT_EQ(result.exit_code, 0) << command << ": " << result.error;
        const auto report = nlohmann::ordered_json::parse(result.out);
        std::size_t compared = 0;
        for (const auto& experiment : report["experiments"])
            compared += compare_with_the_page(page, experiment);
        EXPECT_GE(compared, 4U) << command;
    }
}

}  // namespace
}  // namespace relief::tools
