// SPDX-License-Identifier: Apache-2.0
// Tests: tests/check/check_fix_test.cpp.
#include "check_fix.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "common/command.h"
#include "common/options.h"
#include "driver.h"
#include "run_program.h"

namespace relief::tools {
namespace {

namespace fs = std::filesystem;

/// Returns the words of a remedy with the names of the files.
std::vector<std::string> words_of(std::string_view remedy, const fs::path& input,
                                  const fs::path& output) {
    std::vector<std::string> words = split(remedy, ' ');
    for (std::string& word : words) {
        if (word == "IN") word = as_argument(input).string();
        if (word == "OUT") word = as_argument(output).string();
    }
    words.emplace_back("--quiet");
    return words;
}

/// Runs a tool of relief. \return its first message, or a reason; empty if it succeeded
std::string run(std::vector<std::string> words) {
    const std::string tool = words.front();
    words.front() = sibling_program(tool).string();
    const ProgramOutput output = run_program(words, CapturedStream::errors);
    if (output.exit_code == 0) return "";
    if (output.exit_code == 127) return fmt::format("{}: {}", tool, output.text);
    const std::string line = output.text.substr(0, output.text.find('\n'));
    return line.empty() ? tool + " failed" : line;
}

/// Returns the remedies of a file, repairs of triangles first: they change normals and tangents.
std::vector<std::string_view> remedies_of(const CheckedItem& item) {
    const auto rank = [](std::string_view remedy) {
        return std::pair(!remedy.starts_with("relief-mesh repair"), remedy);
    };
    std::vector<std::string_view> remedies;
    for (const CheckFinding& finding : item.findings) {
        const std::string_view remedy = finding.rule->remedy;
        const bool is_new = std::ranges::find(remedies, remedy) == remedies.end();
        if (finding.is_fixable && finding.severity >= CheckSeverity::warning && is_new)
            remedies.push_back(remedy);
    }
    std::ranges::sort(remedies, {}, rank);
    return remedies;
}

/// Returns the name of a copy: that of the file, without what leads out of the folder.
fs::path copy_of(const fs::path& file, const fs::path& folder) {
    fs::path inside;
    for (const fs::path& part : file.lexically_normal().relative_path()) {
        if (part != "..") inside /= part;
    }
    return folder / inside;
}

/// Runs the remedies one after another on the output of the one before.
CheckFix fix(const CheckedItem& item, const std::optional<fs::path>& folder) {
    CheckFix done{item.file, folder ? copy_of(item.file, *folder) : item.file, "", ""};
    try {
        if (folder) make_folder(done.output.parent_path());
    } catch (const Error& error) {
        done.error = error.what();
        return done;
    }
    fs::path input = item.file;
    for (const std::string_view remedy : remedies_of(item)) {
        if (!done.command.empty()) done.command += "; ";
        done.command += remedy;
        done.error = run(words_of(remedy, input, done.output));
        if (!done.error.empty()) return done;
        input = done.output;
    }
    return done;
}

}  // namespace

std::vector<CheckFix> fix_files(const std::vector<CheckedItem>& items,
                                const std::optional<fs::path>& folder) {
    std::vector<CheckFix> fixes;
    for (const CheckedItem& item : items) {
        if (!remedies_of(item).empty()) fixes.push_back(fix(item, folder));
    }
    return fixes;
}

}  // namespace relief::tools
