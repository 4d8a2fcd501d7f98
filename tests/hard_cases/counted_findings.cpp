// SPDX-License-Identifier: Apache-2.0
#include "hard_cases/counted_findings.h"

#include <fmt/format.h>

namespace relief::test {

std::map<std::string, std::size_t> counts_of(const Report& report) {
    std::map<std::string, std::size_t> counts;
    for (const Finding& finding : report.findings())
        counts[finding.kind] = finding.count;
    return counts;
}

std::string as_text(const std::map<std::string, std::size_t>& counts) {
    std::string text;
    for (const auto& [kind, count] : counts)
        text += fmt::format("{}{} x {}", text.empty() ? "" : ", ", count, kind);
    return text.empty() ? "nothing" : text;
}

std::string reported(const std::vector<std::pair<std::string, std::size_t>>& findings) {
    std::string text;
    for (const auto& [kind, count] : findings)
        text += fmt::format("{} {} x {}", text.empty() ? "; reported:" : ",", count, kind);
    return text;
}

}  // namespace relief::test
