// SPDX-License-Identifier: Apache-2.0
#include "support/shared_data.h"

#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <string>

namespace relief::test {

std::filesystem::path source_directory() {
    return RELIEF_SOURCE_DIRECTORY;
}

std::filesystem::path shared_directory() {
    if (const char* named = std::getenv("RELIEF_SHARED_DATA")) return named;
    return source_directory().parent_path() / "shared";
}

TemporaryDirectory::TemporaryDirectory() {
    static std::atomic<int> counter = 0;
    path_ = std::filesystem::temp_directory_path() /
            ("relief-test-" + std::to_string(::getpid()) + "-" + std::to_string(counter++));
    std::filesystem::create_directories(path_);
}

TemporaryDirectory::~TemporaryDirectory() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

}  // namespace relief::test
