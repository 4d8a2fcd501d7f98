// SPDX-License-Identifier: Apache-2.0
#include "support/shared_data.h"

#include <unistd.h>

#include <cstdlib>
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

// A name of its own, whatever a test that was killed has left.
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
