// SPDX-License-Identifier: Apache-2.0
// Two reports' differences as JSON; docs/accuracy-schema.md describes it.
// Tests: tests/tools/accuracy_compare_test.cpp.
#include <cmath>
#include <nlohmann/json.hpp>

#include "common/command.h"
#include "compare/comparison_text.h"

namespace relief::tools {
namespace {

using Json = nlohmann::ordered_json;

const char* word_of(TimeVerdict verdict) {
    switch (verdict) {
        case TimeVerdict::slower:
            return "slower";
        case TimeVerdict::faster:
            return "faster";
        case TimeVerdict::cannot_tell:
            return "cannot tell";
        case TimeVerdict::unchanged:
            break;
    }
    return "unchanged";
}

Json json_of(const CommonChange& common) {
    if (common.methods == 0) return {};
    return {{"methods", common.methods},
            {"ratio", common.ratio},
            {"lower_quartile", common.lower_quartile},
            {"upper_quartile", common.upper_quartile},
            {"resolution", common.resolution},  // Infinite is null.
            {"judged", common.is_judged},
            {"verdict", word_of(common.verdict)}};
}

Json json_of(const TimeChange& change) {
    return {{"experiment", change.experiment},
            {"method", change.method},
            {"threads", change.on_all_threads ? "all" : "one"},
            {"before", change.before},
            {"after", change.after},
            {"ratio", change.ratio},
            {"relative", change.relative},
            {"counted", change.counted},
            {"resolution", change.resolution},  // Infinite is null.
            {"verdict", word_of(change.verdict)}};
}

Json json_of(const ErrorChange& change) {
    Json figures = Json::array();
    for (const FigureChange& one : change.figures) {
        figures.push_back({{"figure", one.figure},
                           {"before", one.before},
                           {"after", one.after},
                           {"growth", one.growth()}});  // Endless is null.
    }
    return {{"experiment", change.experiment},
            {"chart", change.chart},
            {"method", change.method},
            {"figures", figures}};
}

Json json_of(const MemoryChange& change) {
    return {{"experiment", change.experiment},
            {"method", change.method},
            {"before", change.before},
            {"after", change.after},
            {"growth", change.growth()}};  // Endless is null.
}

template <typename Change>
Json array_of(const std::vector<Change>& changes) {
    Json array = Json::array();
    for (const Change& change : changes)
        array.push_back(json_of(change));
    return array;
}

Json json_of(const std::optional<double>& bound) {
    return bound ? Json(*bound) : Json();
}

}  // namespace

Json json_of(const ComparedReports& compared, const ComparisonBounds& bounds) {
    const ReportComparison& found = compared.found;
    return {{"tool", "relief-accuracy compare"},
            {"version", version()},
            {"old", compared.before.command},
            {"new", compared.after.command},
            {"same_machine", compared.same_machine},
            {"machine", difference_of(compared.before, compared.after)},
            {"methods", found.methods},
            {"gone", found.gone},
            {"added", found.added},
            {"other_input", found.other_input},
            {"one_thread", json_of(found.one_thread)},
            {"all_threads", json_of(found.all_threads)},
            {"times", array_of(found.times)},
            {"with_memory", found.with_memory},
            {"memory", array_of(found.memory)},
            {"errors", array_of(found.errors)},
            {"max_slower", json_of(bounds.max_slower)},
            {"max_error_growth", json_of(bounds.max_error_growth)},
            {"max_memory_growth", json_of(bounds.max_memory_growth)},
            {"beyond", beyond(compared, bounds)}};
}

}  // namespace relief::tools
