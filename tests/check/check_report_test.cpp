// SPDX-License-Identifier: Apache-2.0
// The formats of the results.
#include "check_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "check/planted_defects.h"
#include "support/labels.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;
using testing::Not;

/// Results with each severity, a place and names that formats must escape.
CheckResults sample() {
    CheckResults results;
    CheckedItem& model = results.items.emplace_back();
    model.file = "a b/<\"rock\">&'%,:\n.glb";
    model.model.triangles = 12;
    model.add(rule_named("mesh/repeated-triangle"), "mesh 'x<y'", "1 x repeated triangle");
    model.add(rule_named("mesh/boundary-edge"), "", "4 x boundary edge", 4);
    CheckedItem& image = results.items.emplace_back();
    image.file = "/tmp/\xC3\xA9.png";
    image.kind = CheckedKind::image;
    image.is_unreadable = true;
    image.add(rule_named("file/unreadable"), "", "is truncated");
    results.items.emplace_back().file = "sound.obj";
    return results;
}

TEST(CheckReport, JsonHasFilesAndCounts) {
    const json report = json::parse(report_text(sample(), CheckFormat::json));
    EXPECT_EQ(report["errors"], 1);
    EXPECT_EQ(report["warnings"], 1);
    EXPECT_EQ(report["notes"], 1);
    EXPECT_EQ(report["unreadable"], 1);
    EXPECT_EQ(report["files"].size(), 3U);
    EXPECT_EQ(report["files"][0]["findings"][1]["count"], 4);
    EXPECT_EQ(report["files"][0]["findings"][0]["fixable"], true);
    EXPECT_EQ(report["files"][1]["kind"], "image");
}

/// Checks that an object has only known members, and all required ones, as the schema of SARIF
/// 2.1.0 demands: it permits no others.
void expect_members(const json& object, const std::set<std::string>& required,
                    const std::set<std::string>& optional = {}) {
    ASSERT_TRUE(object.is_object()) << object.dump();
    for (const std::string& name : required)
        EXPECT_TRUE(object.contains(name)) << name << " in " << object.dump();
    for (const auto& [name, value] : object.items())
        EXPECT_TRUE(required.contains(name) || optional.contains(name)) << name;
}

void expect_message(const json& message) {
    expect_members(message, {"text"});
    EXPECT_FALSE(message["text"].get<std::string>().empty());
}

// The part of the schema of the members that relief writes.
TEST(CheckReport, SarifFollowsItsSchema) {
    const std::set<std::string> levels = {"none", "note", "warning", "error"};
    const json log = json::parse(report_text(sample(), CheckFormat::sarif));
    expect_members(log, {"version", "runs"}, {"$schema"});
    EXPECT_EQ(log["version"], "2.1.0");
    ASSERT_EQ(log["runs"].size(), 1U);
    const json& run = log["runs"][0];
    expect_members(run, {"tool"}, {"results", "columnKind"});
    EXPECT_EQ(run["columnKind"], "utf16CodeUnits");
    expect_members(run["tool"], {"driver"});
    const json& driver = run["tool"]["driver"];
    expect_members(driver, {"name"}, {"version", "rules", "properties"});
    std::set<std::string> ids;
    for (const json& rule : driver["rules"]) {
        expect_members(rule, {"id"},
                       {"shortDescription", "fullDescription", "defaultConfiguration", "help"});
        EXPECT_TRUE(ids.insert(rule["id"]).second);
        expect_message(rule["shortDescription"]);
        expect_message(rule["fullDescription"]);
        if (rule.contains("help")) expect_message(rule["help"]);
        expect_members(rule["defaultConfiguration"], {}, {"level"});
        EXPECT_TRUE(levels.contains(rule["defaultConfiguration"]["level"]));
    }
    ASSERT_EQ(run["results"].size(), 3U);
    for (const json& result : run["results"]) {
        expect_members(result, {"message"},
                       {"ruleId", "ruleIndex", "level", "locations", "partialFingerprints"});
        expect_message(result["message"]);
        EXPECT_EQ(driver["rules"][result["ruleIndex"].get<std::size_t>()]["id"], result["ruleId"]);
        EXPECT_TRUE(levels.contains(result["level"]));
        ASSERT_EQ(result["locations"].size(), 1U);
        const json& location = result["locations"][0];
        expect_members(location, {}, {"physicalLocation", "logicalLocations"});
        expect_members(location["physicalLocation"], {"artifactLocation"});
        const json& artifact = location["physicalLocation"]["artifactLocation"];
        expect_members(artifact, {"uri"});
        EXPECT_THAT(artifact["uri"].get<std::string>(),
                    testing::MatchesRegex("[A-Za-z0-9/.:_~%-]+"));
        for (const auto& [name, print] : result["partialFingerprints"].items())
            EXPECT_TRUE(print.is_string());
    }
    const auto uri = [&](std::size_t i) {
        return run["results"][i]["locations"][0]["physicalLocation"]["artifactLocation"]["uri"];
    };
    EXPECT_EQ(uri(0), "a%20b/%3C%22rock%22%3E%26%27%25%2C%3A%0A.glb");
    EXPECT_EQ(uri(2), "file:///tmp/%C3%A9.png");
    EXPECT_EQ(run["results"][0]["locations"][0]["logicalLocations"][0]["fullyQualifiedName"],
              "mesh 'x<y'");
}

TEST(CheckReport, JunitHasACaseForEachFile) {
    EXPECT_EQ(report_text(sample(), CheckFormat::junit),
              "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n"
              "<testsuite name=\"relief check\" tests=\"3\" failures=\"2\" errors=\"0\" "
              "skipped=\"0\">\n"
              "<testcase name=\"a b/&lt;&quot;rock&quot;&gt;&amp;&#39;%,:\\x0a.glb\" "
              "classname=\"relief\">\n"
              "<failure message=\"mesh &#39;x&lt;y&#39;: 1 x repeated triangle\" "
              "type=\"mesh/repeated-triangle\">\n"
              "warning: mesh &#39;x&lt;y&#39;: 1 x repeated triangle [mesh/repeated-triangle]\n"
              "</failure>\n</testcase>\n"
              "<testcase name=\"/tmp/\xC3\xA9.png\" classname=\"relief\">\n"
              "<failure message=\"is truncated\" type=\"file/unreadable\">\n"
              "error: is truncated [file/unreadable]\n</failure>\n</testcase>\n"
              "<testcase name=\"sound.obj\" classname=\"relief\"/>\n"
              "</testsuite>\n</testsuites>\n");
}

TEST(CheckReport, GithubHasAnAnnotationForEachFinding) {
    CheckResults results = sample();
    EXPECT_EQ(report_text(results, CheckFormat::github),
              "::warning file=a b/<\"rock\">&'%25%2C%3A%0A.glb,title=mesh/repeated-triangle::"
              "mesh 'x<y': 1 x repeated triangle%0A-> relief-mesh repair 'a b/<\"rock\">&'\\''%25,:"
              "%0A.glb' out.glb\n"
              "::error file=/tmp/\xC3\xA9.png,title=file/unreadable::is truncated%0A-> permit "
              "reading it, or export it again\n");
    results.shows_notes = true;
    EXPECT_THAT(report_text(results, CheckFormat::github), HasSubstr("::notice file=a b/"));
}

TEST(CheckReport, CommandsTakeNamesThatBeginWithADash) {
    CheckResults results;
    CheckedItem& item = results.items.emplace_back();
    item.file = "-x.png";
    item.kind = CheckedKind::image;
    item.add(rule_named("texture/green-down"), "", "green is down");
    EXPECT_EQ(remedy_text(item, item.findings[0]),
              "relief-bake convert ./-x.png out.png --flip green");
    item.file = "y.jpg";
    EXPECT_EQ(remedy_text(item, item.findings[0]),
              "relief-bake convert y.jpg out.png --flip green");
}

TEST_LABELS(gl);
TEST(CheckReport, PageShowsTheWorstFirst) {
    const Workplace workplace;
    std::filesystem::create_directory(workplace / "in");
    const auto plant = [&](const std::string& name, const std::string& rule) {
        for (std::size_t kind = 0; kind < test::planted_kinds().size(); ++kind) {
            if (test::planted_kinds()[kind].rule == rule)
                test::write_planted_model(workplace / "in", name, kind, 1);
        }
    };
    plant("a", "mesh/repeated-triangle");
    plant("b<c", "texture/green-down");
    const ProgramResult result = workplace.run(
        "relief check in --report out/page.html --report out/log.sarif --report out/suite.xml "
        "--report out/all.json --report out/all.txt --quiet");
    EXPECT_EQ(result.exit_code, 0) << result.error;
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(workplace.outputs(), "all.json all.txt log.sarif page.html suite.xml");
    const std::string page = workplace.read("out/page.html");
    const std::size_t first = page.find("in/b&lt;c_normal.png");
    const std::size_t second = page.find("<h2>in/a.gltf");
    ASSERT_NE(second, std::string::npos);
    EXPECT_LT(first, second);
    // A picture of the image, of the model, and of the model with notes only.
    std::size_t pictures = 0;
    for (std::size_t at = page.find("data:image/png;base64,"); at != std::string::npos;
         at = page.find("data:image/png;base64,", at + 1))
        ++pictures;
    EXPECT_EQ(pictures, 3U);
    EXPECT_THAT(page, Not(HasSubstr("{{")));
    EXPECT_THAT(page, HasSubstr("<code>texture/green-down</code></th><td>1</td>"));
}

}  // namespace
}  // namespace relief::tools
