// SPDX-License-Identifier: Apache-2.0
// Tests: tests/make/make_cache_test.cpp.
#include "make_cache.h"

#include "common/command.h"
#include "common/content_hash.h"
#include "files.h"

namespace relief::tools {
namespace {

Json hashes_of(const std::vector<std::filesystem::path>& files) {
    Json hashes = Json::object();
    for (const std::filesystem::path& file : files)
        hashes[file.string()] = file_hash(file);
    return hashes;
}

/// Returns whether files are as they were.
bool are_unchanged(const Json& hashes) {
    if (!hashes.is_object() || hashes.empty()) return false;
    for (const auto& [file, hash] : hashes.items()) {
        if (hash != file_hash(file)) return false;
    }
    return true;
}

}  // namespace

MakeCache::MakeCache(const std::filesystem::path& folder) : file_(folder / "relief-make.json") {
    if (!std::filesystem::exists(file_)) return;
    const Json stored = Json::parse(relief::detail::read_file(file_), nullptr, false);
    if (!stored.is_object() || stored.value("version", "") != version()) return;
    const auto assets = stored.find("assets");
    if (assets != stored.end() && assets->is_object()) assets_ = *assets;
}

bool MakeCache::is_current(const std::filesystem::path& asset, const std::string& options) const {
    const auto entry = assets_.find(asset.filename().string());
    if (entry == assets_.end() || !entry->is_object()) return false;
    return entry->value("options", "") == options && entry->contains("inputs") &&
           entry->contains("outputs") && are_unchanged((*entry)["outputs"]) &&
           are_unchanged((*entry)["inputs"]);
}

Json MakeCache::facts_of(const std::filesystem::path& asset) const {
    const auto entry = assets_.find(asset.filename().string());
    if (entry == assets_.end() || !entry->is_object()) return nullptr;
    return entry->value("facts", Json());
}

void MakeCache::add(const std::filesystem::path& asset, const std::string& options,
                    const std::vector<std::filesystem::path>& inputs,
                    const std::vector<std::filesystem::path>& outputs, const Json& facts) {
    assets_[asset.filename().string()] = {{"options", options},
                                          {"inputs", hashes_of(inputs)},
                                          {"outputs", hashes_of(outputs)},
                                          {"facts", facts}};
}

void MakeCache::write() const {
    write_json(file_, {{"tool", "relief make"}, {"version", version()}, {"assets", assets_}});
}

}  // namespace relief::tools
