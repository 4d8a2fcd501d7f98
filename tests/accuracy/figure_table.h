// SPDX-License-Identifier: Apache-2.0
/// \file
/// The stored figures of all experiments of `relief-accuracy run all --quick` that do not draw.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "support/shared_data.h"

namespace relief::test {

/// Reads tests/accuracy/quick_figures.tsv: a line with the id and input of each experiment, and
/// below it lines of a method with count, undefined, rms, mean, p99, max and stored bytes, and of
/// "CHART: METHOD" with the errors of a curve.
struct FigureTable {
    static constexpr const char* name = "quick_figures.tsv";
    using Figures = std::map<std::string, std::vector<double>>;
    struct Entry {
        std::string input;
        Figures figures;
    };
    std::map<std::string, Entry> experiments;

    FigureTable() {
        std::ifstream file(source_directory() / "tests/accuracy" / name);
        Entry* entry = nullptr;
        for (std::string line; std::getline(file, line);) {
            std::vector<std::string> cells;
            std::istringstream text(line);
            for (std::string cell; std::getline(text, cell, '\t');)
                cells.push_back(cell);
            if (!cells.front().empty()) {
                entry = &experiments[cells.at(0)];
                entry->input = cells.at(1);
                continue;
            }
            std::vector<double>& values = entry->figures[cells.at(1)];
            for (std::size_t i = 2; i < cells.size(); ++i)
                values.push_back(std::stod(cells[i]));
        }
    }

    void write(const std::filesystem::path& path) const {
        std::ofstream file(path);
        for (const auto& [id, entry] : experiments) {
            file << id << '\t' << entry.input << '\n';
            for (const auto& [method, values] : entry.figures) {
                file << '\t' << method;
                for (const double value : values)
                    file << '\t' << fmt::format("{:.6g}", value);
                file << '\n';
            }
        }
    }
};

}  // namespace relief::test
