// SPDX-License-Identifier: Apache-2.0
#include "window/scene_accuracy.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "material_options.h"
#include "relief/accuracy/experiment.h"
#include "relief/mesh/height_map.h"
#include "relief/mesh/image_file.h"
#include "scene_options.h"
#include "variant_options.h"
#include "window/controls.h"
#include "window/panels.h"

namespace relief::tools {
using namespace relief::accuracy;
using namespace relief::shade;

namespace {

/// Few rounds are enough to rank the methods.
constexpr Repeats window_repeats{5, 1};

const Mesh& largest_mesh(const Scene& scene) {
    const auto larger = [](const Shared<Mesh>& a, const Shared<Mesh>& b) {
        return a->triangles.size() < b->triangles.size();
    };
    return **std::max_element(scene.meshes.begin(), scene.meshes.end(), larger);
}

/// The value of a choice, or an empty string.
std::string choice_of(const Measurement& measurement, const std::string& name) {
    for (const auto& [choice, value] : measurement.choices) {
        if (choice == name) return value;
    }
    return "";
}

/// The variant that applies a method, if there is one, for example "normals=max".
std::optional<Variant> use_of(const Measurement& one) {
    const std::string arithmetic = choice_of(one, "arithmetic");
    for (const auto& [topic, choice, as_computed] :
         {std::tuple("normals", "weighting", ""), std::tuple("tangents", "basis", ""),
          std::tuple("kernel", "kernel", "float32")}) {
        const std::string word = choice_of(one, choice);
        if (word.empty() || arithmetic != as_computed) continue;
        for (const VariantTopic& known : variant_topics()) {
            if (known.name != topic) continue;
            for (const auto& [name, variant] : known.choices) {
                if (name == word) return variant;
            }
        }
    }
    return std::nullopt;
}

double seconds_of(const Measurement& one) {
    return one.cost.all_threads ? one.cost.all_threads->spread().median
                                : std::numeric_limits<double>::infinity();
}

AccuracyTopic topic_of(AssetExperiment own) {
    AccuracyTopic topic;
    const std::vector<Measurement>& all = own.experiment.measurements;
    for (std::size_t i = 0; i < all.size(); ++i) {
        topic.uses.push_back(use_of(all[i]));
        topic.rows.push_back(i);
    }
    std::stable_sort(topic.rows.begin(), topic.rows.end(), [&](std::size_t a, std::size_t b) {
        return seconds_of(all[a]) < seconds_of(all[b]);
    });
    topic.own = std::move(own);
    return topic;
}

AccuracyResult measured(const Scene& scene, const ViewOptions& view) {
    AssetOptions options;
    options.run.is_quick = true;
    options.run.repeats = window_repeats;
    options.costs = {.one_thread = false, .all_threads = true, .memory = false};
    options.file = view.model.filename().string();
    AccuracyResult found;
    for (AssetExperiment& own : measure_asset_mesh(largest_mesh(scene), {}, options)) {
        if (own.experiment.subject == Subject::storage) continue;
        found.topics.push_back(topic_of(std::move(own)));
    }
    if (!view.height_map) return found;
    options.map_bits = {16};  // The window converts height maps with 16 bits.
    options.smooths_steps = false;
    BumpOptions bump;
    bump.strength = view.strength.value_or(bump.strength);
    options.file = view.height_map->filename().string();
    const Image height = height_field(read_image(*view.height_map, ImageUse::data));
    found.kernel = displayed_kernel(scene_heights(view));
    found.topics.push_back(topic_of(measure_asset_heights(height, bump, options)));
    return found;
}

}  // namespace

SceneAccuracy::SceneAccuracy(const std::function<void()>& wake)
    : measuring_(wake), computing_(wake) {}

void SceneAccuracy::measure(const ViewerState& state) {
    if (!state.has_scene()) return;
    result_ = {};
    measuring_.start([scene = state.shared_scene(), options = state.options()](const Progress&) {
        try {
            return measured(*scene, options);
        } catch (const Cancelled&) {
            throw;
        } catch (const std::exception& error) {
            return AccuracyResult{{}, error.what(), {}};
        }
    });
}

void SceneAccuracy::use(const Variant& variant) {
    chosen_.insert_or_assign(variant.index(), variant);
    waiting_.push_back(variant);
}

void SceneAccuracy::follow(ViewerState& state) {
    if (state.scenes() != scene_) {  // Results and jobs belong to the previous scene.
        scene_ = state.scenes();
        measuring_.cancel();
        computing_.cancel();
        result_ = {};
        waiting_.clear();
        for (const auto& [kind, variant] : chosen_)
            waiting_.push_back(variant);
    }
    if (std::optional<AccuracyResult> found = measuring_.take()) result_ = std::move(*found);
    if (const std::optional<Computed> computed = computing_.take()) {
        if (computed->error.empty()) {
            state.edit([&](Scene& scene) { scene = with_variant(scene, computed->prepared); });
        } else {
            result_.error = computed->error;
            chosen_.erase(computed->variant.index());
        }
    }
    begin_next(state);
}

void SceneAccuracy::begin_next(const ViewerState& state) {
    if (waiting_.empty() || computing_.is_running() || !state.has_scene()) return;
    const Variant next = waiting_.front();
    waiting_.erase(waiting_.begin());
    computing_.start(
        [next, scene = state.shared_scene(), options = state.options()](const Progress&) {
            Computed computed{next, {}, ""};
            Report ignored;
            try {
                computed.prepared = prepare(next, *scene, options, ignored);
            } catch (const Cancelled&) {
                throw;
            } catch (const std::exception& error) {
                computed.error = error.what();
            }
            return computed;
        });
}

bool SceneAccuracy::is_used(const Variant& variant, const ViewOptions& options) const {
    if (const Kernel* kernel = std::get_if<Kernel>(&variant))
        return (options.kernel ? options.kernel : result_.kernel) == *kernel;
    const auto chosen = chosen_.find(variant.index());
    return chosen != chosen_.end() && chosen->second == variant;
}

nlohmann::ordered_json SceneAccuracy::json(const ViewOptions& options) const {
    nlohmann::ordered_json json = {{"measuring", is_measuring()},
                                   {"working", is_working()},
                                   {"error", result_.error},
                                   {"topics", nlohmann::ordered_json::array()}};
    for (const AccuracyTopic& topic : result_.topics) {
        nlohmann::ordered_json rows = nlohmann::ordered_json::array();
        for (const std::size_t row : topic.rows) {
            const Measurement& one = topic.own.experiment.measurements[row];
            const std::optional<Variant>& use = topic.uses[row];
            rows.push_back({{"method", one.method},
                            {"rms", one.error.rms},
                            {"seconds", seconds_of(one)},
                            {"efficient", one.is_pareto_optimal},
                            {"use", use ? to_text(*use) : ""},
                            {"used", use && is_used(*use, options)}});
        }
        json["topics"].push_back({{"id", topic.own.experiment.id}, {"methods", std::move(rows)}});
    }
    return json;
}

namespace {

std::string time_text(const Measurement& one) {
    if (!one.cost.all_threads) return "-";
    return format_seconds(one.cost.all_threads->spread().median);
}

/// The method without the bit depth, which is the same for all rows. "*" marks Pareto-optimal
/// methods.
std::string name_of(const Measurement& one) {
    std::string name = one.method;
    const std::string depth = ", 16 bit";
    if (const std::size_t place = name.find(depth); place != std::string::npos)
        name.erase(place, depth.size());
    return (one.is_pareto_optimal ? "* " : "  ") + name;
}

void draw_method(const PanelInput& input, const AccuracyTopic& topic, std::size_t row,
                 PanelRequests& requests) {
    const Measurement& one = topic.own.experiment.measurements[row];
    const std::optional<Variant>& use = topic.uses[row];
    const bool is_used = use && input.accuracy->is_used(*use, input.state.options());
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    const ImGuiSelectableFlags flags =
        ImGuiSelectableFlags_SpanAllColumns | (use ? 0 : ImGuiSelectableFlags_Disabled);
    const bool is_clicked = ImGui::Selectable(name_of(one).c_str(), is_used, flags);
    if (is_clicked && use && !is_used) requests.use_method = *use;
    if (use) probe_item("method " + to_text(*use));
    if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) {
        ImGui::SetTooltip("mean %.4g, 99th percentile %.4g, maximum %.4g degrees%s%s",
                          one.error.mean, one.error.p99, one.error.max,
                          one.note.empty() ? "" : "\n", one.note.c_str());
    }
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(fmt::format("{:.3g}", one.error.rms).c_str());
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(time_text(one).c_str());
}

void draw_topic(const PanelInput& input, const AccuracyTopic& topic, PanelRequests& requests) {
    const Experiment& experiment = topic.own.experiment;
    ImGui::TextUnformatted(experiment.title.c_str());
    ImGui::SameLine();
    ImGui::TextDisabled("(?)");
    if (ImGui::IsItemHovered()) {
        ImGui::BeginTooltip();
        ImGui::PushTextWrapPos(30.0F * ImGui::GetFontSize());
        ImGui::TextUnformatted((experiment.question + "\n" + experiment.input +
                                "\n\nGround truth: " + experiment.ground_truth + "\n\n" +
                                topic.own.recommendation.description)
                                   .c_str());
        ImGui::PopTextWrapPos();
        ImGui::EndTooltip();
    }
    constexpr ImGuiTableFlags flags = ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_RowBg;
    if (!ImGui::BeginTable(experiment.id.c_str(), 3, flags)) return;
    ImGui::TableSetupColumn("method", ImGuiTableColumnFlags_WidthStretch);
    ImGui::TableSetupColumn("degrees");
    ImGui::TableSetupColumn("time");
    ImGui::TableHeadersRow();
    for (const std::size_t row : topic.rows)
        draw_method(input, topic, row, requests);
    ImGui::EndTable();
}

}  // namespace

void draw_accuracy_panel(const PanelInput& input, PanelRequests& requests) {
    if (!input.state.has_scene() || input.accuracy == nullptr) return;
    if (input.accuracy->is_measuring()) {
        draw_progress("Measuring", input.accuracy->progress());
        if (ImGui::SmallButton("Stop measuring")) requests.stop_accuracy = true;
        probe_item("Stop measuring");
        return;
    }
    if (ImGui::Button("Measure methods")) requests.measure_accuracy = true;
    probe_item("Measure methods");
    const AccuracyResult& found = input.accuracy->result();
    if (!found.error.empty()) ImGui::TextWrapped("%s", found.error.c_str());
    if (found.topics.empty()) {
        ImGui::TextWrapped(
            "Measures the error (RMS in degrees) and the time of each method for normals, tangents "
            "and slopes on this model. Click a method to apply it. * marks Pareto-optimal "
            "methods.");
        return;
    }
    for (const AccuracyTopic& topic : found.topics)
        draw_topic(input, topic, requests);
}

}  // namespace relief::tools
