// SPDX-License-Identifier: Apache-2.0
// Printing findings. Tests: tests/tools/text_test.cpp.
#include "common/findings.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace relief::tools {

void Findings::add(const std::string& where, const Report& report) {
    for (const Finding& finding : report.findings())
        findings_.push_back({where, finding});
}

std::vector<std::string> Findings::lines(std::size_t limit) const {
    std::vector<std::string> lines;
    for (const PlacedFinding& placed : findings_) {
        if (lines.size() == limit) {
            lines.push_back(fmt::format("... and {} more", findings_.size() - limit));
            break;
        }
        const std::string prefix = placed.where.empty() ? "" : placed.where + ": ";
        lines.push_back(prefix + to_string(placed.finding));
    }
    return lines;
}

nlohmann::ordered_json Findings::json() const {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const auto& [where, finding] : findings_) {
        list.push_back({{"where", where},
                        {"kind", finding.kind},
                        {"element", finding.element},
                        {"count", finding.count},
                        {"first", finding.first},
                        {"outcome", finding.outcome}});
    }
    return list;
}

}  // namespace relief::tools
