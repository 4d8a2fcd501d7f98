// SPDX-License-Identifier: Apache-2.0
#include "window/comparison.h"

#include <imgui.h>

#include <algorithm>
#include <array>

#include "relief/mesh/image.h"
#include "variant_options.h"
#include "window/controls.h"
#include "window/panels.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

Image drawn_image(const Context& context, RenderCache& cache, const Scene& scene,
                  const Camera& camera, const DrawRequest& request) {
    Report unused;  // The window has already shown these findings.
    Renderer renderer(cache, context, scene, forced_plan(scene, request.settings, request.effects),
                      request.settings, unused);
    return renderer.draw(camera).image;
}

ComparisonResult numbers_of(const ComparisonKey& key, const Image& left, const Image& right) {
    ComparisonResult numbers;
    numbers.key = key;
    try {
        numbers.comparison = compare_pictures(left, right);
        const Image apart = largest_differences(left, right);
        const auto values = apart.as<float>();
        const float largest = *std::max_element(values.begin(), values.end());
        numbers.absolute = std::make_shared<const Image>(
            false_color_image(apart, largest > 0.0F ? largest : 1.0F));
        numbers.flip =
            std::make_shared<const Image>(false_color_image(numbers.comparison.flip.map, 1.0));
    } catch (const std::exception& error) {
        numbers.error = error.what();
    }
    return numbers;
}

}  // namespace

ComparisonKey key_of(const DrawRequest& request) {
    return {request.revision, request.beside ? request.beside->revision : 0, request.camera,
            request.settings.width, request.settings.height};
}

std::optional<DrawTask> ComparisonJob::begin(const DrawRequest& request) {
    if (begun_ || !request.beside) return std::nullopt;
    begun_ = key_of(request);
    drawn_ = std::make_shared<Drawn>();
    return [request, drawn = drawn_](const Context& context, RenderCache& cache) {
        Image left, right;
        std::string error;
        try {
            left = drawn_image(context, cache, *request.scene, request.camera, request);
            right = drawn_image(context, cache, *request.beside->scene, request.beside->camera,
                                request);
        } catch (const std::exception& thrown) {
            error = thrown.what();
        }
        const std::lock_guard lock(drawn->mutex);
        drawn->left = std::move(left);
        drawn->right = std::move(right);
        drawn->error = std::move(error);
        drawn->is_done = true;
        return false;
    };
}

void ComparisonJob::follow() {
    if (drawn_) {
        const std::lock_guard lock(drawn_->mutex);
        if (drawn_->is_done) {
            comparing_.start([key = *begun_, drawn = drawn_](const Progress&) {
                const std::lock_guard none_else(drawn->mutex);
                if (drawn->error.empty()) return numbers_of(key, drawn->left, drawn->right);
                ComparisonResult failed;
                failed.key = key;
                failed.error = drawn->error;
                return failed;
            });
        }
    }
    if (drawn_ && comparing_.is_running()) drawn_.reset();
    if (std::optional<ComparisonResult> numbers = comparing_.take()) {
        numbers_ = std::move(numbers);
        begun_.reset();
    }
}

void ComparisonJob::discard() {
    numbers_.reset();
    drawn_.reset();
    begun_.reset();
    comparing_.cancel();
}

namespace {

constexpr float min_split = 0.02F;  // Closer to the edge, the line could not be dragged.

std::vector<std::size_t> map_images(const Scene& scene) {
    constexpr auto none = static_cast<std::size_t>(-1);
    std::vector<std::size_t> images;
    for (const Material& material : scene.materials) {
        images.push_back(material.normal_map ? material.normal_map->texture.image : none);
        images.push_back(material.bump_map ? material.bump_map->texture.image : none);
    }
    return images;
}

nlohmann::ordered_json json_of(const std::optional<ComparisonResult>& numbers) {
    if (!numbers || !numbers->error.empty()) return nullptr;
    return numbers_json(numbers->comparison);
}

}  // namespace

VariantInputs::VariantInputs(const Scene& scene) : images_(map_images(scene)) {
    for (const Shared<Mesh>& mesh : scene.meshes)
        meshes_.push_back(mesh.identity());
}

bool VariantInputs::is(const Scene& scene) const {
    return meshes_.size() == scene.meshes.size() && images_ == map_images(scene) &&
           std::equal(meshes_.begin(), meshes_.end(), scene.meshes.begin(),
                      [](const auto& identity, const auto& mesh) { return identity.is(mesh); });
}

Comparison::Comparison(const CompareChoices& choices, const std::function<void()>& wake)
    : choices_(choices), is_on_(choices.compares()), preparing_(wake), pictures_(wake) {
    set_split(choices.split.value_or(default_split));
}

void Comparison::choose(const Variant& variant) {
    choices_.variant = variant;
    choices_.file.reset();
    discard();
    is_on_ = true;
}

void Comparison::choose(const std::filesystem::path& file) {
    choices_.file = file;
    choices_.variant.reset();
    discard();
    is_on_ = true;
}

void Comparison::toggle() {
    if (!choices_.compares()) return choose(Variant(Interpolation::flat));
    is_on_ = !is_on_;
}

void Comparison::toggle_difference() {
    shown_ = shown_ == ComparisonView::both ? ComparisonView::flip : ComparisonView::both;
}

void Comparison::set_split(float split) {
    split_ = std::clamp(split, min_split, 1.0F - min_split);
}

bool Comparison::is_working() const {
    return preparing_.is_running() || pictures_.is_running();
}

void Comparison::discard() {
    read_.reset();
    prepared_.reset();
    composed_.reset();
    preparing_.cancel();
    pictures_.discard();
    error_.clear();
    last_.reset();
}

std::string Comparison::label(bool is_other) const {
    return is_other ? side_name(choices_) : "original";
}

void Comparison::begin(const ViewerState& state) {
    read_.emplace(state.scene());
    error_.clear();
    ViewOptions options = state.options();
    options.debug = {};
    if (choices_.file) options.model = *choices_.file;
    preparing_.start([scene = state.scene(), options, choices = choices_](const Progress&) {
        PreparedSide prepared;
        prepared.options = options;
        Report unused;
        Stages silent(true);
        try {
            if (choices.variant)
                prepared.prepared = prepare(*choices.variant, scene, options, unused);
            else
                prepared.file = std::move(compose_scene(prepared.options, silent, unused).scene());
        } catch (const Cancelled&) {
            throw;
        } catch (const std::exception& error) {
            prepared.error = error.what();
        }
        return prepared;
    });
}

void Comparison::compose(const Scene& shown, const DrawRequest& request) {
    composed_of_ = request.revision;
    composed_pose_ = request.pose;
    ++revision_;
    if (!prepared_->file) {
        composed_ = std::make_shared<const Scene>(with_variant(shown, prepared_->prepared));
        return;
    }
    OtherSide side = side_of_file(shown, Camera{}, prepared_->options, *prepared_->file);
    composed_ = std::make_shared<const Scene>(std::move(side.scene));
}

void Comparison::follow(const ViewerState& state) {
    pictures_.follow();
    if (!is_on_ || !choices_.compares() || !state.has_scene()) {
        if (read_) discard();  // Frees the memory of an inactive comparison.
        return;
    }
    if (!read_ || !read_->is(state.scene())) begin(state);
    if (std::optional<PreparedSide> prepared = preparing_.take()) {
        error_ = prepared->error;
        prepared_ = std::move(prepared);
        composed_.reset();
        if (!error_.empty()) prepared_.reset();
    }
    const std::optional<DrawRequest> request = state.request();
    if (prepared_ && request && !preparing_.is_running() &&
        (!composed_ || composed_of_ != request->revision || composed_pose_ != request->pose))
        compose(*request->scene, *request);
}

std::optional<DrawTask> Comparison::add_to(DrawRequest& request) {
    if (!is_on_ || !composed_ || composed_of_ != request.revision || composed_pose_ != request.pose)
        return std::nullopt;
    const Camera camera =
        choices_.file ? with_depth_range(request.camera, bounding_sphere(world_bounds(*composed_)))
                      : request.camera;
    request.beside = BesideRequest{composed_, revision_, camera};
    const ComparisonKey key = key_of(request);
    const bool is_unchanged = last_ == key;
    last_ = key;
    const bool has_numbers = numbers() && numbers()->key == key;
    if (shown_ != ComparisonView::both && has_numbers && numbers()->error.empty())
        request.instead = shown_ == ComparisonView::flip ? numbers()->flip : numbers()->absolute;
    const bool needs_numbers = has_numbers_request_ || shown_ != ComparisonView::both;
    if (!needs_numbers || has_numbers || !is_unchanged) return std::nullopt;
    std::optional<DrawTask> task = pictures_.begin(request);
    if (task) has_numbers_request_ = false;
    return task;
}

std::string Comparison::command_line() const {
    if (!is_on_) return "";
    CompareChoices choices = choices_;
    choices.split = split_;
    return command_line_of(choices);
}

nlohmann::ordered_json Comparison::json() const {
    nlohmann::ordered_json json = {{"on", is_on_}};
    if (!is_on_ || !choices_.compares()) return json;
    json["left"] = left_label();
    json["right"] = right_label();
    json["split"] = split_;
    json["shown"] = enum_name(shown_);
    json["working"] = is_working();
    json["error"] = error_;
    json["revision"] = composed_ ? revision_ : 0;
    json["numbers"] = json_of(numbers());
    return json;
}

namespace {

const VariantTopic& topic_of(const Variant& variant) {
    return variant_topics().at(variant.index());
}

/// \return the new selection, or null
template <typename Named, typename Name>
const Named* choose_one(const char* label, const std::string& now, const std::vector<Named>& all,
                        const Name& name) {
    const Named* chosen = nullptr;
    if (ImGui::BeginCombo(begin_row(label).c_str(), now.c_str())) {
        for (const Named& one : all) {
            if (ImGui::Selectable(name(one).c_str(), name(one) == now)) chosen = &one;
            probe_item(name(one));
        }
        ImGui::EndCombo();
    } else {
        probe_item(label);
    }
    return chosen;
}

void choose_variant(Comparison& comparison) {
    const std::optional<Variant>& variant = comparison.choices().variant;
    const std::string name = variant ? topic_of(*variant).name : "";
    const VariantTopic* topic =
        choose_one("Change", name, variant_topics(), [](const VariantTopic& t) { return t.name; });
    if (topic != nullptr) comparison.choose(topic->choices.front().second);
    if (!variant || topic != nullptr) return;
    const std::string text = to_text(*variant);
    const auto* choice =
        choose_one("To", text.substr(text.find('=') + 1), topic_of(*variant).choices,
                   [](const auto& c) { return c.first; });
    ImGui::TextWrapped("%s", topic_of(*variant).what.c_str());
    if (choice != nullptr) comparison.choose(choice->second);
}

void choose_file(Comparison& comparison) {
    static std::array<char, 4096> name{};
    const bool entered =
        ImGui::InputTextWithHint(begin_row("Other file").c_str(), "path of a model or scene",
                                 name.data(), name.size(), ImGuiInputTextFlags_EnterReturnsTrue);
    probe_item("Other file");
    if (entered && name.front() != '\0') comparison.choose(std::filesystem::path(name.data()));
}

void draw_numbers(const Comparison& comparison) {
    const std::optional<ComparisonResult>& numbers = comparison.numbers();
    if (!numbers) return;
    if (!numbers->error.empty()) return ImGui::TextWrapped("%s", numbers->error.c_str());
    ImGui::TextWrapped("%s", difference_text(numbers->comparison).c_str());
}

}  // namespace

void draw_compare_panel(const PanelInput& input) {
    if (!input.state.has_scene() || input.comparison == nullptr) return;
    Comparison& comparison = *input.comparison;
    bool is_on = comparison.is_on();
    if (check("Compare two", is_on)) comparison.toggle();
    choose_variant(comparison);
    choose_file(comparison);
    if (!comparison.is_on()) return;
    if (!comparison.error().empty())
        ImGui::TextColored({1.0F, 0.5F, 0.4F, 1.0F}, "%s", comparison.error().c_str());
    if (ImGui::Button("Swap sides")) comparison.swap();
    probe_item("Swap sides");
    int shown = static_cast<int>(comparison.shown());
    if (ImGui::Combo(begin_row("Show##sides").c_str(), &shown,
                     "Both sides\0Perceived difference\0Largest difference\0"))
        comparison.show(static_cast<ComparisonView>(shown));
    if (ImGui::Button("Measure the difference")) comparison.request_numbers();
    probe_item("Measure the difference");
    if (comparison.is_working()) {
        ImGui::SameLine();
        ImGui::TextUnformatted("working");
    }
    draw_numbers(comparison);
}

}  // namespace relief::tools
