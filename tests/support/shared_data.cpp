// SPDX-License-Identifier: Apache-2.0
#include "support/shared_data.h"

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <random>
#include <string>

namespace relief::test {

std::filesystem::path source_directory() {
    return RELIEF_SOURCE_DIRECTORY;
}

std::filesystem::path shared_directory() {
    if (const char* named = std::getenv("RELIEF_SHARED_DATA")) return named;
    return source_directory().parent_path() / "shared";
}

std::string read_bytes(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

// The name is unique, even if a killed test left its folder behind.
TemporaryDirectory::TemporaryDirectory() {
    std::random_device random;
    do {
        path_ =
            std::filesystem::temp_directory_path() / ("relief-test-" + std::to_string(random()));
    } while (!std::filesystem::create_directory(path_));
}

TemporaryDirectory::~TemporaryDirectory() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

}  // namespace relief::test
