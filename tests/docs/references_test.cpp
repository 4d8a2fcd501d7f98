// SPDX-License-Identifier: Apache-2.0
// REFERENCES.md against the sources: whatever the code cites as [Author Year] is listed there, and
// nothing is listed that no file cites.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <string>

#include "support/shared_data.h"

#include "docs/shown_commands.h"

namespace relief::test {
namespace {

namespace fs = std::filesystem;

/// Citations in a text, each with the place that it was found in.
void collect(const std::string& text, const std::string& place,
             std::map<std::string, std::string>& citations) {
    static const std::regex citation(R"(\[[A-Z][^\[\]\n]* [12][0-9]{3}\])");
    for (std::sregex_iterator match(text.begin(), text.end(), citation), end; match != end;
         ++match) {
        citations.emplace(match->str(), place);
    }
}

std::map<std::string, std::string> cited_by_the_code() {
    std::map<std::string, std::string> citations;
    for (const char* part : {"libmesh", "libshade", "libaccuracy", "shaders", "tools", "data"}) {
        for (const auto& entry : fs::recursive_directory_iterator(source_directory() / part)) {
            const std::string kind = entry.path().extension().string();
            if (kind != ".h" && kind != ".cpp" && kind != ".glsl") continue;
            collect(contents_of(entry.path()),
                    entry.path().lexically_relative(source_directory()).string(), citations);
        }
    }
    return citations;
}

TEST(References, ListEverythingThatTheCodeCites) {
    std::map<std::string, std::string> listed;
    collect(contents_of(source_directory() / "REFERENCES.md"), "REFERENCES.md", listed);
    const std::map<std::string, std::string> cited = cited_by_the_code();
    ASSERT_GE(cited.size(), 10U) << "the code cites more than that";
    for (const auto& [citation, file] : cited) {
        EXPECT_TRUE(listed.contains(citation)) << citation << " is cited by " << file;
    }
    for (const auto& [citation, file] : listed) {
        EXPECT_TRUE(cited.contains(citation)) << citation << " is cited nowhere";
    }
}

}  // namespace
}  // namespace relief::test
