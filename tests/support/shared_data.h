// SPDX-License-Identifier: Apache-2.0
/// \file
/// The folder of real models and images. They are not part of the project. Tests that need them are
/// skipped if they are missing, with a message.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

namespace relief::test {

/// The root folder of the project.
std::filesystem::path source_directory();

/// $RELIEF_SHARED_DATA, or ../shared beside the checkout.
std::filesystem::path shared_directory();

/// Returns the contents of a file, or an empty string if it cannot be read.
std::string read_bytes(const std::filesystem::path& file);

/// A new, empty folder for one test. The destructor removes it.
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

/// Defines `variable` as a path below the shared folder, or skips the test with a message.
#define RELIEF_NEEDS_SHARED(variable, relative)                                           \
    const std::filesystem::path variable = relief::test::shared_directory() / (relative); \
    if (!std::filesystem::exists(variable)) GTEST_SKIP() << "needs " << (relative)
