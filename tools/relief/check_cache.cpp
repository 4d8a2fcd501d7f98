// SPDX-License-Identifier: Apache-2.0
// Tests: tests/check/check_cache_test.cpp.
#include "check_cache.h"

#include <sys/stat.h>

#include <chrono>
#include <exception>
#include <system_error>
#include <utility>

#include "common/command.h"
#include "common/content_hash.h"
#include "file_replacement.h"
#include "files.h"
#include "relief/mesh/execution.h"

namespace relief::tools {
namespace {

namespace fs = std::filesystem;

/// Changes within this time before a check may not show in the times of a file.
constexpr std::int64_t unsafe_nanoseconds = 2'000'000'000;

std::int64_t now() {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(
               std::chrono::system_clock::now().time_since_epoch())
        .count();
}

/// Returns when the content or the name of a file changed last, which programs cannot set, unlike
/// FileStamp::changed.
std::int64_t status_time(const fs::path& file) {
    struct stat facts {};
    if (::stat(file.c_str(), &facts) != 0) return 0;
    return static_cast<std::int64_t>(facts.st_ctim.tv_sec) * 1'000'000'000 + facts.st_ctim.tv_nsec;
}

Json input_json(const fs::path& file, const FileStamp& stamp) {
    const std::int64_t changed = status_time(file);
    const bool is_safe = changed < now() - unsafe_nanoseconds;
    return {{"file", file.string()},
            {"changed", is_safe ? Json(changed) : Json()},
            {"size", stamp.size},
            {"node", stamp.node},
            {"hash", file_hash(file)}};
}

bool is_unchanged(const Json& input) {
    const fs::path file = input.at("file").get<std::string>();
    const FileStamp stamp = stamp_of(file);
    if (stamp.size != input.at("size").get<std::uint64_t>()) return false;
    if (!input.at("changed").is_null() &&
        status_time(file) == input.at("changed").get<std::int64_t>() &&
        stamp.node == input.at("node").get<std::uint64_t>())
        return true;
    return file_hash(file) == input.at("hash").get<std::string>();
}

}  // namespace

CheckCache::CheckCache(fs::path file) : file_(std::move(file)) {
    std::error_code error;
    if (!fs::exists(file_, error)) return;
    try {
        Json stored = Json::parse(relief::detail::read_file(file_), nullptr, false);
        if (stored.at("version") != version_and_commit()) return;
        for (auto& [name, entry] : stored.at("files").items())
            old_.emplace(name, std::move(entry));
    } catch (const std::exception&) {
        old_.clear();  // The cache is written again.
    }
}

std::optional<CheckedItem> CheckCache::find(const fs::path& file, const std::string& key) const {
    const auto entry = old_.find(file.string());
    if (entry == old_.end()) return std::nullopt;
    try {
        if (entry->second.at("key") != key) return std::nullopt;
        for (const Json& input : entry->second.at("inputs")) {
            if (!is_unchanged(input)) return std::nullopt;
        }
        CheckedItem item = item_of(entry->second.at("item"));
        item.is_from_cache = true;
        std::error_code error;
        for (const UsedImage& image : item.images) {
            if (!fs::exists(image.file, error)) return std::nullopt;
        }
        return item;
    } catch (const std::exception&) {
        return std::nullopt;  // A damaged entry.
    }
}

void CheckCache::add(const CheckedItem& item, const std::string& key) {
    Json entry;
    if (item.is_from_cache) {
        entry = old_.at(item.file.string());
    } else {
        Json inputs = Json::array();
        for (const auto& [input, stamp] : item.inputs) {
            inputs.push_back(input_json(input, stamp));
            // It changed during the check.
            if (stamp_of(input) != stamp) return;
        }
        entry = {{"key", key}, {"inputs", std::move(inputs)}, {"item", json_of(item)}};
    }
    const std::lock_guard lock(mutex_);
    new_[item.file.string()] = std::move(entry);
}

void CheckCache::write() const {
    const Json contents = {
        {"tool", "relief check"}, {"version", version_and_commit()}, {"files", new_}};
    const std::string text = contents.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
    relief::detail::replace_file(file_, std::as_bytes(std::span(text)));
}

}  // namespace relief::tools
