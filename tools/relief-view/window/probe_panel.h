// SPDX-License-Identifier: Apache-2.0
/// \file
/// The probe of the window: explains the pixel under the pointer, or the one that a click pinned,
/// by a figure on the picture and a panel with the formula and its numbers.
/// Tests: tests/tools/window/probe_panel_test.cpp.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "probe_report.h"
#include "relief/shade/probe.h"
#include "window/background_jobs.h"

namespace relief::tools {

/// A rectangle of the window, in units of the user interface.
struct WindowArea {
    glm::vec2 min{0.0F};
    glm::vec2 max{0.0F};

    [[nodiscard]] bool contains(const glm::vec2& place) const {
        return place.x >= min.x && place.y >= min.y && place.x < max.x && place.y < max.y;
    }
};

class ProbePanel {
  public:
    /// \param wake  called from another thread when there is a result
    explicit ProbePanel(std::function<void()> wake) : wake_(std::move(wake)), job_(wake_) {}

    /// Switches the probe on or off. Off, it forgets the pinned pixel.
    void toggle();
    [[nodiscard]] bool is_on() const { return is_on_; }

    /// Pins a pixel, or, if one is pinned, follows the pointer again.
    void click(const glm::ivec2& pixel);

    /// Starts to explain the pinned pixel or that under the pointer, if something has changed since
    /// the last start. Pixels that the pointer passes while a pixel is being explained are left
    /// out.
    ///
    /// \param request  the picture at full resolution
    /// \param pointer  the pixel under the pointer, if it is on the picture
    /// \return a task that draws the shader's value of a pinned pixel
    std::optional<DrawTask> follow(const std::optional<DrawRequest>& request,
                                   const std::optional<glm::ivec2>& pointer);

    /// Returns whether a result is outstanding.
    [[nodiscard]] bool is_working() const;

    /// Draws the figure on the picture, and the panel.
    /// \param images  the small pictures of the scene's images, for footprints
    /// \return the area of the panel, which takes the pointer
    WindowArea draw(const WindowArea& picture, Thumbnails* images,
                    const shade::PictureExchange::Shown& image_texture) const;

    /// The result; null without one.
    [[nodiscard]] const ProbedPixel* result() const { return result_ ? &result_->pixel : nullptr; }

    /// {"on", "pinned", "pixel", "error", "probe"}, the last as --probe --json writes it.
    [[nodiscard]] nlohmann::ordered_json json() const;

  private:
    /// A picture that is ready to be explained.
    struct Prepared {
        DrawRequest request;
        shade::Scene scene;  ///< With the camera of the request.
        std::unique_ptr<shade::Prober> prober;
    };
    struct Result {
        std::shared_ptr<const Prepared> prepared;
        ProbedPixel pixel;
        std::string error;
    };
    /// The shader's value, which the drawing thread sets.
    struct Drawn {
        std::mutex mutex;
        bool has_ended = false;
        std::optional<PixelValues> values;
    };

    static bool is_same(const DrawRequest& a, const DrawRequest& b);
    static Result explain(std::shared_ptr<const Prepared> prepared, const DrawRequest& request,
                          const glm::ivec2& pixel);
    [[nodiscard]] DrawTask drawing_of(const DrawRequest& request, const glm::ivec2& pixel);
    void take_results();

    std::function<void()> wake_;
    NewestJob<Result> job_;
    bool is_on_ = false;
    std::optional<glm::ivec2> pinned_;
    std::optional<glm::ivec2> started_;   ///< The pixel of the last start.
    std::optional<DrawRequest> request_;  ///< Its picture.
    std::optional<Result> result_;
    std::shared_ptr<const Prepared> prepared_;  ///< Of the last result.
    std::shared_ptr<Drawn> drawn_;              ///< Of the pinned pixel.
    bool is_drawing_wanted_ = false;
};

}  // namespace relief::tools
