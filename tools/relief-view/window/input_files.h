// SPDX-License-Identifier: Apache-2.0
/// \file
/// Input files of the window: watching them for changes, options for dropped files, and folders.
/// Tests: tests/tools/window/input_files_test.cpp.
#pragma once

#include <array>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "relief/mesh/execution.h"
#include "view_options.h"
#include "window/background_jobs.h"

namespace relief::tools {

/// Compares the stamps of files twice per second on another thread. A change is reported once the
/// file is stable. Files that are replaced, created or removed count as changed. Files are never
/// opened.
class FileWatch {
  public:
    /// The use of a file. Changes are reported per use.
    enum class Purpose { scene, attempt, picture, shaders };
    static constexpr std::size_t purposes = 4;

    using Files = std::map<std::filesystem::path, FileStamp>;
    using Changes = std::array<bool, purposes>;  ///< Indexed by Purpose.

    /// \param wake  called from another thread when files have changed
    /// \param period  the time between two checks. It is longer if a check takes more than 1/200 of
    ///                it.
    explicit FileWatch(std::function<void()> wake,
                       std::chrono::milliseconds period = std::chrono::milliseconds(500));
    ~FileWatch();
    FileWatch(const FileWatch&) = delete;
    FileWatch& operator=(const FileWatch&) = delete;

    /// Replaces the files of this purpose. A file that differs from its stamp counts as changed.
    void watch(Purpose purpose, Files files);

    /// The purposes whose files have changed since the last call and are stable. A reported change
    /// becomes the new reference.
    Changes take();

    [[nodiscard]] std::size_t count() const;

  private:
    void run();
    void check();

    std::function<void()> wake_;
    std::chrono::milliseconds period_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::array<Files, purposes> watched_;
    Files last_stamps_;  ///< Stamps of the last check.
    Changes changes_{};
    bool is_ending_ = false;
    std::thread thread_;
};

/// Watches the files of the scene, of a failed attempt to read a scene, and of the picture: images,
/// and shaders in $RELIEF_SHADER_DIR.
class WatchedFiles {
  public:
    /// The required actions. Each change is reported once.
    struct Changed {
        bool scene = false;    ///< Read the scene again.
        bool attempt = false;  ///< Try again to read the scene that failed.
        bool picture = false;  ///< Prepare the images again.
        bool shaders = false;  ///< Link the programs again.
    };

    /// \param wake  called from another thread when files have changed
    /// \param period  the time between two checks
    explicit WatchedFiles(std::function<void()> wake,
                          std::chrono::milliseconds period = std::chrono::milliseconds(500))
        : watch_(std::move(wake), period) {}

    /// Watches the files of this scene, or additionally the files of a scene that could not be
    /// read.
    void follow(const Loaded& loaded);

    /// Watches the images and shaders of a picture.
    void follow(const RenderedPicture& drawn);

    Changed take();

    /// The number of watched files.
    [[nodiscard]] std::size_t count() const { return watch_.count(); }

  private:
    FileWatch watch_;
    std::shared_ptr<const FileWatch::Files> followed_;  ///< Files of the last picture.
    FileWatch::Files images_;  ///< Images of the pictures since the last change.
    /// Shaders since the last change. Linked programs do not read their files again.
    FileWatch::Files shaders_;
};

enum class DroppedAs { model, height_map, normal_map, diffuse_map, environment };

/// Classifies a file by its extension and name. Models and scenes have their extensions; .hdr files
/// and folders are environments. Other images are normal maps ("normal", "nrm", "_n"), height maps
/// ("height", "bump", "disp", "_h"), environments ("env", "pano", "sky") or else diffuse maps.
DroppedAs dropped_as(const std::filesystem::path& file);

/// Changes the options to show the dropped files. Each file replaces the one of its kind, and the
/// kind of a map is not assumed any more. Six
/// images are the faces of a cube, identified by the ends of their names ("posx", "px", "right",
/// ...) or else in alphabetical order.
ViewOptions with_dropped(ViewOptions options, const std::vector<std::filesystem::path>& files);

/// The files of a folder that are listed.
enum class ListedFiles {
    all,     ///< Models, scenes and images.
    images,  ///< Images only.
};

/// The folders of a folder, with its parent first, and the files that the window can show; both in
/// alphabetical order. Hidden files are left out.
struct FolderListing {
    std::filesystem::path folder;  ///< Absolute.
    std::vector<std::filesystem::path> folders;
    std::vector<std::filesystem::path> files;
    std::string error;  ///< Why the folder cannot be read; empty if it can.
};
FolderListing list_folder(const std::filesystem::path& folder,
                          ListedFiles listed = ListedFiles::all);

/// The next model or scene in the folder of this one, or the previous one; the first one follows
/// the last one. Empty if there is no other.
std::optional<std::filesystem::path> neighbor_of(const std::filesystem::path& model, bool is_next);

}  // namespace relief::tools
