// SPDX-License-Identifier: Apache-2.0
/// \file
/// Comparison of the scene with a variant or another file: preparation of the other scene in the
/// background, difference images and error statistics, and the panel.
/// Tests: tests/tools/window/comparison_test.cpp.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "picture_comparison.h"
#include "relief/mesh/enum_names.h"
#include "view_options.h"
#include "window/background_jobs.h"
#include "window/viewer_state.h"

namespace relief::tools {

/// Identifies the request that two pictures were drawn for. Equal keys have equal results.
struct ComparisonKey {
    std::uint64_t revision = 0;
    std::uint64_t beside = 0;
    shade::Camera camera;
    int width = 0;
    int height = 0;
    friend bool operator==(const ComparisonKey&, const ComparisonKey&) = default;
};
ComparisonKey key_of(const DrawRequest& request);

/// The comparison of two pictures.
struct ComparisonResult {
    ComparisonKey key;
    PictureComparison comparison;
    std::shared_ptr<const Image> flip;      ///< FLIP, as a heat map.
    std::shared_ptr<const Image> absolute;  ///< Largest difference of any channel, as a heat map.
    std::string error;                      ///< If not empty, there is no result.
};

/// Draws two pictures on the drawing thread and compares them on another thread.
class ComparisonJob {
  public:
    explicit ComparisonJob(std::function<void()> wake) : comparing_(std::move(wake)) {}

    /// Starts a comparison for this request, unless one is running.
    /// \return the work for the drawing thread
    std::optional<DrawTask> begin(const DrawRequest& request);

    /// Continues when the drawing thread or the comparing thread is done.
    void follow();

    /// The last result, which may belong to an earlier request.
    [[nodiscard]] const std::optional<ComparisonResult>& numbers() const { return numbers_; }
    [[nodiscard]] bool is_running() const { return begun_.has_value(); }
    void discard();

  private:
    /// The pictures that the drawing thread has drawn.
    struct Drawn {
        std::mutex mutex;
        bool is_done = false;
        Image left;
        Image right;
        std::string error;
    };

    std::optional<ComparisonKey> begun_;
    std::shared_ptr<Drawn> drawn_;
    NewestJob<ComparisonResult> comparing_;
    std::optional<ComparisonResult> numbers_;
};

/// The view of the two sides.
enum class ComparisonView {
    both,      ///< Side by side, split by a line.
    flip,      ///< The perceived difference.
    absolute,  ///< The largest difference of any channel.
};

}  // namespace relief::tools

namespace relief {

template <>
inline constexpr auto enum_names<tools::ComparisonView> =
    std::to_array<EnumName<tools::ComparisonView>>({{"both", tools::ComparisonView::both},
                                                    {"flip", tools::ComparisonView::flip},
                                                    {"absolute", tools::ComparisonView::absolute}});

}  // namespace relief

namespace relief::tools {

/// The parts of a scene that the preparation of a variant reads.
class VariantInputs {
  public:
    VariantInputs() = default;
    explicit VariantInputs(const shade::Scene& scene);
    [[nodiscard]] bool is(const shade::Scene& scene) const;

  private:
    std::vector<shade::Shared<Mesh>::Identity> meshes_;
    std::vector<std::size_t> images_;  ///< Image indices of the materials' maps.
};

/// The comparison that the window shows.
class Comparison {
  public:
    /// \param wake  called from another thread when there is news
    Comparison(const CompareChoices& choices, const std::function<void()>& wake);

    // Actions of shortcuts and the panel.
    void choose(const Variant& variant);
    void choose(const std::filesystem::path& file);
    /// Switches the comparison on or off. The default is a comparison with flat shading.
    void toggle();
    void toggle_difference();
    void swap() { is_swapped_ = !is_swapped_; }
    void set_split(float split);
    void show(ComparisonView shown) { shown_ = shown; }
    /// Compares the current pictures once.
    void request_numbers() { has_numbers_request_ = true; }

    [[nodiscard]] bool is_on() const { return is_on_; }
    [[nodiscard]] const CompareChoices& choices() const { return choices_; }
    [[nodiscard]] float split() const { return split_; }
    [[nodiscard]] bool is_swapped() const { return is_swapped_; }
    [[nodiscard]] ComparisonView shown() const { return shown_; }
    [[nodiscard]] bool is_working() const;
    [[nodiscard]] const std::string& error() const { return error_; }
    [[nodiscard]] const std::optional<ComparisonResult>& numbers() const {
        return pictures_.numbers();
    }
    /// Names of the two sides.
    [[nodiscard]] std::string left_label() const { return label(is_swapped_); }
    [[nodiscard]] std::string right_label() const { return label(!is_swapped_); }

    /// Prepares the other side for the state's scene. To be called once per frame.
    void follow(const ViewerState& state);

    /// Adds the other side to a request, or replaces it with the difference picture.
    /// \return work for the drawing thread, if a comparison is needed
    std::optional<DrawTask> add_to(DrawRequest& request);

    [[nodiscard]] std::string command_line() const;
    [[nodiscard]] nlohmann::ordered_json json() const;

  private:
    /// The result of a preparation thread.
    struct PreparedSide {
        shade::PreparedVariant prepared;
        std::optional<shade::Scene> file;  ///< The scene of the other file, if there is no variant.
        ViewOptions options;               ///< The options of the other file.
        std::string error;
    };

    void discard();
    void begin(const ViewerState& state);
    void compose(const shade::Scene& shown, const DrawRequest& request);
    [[nodiscard]] std::string label(bool is_other) const;

    CompareChoices choices_;
    bool is_on_ = false;
    bool is_swapped_ = false;
    float split_ = default_split;
    ComparisonView shown_ = ComparisonView::both;
    bool has_numbers_request_ = false;
    std::string error_;

    NewestJob<PreparedSide> preparing_;
    std::optional<VariantInputs> read_;  ///< Empty if a preparation is needed.
    std::optional<PreparedSide> prepared_;
    std::shared_ptr<const shade::Scene> composed_;
    std::uint64_t composed_of_ = 0;  ///< Revision of the state.
    std::uint64_t composed_pose_ = 0;
    std::uint64_t revision_ = 0;
    ComparisonJob pictures_;
    std::optional<ComparisonKey> last_;  ///< Key of the last request.
};

}  // namespace relief::tools
