// SPDX-License-Identifier: Apache-2.0
/// \file
/// Where real models and images lie. They are not part of the project: tests that want them are
/// skipped, with a word, on machines without.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>

namespace relief::test {

/// The project's own root folder.
std::filesystem::path source_directory();

/// $RELIEF_SHARED_DATA, or ../shared beside the checkout.
std::filesystem::path shared_directory();

/// A fresh, empty folder for one test, removed at exit.
class TemporaryDirectory {
  public:
    TemporaryDirectory();
    ~TemporaryDirectory();
    TemporaryDirectory(const TemporaryDirectory&) = delete;
    TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    [[nodiscard]] std::filesystem::path operator/(const std::filesystem::path& name) const {
        return path_ / name;
    }

  private:
    std::filesystem::path path_;
};

}  // namespace relief::test

/// Defines `variable` as a path below the shared folder, or skips the test with a word.
#define RELIEF_NEEDS_SHARED(variable, relative)                                           \
    const std::filesystem::path variable = relief::test::shared_directory() / (relative); \
    if (!std::filesystem::exists(variable)) GTEST_SKIP() << "needs " << (relative)
