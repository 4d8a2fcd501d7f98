// SPDX-License-Identifier: Apache-2.0
// Counts findings and formats them.
#include "relief/mesh/report.h"

#include <fmt/format.h>

#include <algorithm>

namespace relief {
namespace {

constexpr std::size_t first_limit = 8;

/// Keeps the smallest indices in ascending order, for any order of calls.
void remember(std::vector<std::size_t>& first, std::size_t index) {
    if (first.size() == first_limit && index >= first.back()) return;
    first.insert(std::upper_bound(first.begin(), first.end(), index), index);
    if (first.size() > first_limit) first.pop_back();
}

}  // namespace

Finding& Report::finding(std::string_view kind, std::string_view element,
                         std::string_view outcome) {
    const auto known = std::find_if(findings_.begin(), findings_.end(),
                                    [&](const Finding& finding) { return finding.kind == kind; });
    if (known != findings_.end()) return *known;
    return findings_.emplace_back(
        Finding{std::string(kind), std::string(element), std::string(outcome), 0, {}});
}

void Report::add(std::string_view kind, std::string_view element, std::size_t index,
                 std::string_view outcome) {
    Finding& found = finding(kind, element, outcome);
    ++found.count;
    remember(found.first, index);
}

void Report::add(const Finding& theirs) {
    Finding& ours = finding(theirs.kind, theirs.element, theirs.outcome);
    ours.count += theirs.count;
    for (const std::size_t index : theirs.first)
        remember(ours.first, index);
}

void Report::merge(const Report& other) {
    for (const Finding& theirs : other.findings_)
        add(theirs);
}

std::size_t Report::count(std::string_view kind) const {
    for (const Finding& finding : findings_) {
        if (finding.kind == kind) return finding.count;
    }
    return 0;
}

std::string to_string(const Finding& finding) {
    std::string elements;
    for (const std::size_t index : finding.first)
        elements += fmt::format("{}{}", elements.empty() ? "" : ", ", index);
    if (finding.count > finding.first.size()) elements += ", ...";
    return fmt::format("{} x {} ({} {}): {}", finding.count, finding.kind, finding.element,
                       elements, finding.outcome);
}

}  // namespace relief
