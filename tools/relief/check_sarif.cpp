// SPDX-License-Identifier: Apache-2.0
// The results as a log of SARIF 2.1.0 [OASIS SARIF 2020].
// Tests: tests/check/check_report_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string>

#include "check_report.h"
#include "common/command.h"
#include "common/text.h"

namespace relief::tools {
namespace {

constexpr const char* sarif_schema =
    "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json";
constexpr const char* rules_page = "docs/check-rules.md";

/// Returns a path as a relative or absolute reference [RFC 3986], byte by byte, so that any name
/// is kept.
std::string uri_of(const std::filesystem::path& file) {
    const std::string path = file.lexically_normal().generic_string();
    std::string uri = path.starts_with('/') ? "file://" : "";
    for (const char letter : path) {
        const auto byte = static_cast<unsigned char>(letter);
        const bool is_plain =
            byte < 128 && (std::isalnum(byte) != 0 ||
                           std::string_view("/-._~").find(letter) != std::string_view::npos);
        uri += is_plain ? std::string(1, letter) : fmt::format("%{:02X}", byte);
    }
    return uri;
}

Json rule_json(const CheckRule& rule) {
    Json json = {{"id", rule.id},
                 {"shortDescription", {{"text", fmt::format("{}.", rule.title)}}},
                 {"fullDescription",
                  {{"text", fmt::format("Usual cause: {}. Cost: {}.", rule.cause, rule.cost)}}},
                 {"defaultConfiguration", {{"level", enum_name(rule.severity)}}}};
    if (!rule.remedy.empty()) json["help"] = {{"text", fmt::format("Remedy: {}", rule.remedy)}};
    return json;
}

Json result_json(const CheckedItem& item, const CheckFinding& finding) {
    const auto rules = check_rules();
    std::string text =
        finding.place.empty() ? finding.text : fmt::format("{}: {}", finding.place, finding.text);
    const std::string remedy = remedy_text(item, finding);
    if (!remedy.empty()) text += fmt::format(" Remedy: {}", remedy);
    Json location = {{"physicalLocation", {{"artifactLocation", {{"uri", uri_of(item.file)}}}}}};
    if (!finding.place.empty())
        location["logicalLocations"] = Json::array({{{"fullyQualifiedName", finding.place}}});
    return {{"ruleId", finding.rule->id},
            {"ruleIndex", finding.rule - rules.data()},
            {"level", enum_name(finding.severity)},
            {"message", {{"text", printable(text)}}},
            {"locations", Json::array({location})},
            {"partialFingerprints",
             {{"relief/v1",
               fmt::format("{}:{}:{}", finding.rule->id, uri_of(item.file), finding.place)}}}};
}

}  // namespace

Json sarif_json(const CheckResults& results) {
    Json list = Json::array();
    for (const CheckedItem& item : results.items) {
        for (const CheckFinding& finding : item.findings)
            list.push_back(result_json(item, finding));
    }
    const Json driver = {{"name", "relief check"},
                         {"version", version()},
                         {"rules", json_list(check_rules(), rule_json)},
                         {"properties", {{"documentation", rules_page}}}};
    const Json run = {{"tool", {{"driver", driver}}},
                      {"columnKind", "utf16CodeUnits"},
                      {"results", std::move(list)}};
    return {{"$schema", sarif_schema}, {"version", "2.1.0"}, {"runs", Json::array({run})}};
}

}  // namespace relief::tools
