// SPDX-License-Identifier: Apache-2.0
#include "window/input_files.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "common/model_file.h"
#include "common/text.h"

namespace relief::tools {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int check_time_share = 200;  // A check takes at most this fraction of the time.

/// The files whose stamps differ.
std::vector<std::filesystem::path> changed_files(const FileWatch::Files& files,
                                                 const FileWatch::Files& now) {
    std::vector<std::filesystem::path> changed;
    for (const auto& [path, stamp] : files) {
        const auto found = now.find(path);
        if (found != now.end() && found->second != stamp) changed.push_back(path);
    }
    return changed;
}

}  // namespace

FileWatch::FileWatch(std::function<void()> wake, std::chrono::milliseconds period)
    : wake_(std::move(wake)), period_(period), thread_([this] { run(); }) {}

FileWatch::~FileWatch() {
    {
        const std::lock_guard lock(mutex_);
        is_ending_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

void FileWatch::watch(Purpose purpose, Files files) {
    {
        const std::lock_guard lock(mutex_);
        const auto place = static_cast<std::size_t>(purpose);
        watched_[place] = std::move(files);
        changes_[place] = false;
    }
    changed_.notify_all();
}

FileWatch::Changes FileWatch::take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(changes_, {});
}

std::size_t FileWatch::count() const {
    const std::lock_guard lock(mutex_);
    Files all;
    for (const Files& files : watched_)
        all.insert(files.begin(), files.end());
    return all.size();
}

void FileWatch::run() {
    std::unique_lock lock(mutex_);
    while (!is_ending_) {
        const auto has_files = [&] {
            return std::any_of(watched_.begin(), watched_.end(),
                               [](const Files& files) { return !files.empty(); });
        };
        changed_.wait(lock, [&] { return is_ending_ || has_files(); });
        lock.unlock();
        const Clock::time_point begin = Clock::now();
        check();
        const Clock::duration pause =
            std::max<Clock::duration>(period_, check_time_share * (Clock::now() - begin));
        lock.lock();
        changed_.wait_for(lock, pause, [&] { return is_ending_; });
    }
}

/// Reads the stamps without the lock, because a network drive may be slow.
void FileWatch::check() {
    Files now;
    {
        const std::lock_guard lock(mutex_);
        for (const Files& files : watched_)
            now.insert(files.begin(), files.end());
    }
    for (auto& [path, stamp] : now)
        stamp = stamp_of(path);
    const auto is_stable = [&](const std::filesystem::path& path) {
        const auto before = last_stamps_.find(path);
        return before != last_stamps_.end() && before->second == now.at(path);
    };
    bool has_changes = false;
    {
        const std::lock_guard lock(mutex_);
        for (std::size_t i = 0; i < purposes; ++i) {
            const std::vector<std::filesystem::path> changed = changed_files(watched_[i], now);
            if (changed.empty() || !std::all_of(changed.begin(), changed.end(), is_stable))
                continue;
            for (const std::filesystem::path& path : changed)
                watched_[i][path] = now.at(path);
            changes_[i] = has_changes = true;
        }
    }
    last_stamps_ = std::move(now);
    if (has_changes) wake_();
}

namespace {

using Purpose = FileWatch::Purpose;

/// Returns whether a file is below $RELIEF_SHADER_DIR.
bool is_shader(const std::filesystem::path& file) {
    const char* const folder = std::getenv("RELIEF_SHADER_DIR");
    if (folder == nullptr) return false;
    std::error_code error;
    const std::filesystem::path inside =
        file.lexically_relative(std::filesystem::absolute(folder, error).lexically_normal());
    return !inside.empty() && *inside.begin() != "..";
}

}  // namespace

void WatchedFiles::follow(const Loaded& loaded) {
    if (loaded.composed) watch_.watch(Purpose::scene, loaded.files);
    watch_.watch(Purpose::attempt, loaded.composed ? FileWatch::Files{} : loaded.files);
}

void WatchedFiles::follow(const RenderedPicture& drawn) {
    if (drawn.files == followed_) return;
    followed_ = drawn.files;
    // After an error, the list of files is incomplete.
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

WatchedFiles::Changed WatchedFiles::take() {
    const FileWatch::Changes changes = watch_.take();
    const auto has = [&](Purpose purpose) { return changes[static_cast<std::size_t>(purpose)]; };
    // Stamps from before the change would be reported as another change.
    if (has(Purpose::picture)) images_.clear();
    if (has(Purpose::shaders)) shaders_.clear();
    return {has(Purpose::scene), has(Purpose::attempt), has(Purpose::picture),
            has(Purpose::shaders)};
}

namespace {

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

bool ends(const std::string& text, std::string_view ending) {
    return !ending.empty() && text.size() >= ending.size() &&
           text.compare(text.size() - ending.size(), ending.size(), ending) == 0;
}

template <std::size_t count>
bool says(const std::string& stem, const std::array<std::string_view, count>& words,
          std::string_view ending) {
    const bool has_word = std::any_of(words.begin(), words.end(), [&](std::string_view word) {
        return stem.find(word) != std::string::npos;
    });
    return has_word || ends(stem, ending);
}

/// Six files in the order +x -x +y -y +z -z, if their names follow one of three conventions.
std::vector<std::filesystem::path> faces_by_name(const std::vector<std::filesystem::path>& files) {
    using Names = std::array<std::string_view, 6>;
    for (const Names& names : {Names{"posx", "negx", "posy", "negy", "posz", "negz"},
                               Names{"px", "nx", "py", "ny", "pz", "nz"},
                               Names{"right", "left", "top", "bottom", "front", "back"}}) {
        std::vector<std::filesystem::path> faces;
        for (const std::string_view name : names) {
            const auto face = std::find_if(files.begin(), files.end(), [&](const auto& file) {
                return ends(lower(file.stem().string()), name);
            });
            if (face != files.end()) faces.push_back(*face);
        }
        if (faces.size() == names.size()) return faces;
    }
    return {};
}

/// Errors count as no folder. Reading the file reports them.
bool is_folder(const std::filesystem::path& file) {
    std::error_code error;
    return std::filesystem::is_directory(file, error);
}

bool are_images(const std::vector<std::filesystem::path>& files) {
    return std::none_of(files.begin(), files.end(), [](const auto& file) {
        return dropped_as(file) == DroppedAs::model || is_folder(file);
    });
}

void drop_one(ViewOptions& options, const std::filesystem::path& file) {
    switch (dropped_as(file)) {
        case DroppedAs::model:
            options.model = file;
            // An explicit camera position belongs to the previous model.
            if (options.camera && options.camera->place) options.camera.reset();
            break;
        case DroppedAs::height_map:
            options.height_map = file;
            options.normal_map.reset();
            std::erase(options.assumed, MapKind::height);
            break;
        case DroppedAs::normal_map:
            options.normal_map = file;
            options.height_map.reset();
            std::erase(options.assumed, MapKind::normal);
            break;
        case DroppedAs::diffuse_map:
            options.diffuse_map = file;
            std::erase(options.assumed, MapKind::color);
            break;
        case DroppedAs::environment:
            options.environment = {file};
            break;
    }
}

}  // namespace

DroppedAs dropped_as(const std::filesystem::path& file) {
    const std::string extension = extension_of(file);
    if (has_model_extension(file) || extension == ".json") return DroppedAs::model;
    if (extension == ".hdr" || is_folder(file)) return DroppedAs::environment;
    using Words = std::array<std::string_view, 3>;
    const std::string stem = lower(file.stem().string());
    if (says(stem, Words{"normal", "nrm", "norm_"}, "_n")) return DroppedAs::normal_map;
    if (says(stem, Words{"height", "bump", "disp"}, "_h")) return DroppedAs::height_map;
    if (says(stem, Words{"env", "pano", "sky"}, "")) return DroppedAs::environment;
    return DroppedAs::diffuse_map;
}

namespace {

/// Orders files by name as people do: upper and lower case do not matter.
bool comes_before(const std::filesystem::path& a, const std::filesystem::path& b) {
    const std::string lower_a = lower(a.filename().string());
    const std::string lower_b = lower(b.filename().string());
    return lower_a != lower_b ? lower_a < lower_b : a < b;
}

}  // namespace

FolderListing list_folder(const std::filesystem::path& folder, ListedFiles listed) {
    FolderListing listing;
    std::error_code error;
    listing.folder = std::filesystem::absolute(folder.empty() ? "." : folder, error);
    listing.folder = listing.folder.lexically_normal();
    if (!listing.folder.has_filename()) listing.folder = listing.folder.parent_path();
    std::filesystem::directory_iterator entry(listing.folder, error);
    for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
        const std::filesystem::path& path = entry->path();
        if (path.filename().string().starts_with('.')) continue;
        if (is_folder(path)) {
            listing.folders.push_back(path);
        } else if (has_image_extension(path) ||
                   (listed == ListedFiles::all && dropped_as(path) == DroppedAs::model)) {
            listing.files.push_back(path);
        }
    }
    if (error) listing.error = listing.folder.string() + ": " + error.message();
    std::sort(listing.folders.begin(), listing.folders.end(), comes_before);
    std::sort(listing.files.begin(), listing.files.end(), comes_before);
    const std::filesystem::path parent = listing.folder.parent_path();
    if (parent != listing.folder) listing.folders.insert(listing.folders.begin(), parent);
    return listing;
}

std::optional<std::filesystem::path> neighbor_of(const std::filesystem::path& model, bool is_next) {
    std::vector<std::filesystem::path> models = list_folder(model.parent_path()).files;
    std::erase_if(models, [](const auto& file) { return dropped_as(file) != DroppedAs::model; });
    const auto now = std::find_if(models.begin(), models.end(), [&](const auto& file) {
        return file.filename() == model.filename();
    });
    const auto count = static_cast<std::ptrdiff_t>(models.size());
    if (now == models.end() || count < 2) return std::nullopt;
    const std::ptrdiff_t step = is_next ? 1 : count - 1;
    return models[static_cast<std::size_t>((now - models.begin() + step) % count)];
}

ViewOptions with_dropped(ViewOptions options, const std::vector<std::filesystem::path>& files) {
    if (files.size() == 6 && are_images(files)) {
        options.environment = faces_by_name(files);
        if (!options.environment.empty()) return options;
        options.environment = files;
        std::sort(options.environment.begin(), options.environment.end());
        return options;
    }
    for (const std::filesystem::path& file : files)
        drop_one(options, file);
    return options;
}

}  // namespace relief::tools
