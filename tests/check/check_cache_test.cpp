// SPDX-License-Identifier: Apache-2.0
// A second check of unchanged files is answered from the cache.
#include "check_cache.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "check/planted_defects.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::Workplace;

class Cache : public testing::Test {
  protected:
    void SetUp() override {
        fs::create_directory(workplace / "in");
        for (int i = 0; i < 3; ++i)
            test::write_planted_model(workplace / "in", std::string(1, static_cast<char>('a' + i)),
                                      1, i);
        EXPECT_EQ(from_cache(), 0);
    }

    /// Checks again. \return the number of files from the cache
    int from_cache(const std::string& more = "") {
        const auto result =
            workplace.run("relief check in --cache out/cache.json --format json --notes" + more);
        EXPECT_EQ(result.exit_code, 0) << result.error;
        report = json::parse(result.out);
        return report["from_cache"];
    }

    Workplace workplace;
    json report;
};

TEST_F(Cache, GivesTheSameFindings) {
    const json first = report;
    EXPECT_EQ(from_cache(), 9);
    EXPECT_EQ(report["warnings"], 3);
    for (json& file : report["files"]) {
        EXPECT_EQ(file["from_cache"], true);
        file["from_cache"] = false;
    }
    EXPECT_EQ(report["files"], first["files"]);
}

// A checkout sets new times.
TEST_F(Cache, IgnoresTimes) {
    for (const auto& entry : fs::directory_iterator(workplace / "in"))
        fs::last_write_time(entry, fs::file_time_type::clock::now() - std::chrono::hours(5));
    EXPECT_EQ(from_cache(), 9);
}

TEST_F(Cache, NoticesAChangedFileOfTheSameSizeAndTime) {
    const fs::path file = workplace / "in/b.bin";
    const fs::file_time_type before = fs::last_write_time(file);
    std::fstream(file, std::ios::in | std::ios::out | std::ios::binary).put('\x01');
    fs::last_write_time(file, before);
    EXPECT_EQ(from_cache(), 8);  // The buffer of one model.
    EXPECT_EQ(from_cache(), 9);
    std::fstream(workplace / "in/a.gltf", std::ios::in | std::ios::out | std::ios::ate) << " ";
    EXPECT_EQ(from_cache(), 8);
}

TEST_F(Cache, NoticesMissingAndNewFiles) {
    fs::rename(workplace / "in/a_color.png", workplace / "kept.png");
    from_cache();
    EXPECT_EQ(report["errors"], 1);
    EXPECT_EQ(from_cache(), 8);
    EXPECT_EQ(report["errors"], 1);
    fs::rename(workplace / "kept.png", workplace / "in/a_color.png");
    from_cache();
    EXPECT_EQ(report["errors"], 0);
    EXPECT_EQ(from_cache(), 9);
}

TEST_F(Cache, NoticesOptionsAndVersions) {
    EXPECT_EQ(from_cache(" --max-memory 1G"), 0);
    EXPECT_EQ(from_cache(" --max-memory 1G"), 9);
    json cache = json::parse(workplace.read("out/cache.json"));
    cache["version"] = "0.1";
    workplace.write("out/cache.json", cache.dump());
    EXPECT_EQ(from_cache(" --max-memory 1G"), 0);
    EXPECT_EQ(from_cache(" --max-memory 1G"), 9);
}

TEST_F(Cache, IsWrittenAgainIfItIsDamaged) {
    for (const char* text :
         {"", "{", "[]", R"({"version": 1})", R"({"files": {"in/a.gltf": 3}})"}) {
        workplace.write("out/cache.json", text);
        EXPECT_EQ(from_cache(), 0) << text;
        EXPECT_EQ(from_cache(), 9) << text;
    }
    json cache = json::parse(workplace.read("out/cache.json"));
    cache["files"]["in/a.gltf"]["item"].erase("findings");
    cache["files"]["in/b.gltf"]["item"]["findings"][0]["rule"] = "mesh/none";
    workplace.write("out/cache.json", cache.dump());
    EXPECT_EQ(from_cache(), 7);
}

}  // namespace
}  // namespace relief::tools
