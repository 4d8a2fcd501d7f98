// SPDX-License-Identifier: Apache-2.0
#include "support/shared_data.h"

#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>
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
    std::string name = (std::filesystem::temp_directory_path() / "relief-test-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error(name + ": cannot be made");
    path_ = name;
}

TemporaryDirectory::~TemporaryDirectory() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

}  // namespace relief::test
