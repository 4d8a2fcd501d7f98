// SPDX-License-Identifier: Apache-2.0
// The jobs of a farm, their tasks, and their lines. Tests: tests/tools/farm_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "driver.h"
#include "farm.h"
#include "files.h"
#include "json_cursor.h"

namespace relief::tools {
namespace {

using relief::detail::JsonCursor;

constexpr int max_shards = 100'000;

/// The program and the arguments of a command of relief: {"bake", "mesh", ...}.
std::vector<std::string> program_of(const std::vector<std::string>& words) {
    std::vector<std::string> program;
    if (words.front() == "bake" || words.front() == "mesh" || words.front() == "view" ||
        words.front() == "accuracy") {
        program.push_back(sibling_program("relief-" + words.front()).string());
        program.insert(program.end(), words.begin() + 1, words.end());
    } else {
        program.push_back(sibling_program("relief").string());
        program.insert(program.end(), words.begin(), words.end());
    }
    return program;
}

/// The place of the options of shards in a command, after its name; 0 if it cannot be divided.
std::size_t shard_place(const std::vector<std::string>& words) {
    const bool has_two = words.size() > 1;
    if (has_two && words[0] == "bake" && words[1] == "mesh") return 2;
    if (has_two && words[0] == "mesh" && words[1] == "process") return 2;
    return words[0] == "make" || words[0] == "check" ? 1 : 0;
}

/// Adds --threads to a command, unless it has the option.
void limit_threads(std::vector<std::string>& words, unsigned threads) {
    const auto has_threads = [](const std::string& word) {
        return word == "--threads" || word.starts_with("--threads=");
    };
    const std::size_t place = shard_place(words);
    if (place == 0 || std::ranges::any_of(words, has_threads)) return;
    words.insert(words.begin() + static_cast<std::ptrdiff_t>(place),
                 fmt::format("--threads={}", threads));
}

void add_job(const std::string& name, std::vector<std::string> words, std::size_t shards,
             unsigned threads, const std::filesystem::path& parts, std::vector<FarmTask>& merges,
             FarmJobs& jobs) {
    const std::size_t job = jobs.names.size();
    jobs.names.push_back(name);
    limit_threads(words, threads);
    if (shards == 1) {
        jobs.tasks.push_back({name, program_of(words), job, false});
        return;
    }
    const std::size_t place = shard_place(words);
    // Lists of assets need no merge.
    const bool has_parts = words[0] == "bake" || words[0] == "check";
    std::vector<std::string> merge = {"merge", fmt::format("--threads={}", threads)};
    if (words[0] == "bake") merge.insert(merge.begin(), "bake");
    for (std::size_t shard = 1; shard <= shards; ++shard) {
        std::vector<std::string> command = words;
        std::vector<std::string> options = {fmt::format("--shard={}/{}", shard, shards)};
        if (has_parts) {
            const std::string part =
                (parts / fmt::format("job-{}-{}-of-{}.part", job + 1, shard, shards)).string();
            options.push_back("--part=" + part);
            merge.push_back(part);
        }
        command.insert(command.begin() + static_cast<std::ptrdiff_t>(place), options.begin(),
                       options.end());
        jobs.tasks.push_back(
            {fmt::format("{} {}/{}", name, shard, shards), program_of(command), job, false});
    }
    if (has_parts) merges.push_back({name + " merge", program_of(merge), job, true});
}

void read_job(const JsonCursor& json, std::optional<std::size_t> shards, unsigned threads,
              const std::filesystem::path& parts, std::vector<FarmTask>& merges, FarmJobs& jobs) {
    json.allow({"name", "command", "shards"});
    std::vector<std::string> words;
    for (const JsonCursor& word : json.at("command").elements()) {
        words.push_back(word.text());
        if (words.back().find('\0') != std::string::npos) word.fail("has a zero byte");
    }
    if (words.empty()) json.at("command").fail("is empty");
    if (words.front() == "farm" || words.front().starts_with('-'))
        json.at("command").fail("must begin with a command of relief");
    const bool can_be_divided = shard_place(words) > 0;
    std::size_t count = can_be_divided ? shards.value_or(1) : 1;
    if (const auto given = json.find("shards")) {
        count = static_cast<std::size_t>(given->whole_number(1, max_shards));
        if (count > 1 && !can_be_divided)
            given->fail("only bake mesh, check, make and mesh process can be divided");
    }
    const auto name = json.find("name");
    add_job(name ? name->text() : fmt::format("job {}", jobs.names.size() + 1), words, count,
            threads, parts, merges, jobs);
}

}  // namespace

FarmJobs read_farm_jobs(const std::filesystem::path& file, std::optional<std::size_t> shards,
                        const std::filesystem::path& parts, unsigned threads) {
    FarmJobs jobs;
    std::vector<FarmTask> merges;
    const std::string text = relief::detail::read_file(file);
    about(file, [&] {
        const JsonCursor root = JsonCursor::parse(text);
        if (root.is_object() && root.find("assets")) {
            const std::size_t assets = root.at("assets").elements().size();
            const std::vector<std::string> words = {
                "make", "--job=" + std::filesystem::absolute(file).string()};
            add_job(file.stem().string(), words,
                    std::max<std::size_t>(std::min(shards.value_or(assets), assets), 1), threads,
                    parts, merges, jobs);
            return;
        }
        root.allow({"jobs"});
        for (const JsonCursor& job : root.at("jobs").elements())
            read_job(job, shards, threads, parts, merges, jobs);
        if (jobs.tasks.empty()) root.at("jobs").fail("is empty");
    });
    jobs.tasks.insert(jobs.tasks.end(), merges.begin(), merges.end());
    return jobs;
}

std::string shell_word(const std::string& word) {
    const bool has_control = std::ranges::any_of(word, [](char letter) {
        return static_cast<unsigned char>(letter) < 0x20 || letter == 0x7f;
    });
    if (has_control) {
        std::string quoted = "$'";
        for (const char letter : word) {
            const auto code = static_cast<unsigned char>(letter);
            if (code < 0x20 || code == 0x7f)
                quoted += fmt::format("\\{:03o}", code);
            else if (letter == '\'' || letter == '\\')
                quoted += fmt::format("\\{}", letter);
            else
                quoted += letter;
        }
        return quoted + "'";
    }
    const bool is_plain = !word.empty() && std::ranges::all_of(word, [](char letter) {
        return (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') ||
               (letter >= '0' && letter <= '9') ||
               std::string_view("/._-+:,=").find(letter) != std::string_view::npos;
    });
    if (is_plain) return word;
    std::string quoted = "'";
    for (const char letter : word) {
        if (letter == '\'')
            quoted += "'\\''";
        else
            quoted += letter;
    }
    return quoted + "'";
}

std::string shell_line(const std::vector<std::string>& words) {
    std::string line;
    for (const std::string& word : words)
        line += (line.empty() ? "" : " ") + shell_word(word);
    return line;
}

}  // namespace relief::tools
