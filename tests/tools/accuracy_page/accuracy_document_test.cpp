// SPDX-License-Identifier: Apache-2.0
// Checks the errors in docs/accuracy.md against the same experiments. Shading is excluded, because
// its errors depend on the driver.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "relief/accuracy/experiment.h"
#include "support/labels.h"
#include "support/shared_data.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

FILE_LABELS(docs);

struct PageRow {
    std::string rms;
    std::string line;  ///< All of it.
};
/// The rows by method of each experiment, "`normals/torus-jittered`, torus, ... 8192 triangles".
using Page = std::map<std::string, std::map<std::string, PageRow>>;

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

Page numbers_of_the_page() {
    Page page;
    std::map<std::string, PageRow>* rows = nullptr;
    for (const std::string& line : lines_of_the_page()) {
        if (line.starts_with("`")) rows = &page[line.substr(0, line.rfind("; errors in "))];
        if (rows == nullptr || !line.starts_with("| ") || line.starts_with("| |")) continue;
        std::istringstream cells(line.substr(2));
        std::string method;
        std::string rms;
        std::getline(cells, method, '|');
        std::getline(cells, rms, '|');
        (*rows)[without_bold(method.substr(0, method.size() - 1))] = {rms.substr(1, rms.size() - 2),
                                                                      line};
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

class AccuracyDocumentOf : public testing::TestWithParam<Subject> {};

TEST_P(AccuracyDocumentOf, ASubjectHoldsTheErrorsThatAreMeasured) {
    const Page page = numbers_of_the_page();
    RunOptions options;
    options.is_quick = true;
    options.is_timed = false;
    std::size_t compared = 0;
    for (const Experiment& one : run_experiments(std::array{GetParam()}, options)) {
        const auto shown = page.find("`" + one.id + "`, " + one.input);
        if (shown == page.end()) continue;
        for (const Measurement& measurement : one.measurements) {
            const auto row = shown->second.find(measurement.method);
            if (row == shown->second.end()) continue;
            const std::size_t undefined = measurement.error.undefined;
            EXPECT_EQ(row->second.line.find(std::to_string(undefined) + " (") != std::string::npos,
                      undefined > 0)
                << one.id << ": " << measurement.method << " must show what has no result";
            EXPECT_NEAR(std::stod(row->second.rms), measurement.error.rms,
                        tolerance_of(row->second.rms))
                << one.id << ": " << measurement.method
                << " (run relief-accuracy and relief-documents --accuracy again)";
            ++compared;
        }
    }
    EXPECT_GE(compared, 4U) << "the page's experiment was not found";
}

INSTANTIATE_TEST_SUITE_P(All, AccuracyDocumentOf,
                         testing::Values(Subject::normals, Subject::tangents, Subject::bump,
                                         Subject::storage, Subject::compression, Subject::bake,
                                         Subject::decimation, Subject::stability),
                         [](const testing::TestParamInfo<Subject>& tested) {
                             return std::string(name_of(tested.param));
                         });

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
        for (const auto& one : report["experiments"]) {
            const auto shown = page.find("`" + one["id"].get<std::string>() + "`, " +
                                         one["input"].get<std::string>());
            ASSERT_NE(shown, page.end()) << one["id"];
            for (const auto& measurement : one["measurements"]) {
                const auto row = shown->second.find(measurement["method"].get<std::string>());
                if (row == shown->second.end()) continue;
                EXPECT_NEAR(std::stod(row->second.rms), measurement["error"]["rms"].get<double>(),
                            tolerance_of(row->second.rms))
                    << command << ": " << measurement["method"];
                ++compared;
            }
        }
        EXPECT_GE(compared, 4U) << command;
    }
}

}  // namespace
}  // namespace relief::tools
