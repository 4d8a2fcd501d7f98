// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which files the picture in the window hangs on, and for what: the scene's, those of an attempt
/// to read another one that failed, images, and shaders of $RELIEF_SHADER_DIR. Tests:
/// tests/tools/window/followed_files_test.cpp.
#pragma once

#include <functional>
#include <memory>

#include "window/draw_thread.h"
#include "window/file_watch.h"
#include "window/loader.h"

namespace relief::tools {

class FollowedFiles {
  public:
    /// What is to be done; each at most once a change.
    struct Changed {
        bool scene = false;    ///< To be read anew.
        bool attempt = false;  ///< What could not be read may be readable now.
        bool picture = false;  ///< Images: to be prepared anew.
        bool shaders = false;  ///< To be linked anew.
    };

    /// \param wake    called, from another thread, when something has changed
    /// \param period  of looking (file_watch.h)
    explicit FollowedFiles(std::function<void()> wake,
                           std::chrono::milliseconds period = std::chrono::milliseconds(500))
        : watch_(std::move(wake), period) {}

    /// From now on the files of this scene, or also those of one that could not be read.
    void follow(const Loaded& loaded);

    /// The same for what is drawn.
    void follow(const DrawnPicture& drawn);

    Changed take();

    /// How many files are looked at.
    [[nodiscard]] std::size_t count() const { return watch_.count(); }

  private:
    FileWatch watch_;
    std::shared_ptr<const FileWatch::Files> followed_;  ///< Of pictures, last.
    FileWatch::Files images_;   ///< Since they changed last, for what was prepared since.
    FileWatch::Files shaders_;  ///< Likewise; of programs that are there already, nothing is read.
};

}  // namespace relief::tools
