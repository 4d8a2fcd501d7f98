// SPDX-License-Identifier: Apache-2.0
/// \file
/// What the scene is compared with in the window: one change, or another file; which side is left;
/// where the line is; the difference in numbers. The changed scene is worked out on a thread of its
/// own, and anew where meshes or maps are others; edits of lights and colours come along at once.
/// Neither a window nor OpenGL. Tests: tests/tools/window/comparison_test.cpp.
#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "compare_options.h"
#include "variant_scene.h"
#include "window/side_pictures.h"
#include "window/viewer_state.h"

namespace relief::tools {

/// What is shown of two sides.
enum class SidesShown {
    both,      ///< Beside each other, split by the line.
    flip,      ///< Their difference as an eye sees it.
    absolute,  ///< Their largest difference of any channel.
};

/// What the preparation of a change has read of a scene.
class ReadOfScene {
  public:
    ReadOfScene() = default;
    explicit ReadOfScene(const Scene& scene);
    [[nodiscard]] bool is(const Scene& scene) const;

  private:
    std::vector<Shared<Mesh>::Identity> meshes_;
    std::vector<std::size_t> images_;  ///< Of the materials' maps.
};

class Comparison {
  public:
    /// \param wake  called, from another thread, when there is something new
    Comparison(const CompareChoices& choices, const std::function<void()>& wake);

    // What keys and the panel choose.
    void choose(const Variant& variant);
    void choose(const std::filesystem::path& file);
    /// On, with something to begin with where nothing was chosen; or off.
    void toggle();
    void toggle_difference();
    void swap() { is_swapped_ = !is_swapped_; }
    void set_split(float split);
    void show(SidesShown shown) { shown_ = shown; }
    /// Works the numbers out once, for what is shown now.
    void ask_for_numbers() { are_numbers_asked_ = true; }

    [[nodiscard]] bool is_on() const { return is_on_; }
    [[nodiscard]] const CompareChoices& choices() const { return choices_; }
    [[nodiscard]] float split() const { return split_; }
    [[nodiscard]] bool is_swapped() const { return is_swapped_; }
    [[nodiscard]] SidesShown shown() const { return shown_; }
    [[nodiscard]] bool is_working() const;
    [[nodiscard]] const std::string& error() const { return error_; }
    [[nodiscard]] const std::optional<SideNumbers>& numbers() const { return pictures_.numbers(); }
    /// What stands on the left, and on the right.
    [[nodiscard]] std::string left_label() const { return label(is_swapped_); }
    [[nodiscard]] std::string right_label() const { return label(!is_swapped_); }

    /// Goes on with what is to be worked out for the state's scene.
    void follow(const ViewerState& state);

    /// Puts the other side beside what is wished, or the picture of the difference in its place.
    /// \return work for the drawing thread, where numbers are wanted
    std::optional<DrawTask> add_to(DrawWish& wish);

    [[nodiscard]] std::string command_line() const;
    [[nodiscard]] nlohmann::ordered_json json() const;

  private:
    /// What another thread has worked out.
    struct Worked {
        PreparedVariant prepared;
        std::optional<Scene> file;  ///< Of the other file, in place of a change.
        ViewOptions options;        ///< That file's.
        std::string error;
    };

    void forget();
    void begin(const ViewerState& state);
    void compose(const Scene& shown, std::uint64_t revision);
    [[nodiscard]] std::string label(bool is_other) const;

    CompareChoices choices_;
    bool is_on_ = false;
    bool is_swapped_ = false;
    float split_ = usual_split;
    SidesShown shown_ = SidesShown::both;
    bool are_numbers_asked_ = false;
    std::string error_;

    NewestJob<Worked> working_;
    std::optional<ReadOfScene> read_;  ///< None: it is to be worked out.
    std::optional<Worked> worked_;
    std::shared_ptr<const Scene> composed_;
    std::uint64_t composed_of_ = 0;  ///< The state's revision.
    std::uint64_t revision_ = 0;
    SidePictures pictures_;
    std::optional<SidesKey> last_;  ///< The wish before.
};

}  // namespace relief::tools
