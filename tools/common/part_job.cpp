// SPDX-License-Identifier: Apache-2.0
#include "common/part_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <string_view>

#include "common/content_hash.h"
#include "common/options.h"

namespace relief::tools {
namespace {

/// States why two parts belong to different jobs.
std::string difference(const PartJob& a, const PartJob& b) {
    if (a.version != b.version) return "the versions of relief differ";
    if (a.count != b.count) return fmt::format("one is of {} parts, one of {}", a.count, b.count);
    if (a.files != b.files || a.arguments != b.arguments) return "the options or files differ";
    for (const auto& input : a.inputs) {
        if (std::ranges::find(b.inputs, input) == b.inputs.end())
            return fmt::format("the contents of {} differ", input.first);
    }
    return "the files that they read differ";
}

/// Names the missing parts.
void require_all(std::span<const PartName> parts, const std::vector<std::size_t>& order,
                 const std::string& word) {
    std::vector<std::string> missing;
    std::size_t next = 0;
    const std::size_t count = parts.front().job->count;
    for (std::size_t shard = 1; shard <= count; ++shard) {
        if (next < order.size() && parts[order[next]].shard == shard)
            ++next;
        else
            missing.push_back(std::to_string(shard));
    }
    if (missing.empty()) return;
    constexpr std::size_t max_named = 20;
    const std::size_t all = missing.size();
    if (all > max_named) {
        missing.resize(max_named);
        missing.push_back(fmt::format("and {} more", all - max_named));
    }
    throw failure(parts[order.front()].file,
                  fmt::format("{} of {} parts {} missing: {}", all, count, all == 1 ? "is" : "are",
                              fmt::join(missing, ", ")),
                  word + " them with --shard");
}

}  // namespace

std::string PartJob::hash() const {
    ContentHash hash;
    hash.add_text(version);
    hash.add_text(std::to_string(count));
    for (const std::vector<std::string>* list : {&arguments, &files}) {
        hash.add_text(std::to_string(list->size()));
        for (const std::string& text : *list)
            hash.add_text(text);
    }
    for (const auto& [name, content] : inputs) {
        hash.add_text(name);
        hash.add_text(content);
    }
    return hash.text();
}

std::vector<std::string> shared_options(const CLI::App& app) {
    constexpr std::array<std::string_view, 6> left_out = {
        "--shard", "--part", "--threads", "--quiet", "--max-memory", "--max-pixels"};
    std::vector<std::string> words;
    for (const GivenOption& option : given_options(app, left_out)) {
        if (option.values.empty()) words.push_back(option.name);
        for (const std::string& value : option.values)
            words.push_back(option.name + "=" + value);
    }
    return words;
}

std::vector<std::size_t> sorted_parts(std::span<const PartName> parts, const std::string& word) {
    const PartName& first = parts.front();
    if (first.job->version != version_and_commit()) {
        throw failure(first.file,
                      fmt::format("was written by relief {}, and this is {}", first.job->version,
                                  version_and_commit()),
                      "merge with the version that wrote it");
    }
    for (const PartName& part : parts) {
        if (*part.job == *first.job) continue;
        throw failure(part.file,
                      fmt::format("belongs to another {} than {}: {}", word, first.file.string(),
                                  difference(*first.job, *part.job)),
                      fmt::format("give the parts of one {}", word));
    }
    std::vector<std::size_t> order(parts.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t index) { return parts[index].shard; });
    for (std::size_t i = 1; i < order.size(); ++i) {
        const PartName& part = parts[order[i]];
        const PartName& before = parts[order[i - 1]];
        if (part.shard != before.shard) continue;
        throw failure(part.file,
                      fmt::format("is part {} of {}, as {} is", part.shard, first.job->count,
                                  before.file.string()),
                      "give each part once");
    }
    require_all(parts, order, word);
    return order;
}

}  // namespace relief::tools
