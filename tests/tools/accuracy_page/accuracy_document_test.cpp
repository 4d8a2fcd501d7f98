// SPDX-License-Identifier: Apache-2.0
// docs/accuracy.md says what is measured, not what once was: its errors are held to those of the
// same experiments on the same inputs. Subjects that draw pictures are left out, for their time.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>

#include "relief/accuracy/experiment.h"
#include "report/html_text.h"
#include "support/shared_data.h"

namespace relief::tools {
namespace {

/// Of each experiment, as "`normals/torus-jittered`, torus, ... 8192 triangles": RMS by method.
using Page = std::map<std::string, std::map<std::string, std::string>>;

std::string without_bold(std::string text) {
    std::erase(text, '*');
    return text;
}

Page numbers_of_the_page() {
    std::ifstream file(test::source_directory() / "docs/accuracy.md");
    Page page;
    std::map<std::string, std::string>* rows = nullptr;
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with("`")) rows = &page[line.substr(0, line.rfind("; errors in "))];
        if (rows == nullptr || !line.starts_with("| ") || line.starts_with("| |")) continue;
        std::istringstream cells(line.substr(2));
        std::string method;
        std::string rms;
        std::getline(cells, method, '|');
        std::getline(cells, rms, '|');
        (*rows)[without_bold(method.substr(0, method.size() - 1))] = rms.substr(1, rms.size() - 2);
    }
    return page;
}

TEST(AccuracyDocument, HoldsTheErrorsThatAreMeasured) {
    const Page page = numbers_of_the_page();
    RunOptions options;
    options.is_quick = true;
    options.is_timed = false;
    std::size_t compared = 0;
    for (const Subject subject : {Subject::normals, Subject::tangents}) {
        for (const Experiment& one : run_experiments(subject, options)) {
            const auto shown = page.find("`" + one.id + "`, " + one.input);
            if (shown == page.end()) continue;
            for (const Measurement& measurement : one.measurements) {
                const auto row = shown->second.find(measurement.method);
                if (row == shown->second.end()) continue;
                EXPECT_EQ(row->second, number_text(measurement.error.rms))
                    << one.id << ": " << measurement.method
                    << " (run relief-accuracy and scripts/accuracy-page again)";
                ++compared;
            }
        }
    }
    EXPECT_GE(compared, 20U) << "the page's experiments were not found";
}

}  // namespace
}  // namespace relief::tools
