// SPDX-License-Identifier: Apache-2.0
/// \file
/// The two sides of a comparison in numbers and as pictures of their difference: drawn by the
/// drawing thread where it has nothing else to do, compared on a thread of their own.
/// Tests: tests/tools/window/compare_window_test.cpp.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "picture_comparison.h"
#include "window/draw_thread.h"
#include "window/newest_job.h"

namespace relief::tools {

/// What two pictures were drawn from: the same wish, the same numbers.
struct SidesKey {
    std::uint64_t revision = 0;
    std::uint64_t beside = 0;
    glm::mat4 world_from_view{0.0F};
    float vertical_fov = 0.0F;
    int width = 0;
    int height = 0;
    friend bool operator==(const SidesKey&, const SidesKey&) = default;
};
SidesKey key_of(const DrawWish& wish);

struct SideNumbers {
    SidesKey key;
    PictureComparison comparison;
    std::shared_ptr<const Image> flip;      ///< What an eye sees, 1 the brightest.
    std::shared_ptr<const Image> absolute;  ///< Of channels, the largest the brightest.
    std::string error;                      ///< Instead of them.
};

class SidePictures {
  public:
    explicit SidePictures(std::function<void()> wake) : comparing_(std::move(wake)) {}

    /// Begins to work out the numbers of this wish, unless that is going on. \return what the
    /// drawing thread is to do
    std::optional<DrawTask> begin(const DrawWish& wish);

    /// Goes on where one of the threads is through.
    void follow();

    /// The last numbers; not necessarily those of what is shown.
    [[nodiscard]] const std::optional<SideNumbers>& numbers() const { return numbers_; }
    [[nodiscard]] bool is_going_on() const { return begun_.has_value(); }
    void forget();

  private:
    /// What the drawing thread leaves.
    struct Drawn {
        std::mutex mutex;
        bool is_done = false;
        Image left;
        Image right;
        std::string error;
    };

    std::optional<SidesKey> begun_;
    std::shared_ptr<Drawn> drawn_;
    NewestJob<SideNumbers> comparing_;
    std::optional<SideNumbers> numbers_;
};

}  // namespace relief::tools
