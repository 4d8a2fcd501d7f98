// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/window/scene_accuracy_test.cpp.
#include "window/scene_accuracy.h"

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "material_overrides.h"
#include "relief/mesh/height_map.h"
#include "relief/mesh/image_file.h"

namespace relief::tools {
namespace {

/// A window measures in few rounds: who waits wants to see which is best, not the third digit.
constexpr Repeats few_rounds{5, 1};

const Mesh& largest_mesh(const Scene& scene) {
    const auto larger = [](const Shared<Mesh>& a, const Shared<Mesh>& b) {
        return a->triangles.size() < b->triangles.size();
    };
    return **std::max_element(scene.meshes.begin(), scene.meshes.end(), larger);
}

/// The value of a choice; empty where the method has no such.
std::string choice_of(const Measurement& measurement, const std::string& name) {
    for (const auto& [choice, value] : measurement.choices) {
        if (choice == name) return value;
    }
    return "";
}

/// What puts a method to use: "normals=max", where that is a change which the window knows.
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

AccuracyTopic topic_of(OwnExperiment own) {
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

FoundAccuracy measured(const Scene& scene, const ViewOptions& view) {
    OwnOptions options;
    options.run.is_quick = true;
    options.run.repeats = few_rounds;
    options.costs = {.one_thread = false, .all_threads = true, .memory = false};
    options.file = view.model.filename().string();
    FoundAccuracy found;
    for (OwnExperiment& own : measure_own_mesh(largest_mesh(scene), {}, options)) {
        if (own.experiment.subject == Subject::storage) continue;
        found.topics.push_back(topic_of(std::move(own)));
    }
    if (!view.height_map) return found;
    options.map_bits = {16};  // As the window makes them.
    options.smooths_steps = false;
    BumpOptions bump;
    bump.strength = view.strength.value_or(bump.strength);
    options.file = view.height_map->filename().string();
    const Image height = height_field(read_image(*view.height_map, ImageUse::data));
    found.kernel = kernel_shown(view);
    found.topics.push_back(topic_of(measure_own_heights(height, bump, options)));
    return found;
}

}  // namespace

SceneAccuracy::SceneAccuracy(const std::function<void()>& wake)
    : measuring_(wake), computing_(wake) {}

void SceneAccuracy::measure(const ViewerState& state) {
    if (!state.has_scene()) return;
    found_ = {};
    measuring_.start([scene = state.shared_scene(), options = state.options()](const Progress&) {
        try {
            return measured(*scene, options);
        } catch (const Cancelled&) {
            throw;
        } catch (const std::exception& error) {
            return FoundAccuracy{{}, error.what(), {}};
        }
    });
}

void SceneAccuracy::use(const Variant& variant) {
    chosen_.insert_or_assign(variant.index(), variant);
    waiting_.push_back(variant);
}

void SceneAccuracy::follow(ViewerState& state) {
    if (state.scenes() != scene_) {  // Another one was read: nothing is true of it yet.
        scene_ = state.scenes();
        measuring_.cancel();
        computing_.cancel();
        found_ = {};
        waiting_.clear();
        for (const auto& [kind, variant] : chosen_)
            waiting_.push_back(variant);
    }
    if (std::optional<FoundAccuracy> found = measuring_.take()) found_ = std::move(*found);
    if (const std::optional<Computed> computed = computing_.take()) {
        if (computed->error.empty()) {
            state.edit([&](Scene& scene) { scene = with(scene, computed->prepared); });
        } else {
            found_.error = computed->error;
            chosen_.erase(computed->variant.index());
        }
    }
    begin_next(state);
}

void SceneAccuracy::begin_next(const ViewerState& state) {
    if (waiting_.empty() || computing_.is_going_on() || !state.has_scene()) return;
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
        return (options.kernel ? options.kernel : found_.kernel) == *kernel;
    const auto chosen = chosen_.find(variant.index());
    return chosen != chosen_.end() && chosen->second == variant;
}

nlohmann::ordered_json SceneAccuracy::json(const ViewOptions& options) const {
    nlohmann::ordered_json json = {{"measuring", is_measuring()},
                                   {"working", is_working()},
                                   {"error", found_.error},
                                   {"topics", nlohmann::ordered_json::array()}};
    for (const AccuracyTopic& topic : found_.topics) {
        nlohmann::ordered_json rows = nlohmann::ordered_json::array();
        for (const std::size_t row : topic.rows) {
            const Measurement& one = topic.own.experiment.measurements[row];
            const std::optional<Variant>& use = topic.uses[row];
            rows.push_back({{"method", one.method},
                            {"rms", one.error.rms},
                            {"seconds", seconds_of(one)},
                            {"efficient", one.is_efficient},
                            {"use", use ? to_text(*use) : ""},
                            {"used", use && is_used(*use, options)}});
        }
        json["topics"].push_back({{"id", topic.own.experiment.id}, {"methods", std::move(rows)}});
    }
    return json;
}

}  // namespace relief::tools
