// SPDX-License-Identifier: Apache-2.0
/// \file
/// The dialog that selects a file: a model, a map of a material or an environment, with previews of
/// images. Tests: tests/tools/window/file_browser_test.cpp, files_window_test.cpp.
#pragma once

#include <cstddef>
#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "relief/mesh/image.h"
#include "relief/mesh/material.h"
#include "window/background_jobs.h"
#include "window/controls.h"
#include "window/input_files.h"
#include "window/window_system.h"

namespace relief::tools {

/// The use of a selected file.
struct BrowseTarget {
    enum class Kind {
        input,        ///< As if it were dropped on the window.
        map,          ///< A map of a material.
        environment,  ///< An image or a folder with six images.
    };
    Kind kind = Kind::input;
    std::size_t material = 0;
    TextureSlot slot = TextureSlot::base_color;
};

/// A request to select a file.
struct BrowseRequest {
    BrowseTarget target;
    std::string title;                                  ///< For example "Normal map of 'brick'".
    std::filesystem::path folder;                       ///< The folder that is listed first.
    std::optional<std::string> present = std::nullopt;  ///< The name of the present image.
    std::optional<Thumbnail> thumbnail = std::nullopt;  ///< Of the present image.
};

struct BrowseResult {
    BrowseTarget target;
    std::filesystem::path file;
};

/// The folder of an image name, if it is a path of an existing file; otherwise another folder.
std::filesystem::path folder_to_browse(const std::optional<std::string>& image,
                                       const std::filesystem::path& otherwise);

/// Small pictures of image files, decoded on another thread when they come into view, all in one
/// picture (Thumbnails).
class ImagePreviews {
  public:
    /// \param wake  called from another thread when there is a result
    explicit ImagePreviews(std::function<void()> wake) : job_(std::move(wake)) {}

    /// The place of the preview of a file. Nothing if it has none yet; then it will be made.
    std::optional<Thumbnails::Place> want(const std::filesystem::path& file);

    /// Starts making previews, if some are wanted. To be called once per frame.
    void update();

    /// The picture of all previews, if it has changed.
    std::optional<Image> take();

    [[nodiscard]] bool is_running() const { return job_.is_running(); }

  private:
    static constexpr std::size_t max_batch = 4;  ///< Files whose previews come together.

    struct Batch {
        std::vector<std::filesystem::path> files;
        Thumbnails::Result made;
    };
    struct Entry {
        FileStamp stamp;
        std::optional<Thumbnails::Place> place;  ///< Without a size if it cannot be decoded.
    };

    NewestJob<Batch> job_;
    std::map<std::filesystem::path, Entry> entries_;
    std::deque<std::filesystem::path> wanted_;
    std::size_t count_ = 0;  ///< Used cells of the picture.
    Image picture_;
};

class FileDialog {
  public:
    void open(BrowseRequest request);
    [[nodiscard]] bool is_open() const { return request_.has_value(); }

    /// \param recent  the files that were used last, the last one first
    /// \param texture  the texture of ImagePreviews
    /// \return the selected file; then the dialog is closed
    std::optional<BrowseResult> draw(const std::vector<std::string>& recent,
                                     ImagePreviews* previews,
                                     const shade::PictureExchange::Shown& texture);
    [[nodiscard]] const std::optional<BrowseRequest>& request() const { return request_; }

  private:
    struct Choice;
    void draw_list(const std::vector<std::string>& recent, ImagePreviews* previews,
                   const shade::PictureExchange::Shown& texture, Choice& choice);
    void draw_head(Choice& choice);

    std::optional<BrowseRequest> request_;
    FolderListing listing_;
    std::string search_;
};

/// The part of a texture that shows a thumbnail.
Thumbnail thumbnail_in(const shade::PictureExchange::Shown& texture,
                       const Thumbnails::Place& place);

}  // namespace relief::tools
