// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/window/followed_files_test.cpp.
#include "window/followed_files.h"

#include <algorithm>
#include <cstdlib>

namespace relief::tools {
namespace {

using Purpose = FileWatch::Purpose;

/// Whether a file is in the folder of shaders, where there is one.
bool is_shader(const std::filesystem::path& file) {
    const char* const folder = std::getenv("RELIEF_SHADER_DIR");
    if (folder == nullptr) return false;
    std::error_code error;
    const std::filesystem::path inside =
        file.lexically_relative(std::filesystem::absolute(folder, error).lexically_normal());
    return !inside.empty() && *inside.begin() != "..";
}

}  // namespace

void FollowedFiles::follow(const Loaded& loaded) {
    if (loaded.composed) watch_.watch(Purpose::scene, loaded.files);
    watch_.watch(Purpose::attempt, loaded.composed ? FileWatch::Files{} : loaded.files);
}

void FollowedFiles::follow(const DrawnPicture& drawn) {
    if (drawn.files == followed_) return;
    followed_ = drawn.files;
    // What failed was not asked for all of its files.
    if (drawn.error.empty()) images_.clear();
    bool has_shaders = false;
    for (const auto& [file, stamp] : *followed_) {
        const bool is_one = is_shader(file);
        (is_one ? shaders_ : images_).insert_or_assign(file, stamp);
        has_shaders |= is_one;
    }
    watch_.watch(Purpose::picture, images_);
    if (has_shaders) watch_.watch(Purpose::shaders, shaders_);
}

FollowedFiles::Changed FollowedFiles::take() {
    const FileWatch::Changes changes = watch_.take();
    const auto has = [&](Purpose purpose) { return changes[static_cast<std::size_t>(purpose)]; };
    // Stamps from before the change would be a change again.
    if (has(Purpose::picture)) images_.clear();
    if (has(Purpose::shaders)) shaders_.clear();
    return {has(Purpose::scene), has(Purpose::attempt), has(Purpose::picture),
            has(Purpose::shaders)};
}

}  // namespace relief::tools
