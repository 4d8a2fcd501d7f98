// SPDX-License-Identifier: Apache-2.0
/// \file
/// Remembers checked files, so that unchanged ones are not read again.
/// Tests: tests/check/check_cache_test.cpp.
#pragma once

#include <filesystem>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "check_item.h"

namespace relief::tools {

/// The file of --cache: for each checked file its findings and figures, the options, and for all
/// files that were read the time of change, the size and the hash.
///
/// A file counts as unchanged if time and size are the same, or else if its hash is, so that a
/// checkout of a repository does not invalidate the cache. Times of the last two seconds before the
/// check do not count, because the file could have changed again within the resolution.
class CheckCache {
  public:
    /// Reads the file. One that is missing, damaged or of another version remembers nothing.
    explicit CheckCache(std::filesystem::path file);

    /// Returns what is remembered for a file if nothing has changed.
    /// \param key  the options and the uses of the file
    [[nodiscard]] std::optional<CheckedItem> find(const std::filesystem::path& file,
                                                  const std::string& key) const;

    /// Remembers a file for write(). Any thread may call it.
    void add(const CheckedItem& item, const std::string& key);

    /// Writes what was added. \throws FileError
    void write() const;

  private:
    std::filesystem::path file_;
    std::map<std::string, Json> old_;
    std::map<std::string, Json> new_;
    std::mutex mutex_;
};

}  // namespace relief::tools
