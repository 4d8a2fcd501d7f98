// SPDX-License-Identifier: Apache-2.0
// The table of the options of `relief make`, from which the command, job files, reports and records
// derive.
#include "make_options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "make_job_file.h"
#include "make_stages.h"
#include "make_start.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using test::Workplace;
using testing::HasSubstr;

/// A value of each option that is not its default, as in a job file.
const std::map<std::string, Json>& samples() {
    static const std::map<std::string, Json> all = {{"with", {"b.ply", "c.ply"}},
                                                    {"up", "z"},
                                                    {"triangles", 321},
                                                    {"crease", "none"},
                                                    {"source-crease", "none"},
                                                    {"lods", 3},
                                                    {"no-repair", true},
                                                    {"remesh", "always"},
                                                    {"resolution", 77},
                                                    {"shell", true},
                                                    {"sign", "winding"},
                                                    {"size", "64x32"},
                                                    {"padding", 3},
                                                    {"keep-uvs", true},
                                                    {"normal-bits", 16},
                                                    {"samples", 4},
                                                    {"match", "all"},
                                                    {"occlusion-rays", 0},
                                                    {"layers", "curvature,height"},
                                                    {"for", "unreal"},
                                                    {"loss", true},
                                                    {"view", {"30,20", "0,90"}},
                                                    {"max-error", 1.5},
                                                    {"max-error-kind", "mean"},
                                                    {"max-picture-error", 0.125}};
    return all;
}

/// The options without which another one has no effect.
const std::map<std::string, std::pair<std::string, Json>>& requirements() {
    static const std::map<std::string, std::pair<std::string, Json>> all = {
        {"view", {"loss", true}}, {"max-error-kind", {"max-error", 1.0}}};
    return all;
}

/// Returns the request of a job file with one option, and those that it requires.
MakeRequest request_with(const Workplace& workplace, const std::string& name) {
    Json asset = {{"input", "in.ply"}};
    asset[name] = samples().at(name);
    const auto required = requirements().find(name);
    if (required != requirements().end()) asset[required->second.first] = required->second.second;
    workplace.write("job.json", Json({{"assets", {asset}}}).dump());
    return read_job_file(workplace / "job.json").front().request;
}

/// Returns the request of a command line.
MakeRequest parsed(const std::string& line) {
    MakeRequest request;
    CLI::App app;
    add_asset_options(app, request);
    app.parse(line);
    check_asset_options(app, request);
    return request;
}

TEST(MakeOptions, AreThoseOfTheCommandLine) {
    CLI::App app;
    MakeRequest request;
    add_asset_options(app, request);
    std::set<std::string> of_command, of_table, keys;
    for (const CLI::Option* option : app.get_options()) {
        if (option->get_name() != "--help") of_command.insert(option->get_name());
    }
    for (const MakeOption& option : make_options()) {
        of_table.insert("--" + std::string(option.name));
        EXPECT_TRUE(keys.insert(std::string(option.key)).second) << option.key;
        EXPECT_TRUE(samples().contains(std::string(option.name)))
            << option.name << " has no value in this test";
        if (!option.stage.empty()) {
            EXPECT_GE(stage_number(option.stage), 1) << option.name;
            EXPECT_LE(stage_number(option.stage), stage_number("bake")) << option.name;
        }
    }
    EXPECT_EQ(of_command, of_table);
    EXPECT_EQ(samples().size(), make_options().size());
}

TEST(MakeOptions, AreKeysOfJobFilesThatChangeTheReportAndTheRepeatingLine) {
    const Workplace workplace;
    const Json defaults = options_json({});
    for (const MakeOption& option : make_options()) {
        SCOPED_TRACE(option.name);
        const std::string name(option.name), key(option.key);
        const MakeRequest request = request_with(workplace, name);
        const Json options = options_json(request);
        EXPECT_NE(options[key], defaults[key]);
        const std::string line = options_line(request);
        EXPECT_NE(line, options_line({}));
        EXPECT_EQ(options_json(parsed(line)), options) << line;
        EXPECT_EQ(options_line(parsed(line)), line);
    }
    EXPECT_EQ(options_json(parsed(options_line({}))), defaults);
}

TEST(MakeOptions, OfAListAreTakenInItsOrder) {
    const Workplace workplace;
    EXPECT_EQ(request_with(workplace, "with").more_sources,
              (std::vector<std::filesystem::path>{workplace / "b.ply", workplace / "c.ply"}));
    const MakeRequest request = request_with(workplace, "view");
    ASSERT_EQ(request.more_views.size(), 2U);
    EXPECT_NEAR(request.more_views[1].y, 1.0F, 1e-6F);
    EXPECT_THAT(options_line(request), HasSubstr(" --view 30,20 --view 0,90"));
}

// A file of a stage is stale exactly if an option of this stage or an earlier one has changed.
TEST(MakeOptions, MakeTheFilesOfTheirStagesStale) {
    const Workplace workplace;
    std::filesystem::create_directory(workplace / "s");
    for (const char* name : {"01-repair", "03-decimate", "04-unwrap", "05-frames"})
        std::filesystem::copy(workplace / "data/vase.obj",
                              workplace / "s" / (std::string(name) + ".glb"));
    write_stage_record(workplace / "s", {}, {}, {}, {}, {});
    for (const MakeOption& option : make_options()) {
        const MakeRequest request = request_with(workplace, std::string(option.name));
        // The stage whose file is used.
        const std::vector<std::pair<std::string, std::string>> stages = {{"decimate", "repair"},
                                                                         {"unwrap", "decimate"},
                                                                         {"frames", "unwrap"},
                                                                         {"bake", "frames"}};
        for (const auto& [stage, before] : stages) {
            if (option.name == "keep-uvs" && stage == "unwrap") continue;
            SCOPED_TRACE(std::string(option.name) + ", --from " + stage);
            std::string error;
            Report report;
            try {
                read_start(read_stage_record(workplace / "s"), workplace / "s", stage, request, {},
                           glm::dvec3(0.0), report);
            } catch (const FileError& caught) {
                error = caught.what();  // The files are no glTF.
            }
            const std::string stale = "is stale: --" + std::string(option.name) + " was ";
            const bool is_before =
                !option.stage.empty() && stage_number(option.stage) <= stage_number(before);
            EXPECT_EQ(error.find(stale) != std::string::npos, is_before) << error;
        }
    }
}

}  // namespace
}  // namespace relief::tools
