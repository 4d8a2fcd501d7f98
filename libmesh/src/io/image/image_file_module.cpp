// SPDX-License-Identifier: Apache-2.0
// Finds and loads the image module, see image_file_module.h. A missing, broken or foreign module is
// a FileError that names every place looked at and the loader's own words.
// Tests: tests/mesh/io/image/image_file_test.cpp.
#include "io/image/image_file_module.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdlib>
#include <mutex>
#include <string>
#include <vector>

#include "relief/mesh/error.h"

namespace relief {
namespace {

constexpr const char* module_name = "relief_image.so";

std::vector<std::filesystem::path> candidates() {
    std::vector<std::filesystem::path> places;
    const char* named = std::getenv("RELIEF_MODULE_DIR");
    if (named != nullptr && *named != '\0') places.push_back(std::filesystem::path(named));
    std::error_code error;
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
    if (!error) places.push_back(program.parent_path().parent_path() / "lib" / "relief");
    for (std::filesystem::path& place : places)
        place /= module_name;
    return places;
}

/// The module in one place, or null and the reason appended to `reasons`.
const ImageModule* loaded_from(const std::filesystem::path& place, std::string& reasons) {
    if (std::error_code error; !std::filesystem::exists(place, error)) {
        reasons += fmt::format("; not at {}", place.string());
        return nullptr;
    }
    void* library = ::dlopen(place.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) {
        reasons += fmt::format("; {} does not load: {}", place.string(), ::dlerror());
        return nullptr;
    }
    using Entry = const ImageModule* (*)();
    const auto entry = reinterpret_cast<Entry>(::dlsym(library, image_module_entry));
    const ImageModule* module = entry == nullptr ? nullptr : entry();
    if (module != nullptr && module->version == image_module_version) return module;
    ::dlclose(library);
    reasons += fmt::format("; {} belongs to another version of relief", place.string());
    return nullptr;
}

}  // namespace

const ImageModule& image_module(const std::filesystem::path& file) {
    static std::mutex mutex;
    static const ImageModule* module = nullptr;
    const std::lock_guard lock(mutex);
    if (module != nullptr) return *module;
    std::string reasons;
    for (const std::filesystem::path& place : candidates()) {
        module = loaded_from(place, reasons);
        if (module != nullptr) return *module;
    }
    throw FileError(file, fmt::format("relief's image module {} was not found{}; set "
                                      "RELIEF_MODULE_DIR to its folder",
                                      module_name, reasons));
}

}  // namespace relief
