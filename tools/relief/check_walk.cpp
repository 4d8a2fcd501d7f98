// SPDX-License-Identifier: Apache-2.0
// Tests: tests/check/check_walk_test.cpp.
#include "check_walk.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

#include "common/command.h"
#include "common/file_jobs.h"
#include "common/model_file.h"
#include "common/text.h"
#include "texture_names.h"

namespace relief::tools {
namespace {

namespace fs = std::filesystem;

/// Collects the files of folders.
class Walk {
  public:
    explicit Walk(const std::function<bool(const fs::path&)>& excludes) : excludes_(excludes) {}

    void add_given(const fs::path& path) {
        std::error_code error;
        if (fs::is_directory(path, error)) return add_folder(path);
        const auto kind = kind_by_name(path);
        if (!kind) {
            throw UsageError(
                fmt::format("{}: is neither a folder nor a model or an image", path.string()),
                "give folders, or files such as .glb, .gltf, .obj, .ply, .stl, .off, .png");
        }
        add_file(path, *kind);
    }

    WalkedFiles result;

  private:
    void add_file(const fs::path& file, CheckedKind kind) {
        if (excludes_(file)) return;
        if (known_.insert(file.lexically_normal()).second) result.files.push_back({file, kind, {}});
    }

    void add_finding(const fs::path& path, const char* rule, const std::string& text) {
        CheckedItem item;
        item.file = path;
        item.kind = CheckedKind::folder;
        item.is_unreadable = std::string_view(rule) == "folder/unreadable";
        item.add(rule_named(rule), "", text);
        result.findings.push_back(std::move(item));
    }

    void add_folder(const fs::path& folder) {
        std::error_code error;
        std::vector<fs::path> entries;
        for (fs::directory_iterator it(folder, error), end; !error && it != end;
             it.increment(error))
            entries.push_back(it->path());
        if (error) add_finding(folder, "folder/unreadable", error.message());
        std::ranges::sort(entries);
        for (const fs::path& entry : entries)
            add_entry(entry);
    }

    void add_entry(const fs::path& entry) {
        std::error_code ignored;
        const bool is_folder = fs::is_directory(entry, ignored);
        if (!is_folder) {
            const auto kind = kind_by_name(entry);
            if (kind) add_file(entry, *kind);
            return;
        }
        if (excludes_(entry) || entry.filename().string().starts_with('.')) return;
        if (fs::is_symlink(fs::symlink_status(entry, ignored)))
            add_finding(entry, "file/folder-link", "is a link to a folder, which is not followed");
        else
            add_folder(entry);
    }

    const std::function<bool(const fs::path&)>& excludes_;
    std::set<fs::path> known_;
};

/// The slot of a map that is known by its name.
std::optional<TextureSlot> slot_of(MapKind kind) {
    switch (kind) {
        case MapKind::normal:
            return TextureSlot::normal;
        case MapKind::height:
            return TextureSlot::bump;
        case MapKind::color:
            return TextureSlot::base_color;
        case MapKind::occlusion:
            return TextureSlot::occlusion;
        case MapKind::emission:
            return TextureSlot::emission;
        case MapKind::roughness:
        case MapKind::metalness:
        case MapKind::packed:
            return TextureSlot::metallic_roughness;
        default:
            return std::nullopt;
    }
}

/// Pairs mesh files with the images beside them. Documents of glTF name their images themselves.
void pair_by_name(std::vector<CheckInput>& files) {
    using Key = std::pair<fs::path, std::string>;
    std::multimap<Key, UsedImage> images;
    for (const CheckInput& input : files) {
        if (input.kind != CheckedKind::image) continue;
        const NamedMap named = named_map(input.file.stem().string());
        const auto slot = named.kind ? slot_of(*named.kind) : std::nullopt;
        if (!slot) continue;
        images.emplace(Key{input.file.parent_path(), in_lower_case(named.set)},
                       UsedImage{input.file, {*slot, false, "", {}}});
    }
    for (CheckInput& input : files) {
        const std::string extension = extension_of(input.file);
        if (input.kind != CheckedKind::model || extension == ".glb" || extension == ".gltf")
            continue;
        const auto [begin, end] = images.equal_range(
            {input.file.parent_path(), in_lower_case(input.file.stem().string())});
        for (auto it = begin; it != end; ++it)
            input.paired.push_back(it->second);
    }
}

}  // namespace

std::optional<CheckedKind> kind_by_name(const fs::path& file) {
    if (has_model_extension(file)) return CheckedKind::model;
    if (has_image_extension(file)) return CheckedKind::image;
    return std::nullopt;
}

WalkedFiles walk_files(const std::vector<fs::path>& given,
                       const std::function<bool(const fs::path&)>& excludes) {
    Walk walk(excludes);
    for (const fs::path& path : given)
        walk.add_given(path);
    pair_by_name(walk.result.files);
    return std::move(walk.result);
}

bool matches_pattern(std::string_view path, std::string_view pattern) {
    if (pattern.find('/') == pattern.npos && path.find('/') != path.npos)
        return matches_pattern(path.substr(path.rfind('/') + 1), pattern);
    // The lengths of the parts of the path that fit the pattern so far.
    std::vector<bool> fits(path.size() + 1, false);
    fits[0] = true;
    while (!pattern.empty()) {
        const bool is_star = pattern[0] == '*';
        const bool crosses = pattern.starts_with("**");
        const bool is_folders = pattern.starts_with("**/");  // Also none.
        std::vector<bool> next(path.size() + 1, false);
        bool is_open = false;
        for (std::size_t i = 0; i <= path.size(); ++i) {
            const char before = i == 0 ? '/' : path[i - 1];
            if (is_star) {
                is_open = (is_open && (crosses || before != '/')) || fits[i];
                next[i] = is_folders ? fits[i] || (is_open && before == '/') : is_open;
            } else {
                next[i] = i > 0 && fits[i - 1] &&
                          (pattern[0] == before || (pattern[0] == '?' && before != '/'));
            }
        }
        fits = std::move(next);
        pattern.remove_prefix(is_folders ? 3 : crosses ? 2 : 1);
    }
    return fits.back();
}

}  // namespace relief::tools
