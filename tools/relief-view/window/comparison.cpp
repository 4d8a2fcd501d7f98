// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/window/comparison_test.cpp.
#include "window/comparison.h"

#include <algorithm>

namespace relief::tools {
namespace {

constexpr float least_split = 0.02F;  // Nearer to the edge, the line could not be caught again.

std::vector<std::size_t> map_images(const Scene& scene) {
    constexpr auto none = static_cast<std::size_t>(-1);
    std::vector<std::size_t> images;
    for (const Material& material : scene.materials) {
        images.push_back(material.normal_map ? material.normal_map->texture.image : none);
        images.push_back(material.bump_map ? material.bump_map->texture.image : none);
    }
    return images;
}

nlohmann::ordered_json json_of(const std::optional<SideNumbers>& numbers) {
    if (!numbers || !numbers->error.empty()) return nullptr;
    return numbers_json(numbers->comparison);
}

const char* word_for(SidesShown shown) {
    return shown == SidesShown::both ? "both" : shown == SidesShown::flip ? "flip" : "absolute";
}

}  // namespace

ReadOfScene::ReadOfScene(const Scene& scene) : images_(map_images(scene)) {
    for (const Shared<Mesh>& mesh : scene.meshes)
        meshes_.push_back(mesh.identity());
}

bool ReadOfScene::is(const Scene& scene) const {
    return meshes_.size() == scene.meshes.size() && images_ == map_images(scene) &&
           std::equal(meshes_.begin(), meshes_.end(), scene.meshes.begin(),
                      [](const auto& identity, const auto& mesh) { return identity.is(mesh); });
}

Comparison::Comparison(const CompareChoices& choices, const std::function<void()>& wake)
    : choices_(choices), is_on_(choices.compares()), working_(wake), pictures_(wake) {
    set_split(choices.split.value_or(usual_split));
}

void Comparison::choose(const Variant& variant) {
    choices_.variant = variant;
    choices_.file.reset();
    forget();
    is_on_ = true;
}

void Comparison::choose(const std::filesystem::path& file) {
    choices_.file = file;
    choices_.variant.reset();
    forget();
    is_on_ = true;
}

void Comparison::toggle() {
    if (!choices_.compares()) return choose(Variant(Interpolation::flat));
    is_on_ = !is_on_;
}

void Comparison::toggle_difference() {
    shown_ = shown_ == SidesShown::both ? SidesShown::flip : SidesShown::both;
}

void Comparison::set_split(float split) {
    split_ = std::clamp(split, least_split, 1.0F - least_split);
}

bool Comparison::is_working() const {
    return working_.is_going_on() || pictures_.is_going_on();
}

void Comparison::forget() {
    read_.reset();
    worked_.reset();
    composed_.reset();
    working_.cancel();
    pictures_.forget();
    error_.clear();
    last_.reset();
}

std::string Comparison::label(bool is_other) const {
    return is_other ? side_in_words(choices_) : "as it is";
}

void Comparison::begin(const ViewerState& state) {
    read_.emplace(state.scene());
    error_.clear();
    ViewOptions options = state.options();
    options.debug = {};
    if (choices_.file) options.model = *choices_.file;
    working_.start([scene = state.scene(), options, choices = choices_](const Progress&) {
        Worked worked;
        worked.options = options;
        Report told;
        Stages silent(true);
        try {
            if (choices.variant)
                worked.prepared = prepare(*choices.variant, scene, options, told);
            else
                worked.file = std::move(compose_scene(worked.options, silent, told).scene());
        } catch (const Cancelled&) {
            throw;
        } catch (const std::exception& error) {
            worked.error = error.what();
        }
        return worked;
    });
}

void Comparison::compose(const Scene& shown, std::uint64_t revision) {
    composed_of_ = revision;
    ++revision_;
    if (!worked_->file) {
        composed_ = std::make_shared<const Scene>(with(shown, worked_->prepared));
        return;
    }
    OtherSide side = side_of_file(shown, Camera{}, worked_->options, *worked_->file);
    composed_ = std::make_shared<const Scene>(std::move(side.scene));
}

void Comparison::follow(const ViewerState& state) {
    pictures_.follow();
    if (!is_on_ || !choices_.compares() || !state.has_scene()) {
        if (read_) forget();  // What is not compared takes no memory.
        return;
    }
    if (!read_ || !read_->is(state.scene())) begin(state);
    if (std::optional<Worked> worked = working_.take()) {
        error_ = worked->error;
        worked_ = std::move(worked);
        composed_.reset();
        if (!error_.empty()) worked_.reset();
    }
    const std::optional<DrawWish> wish = state.wish();
    if (worked_ && wish && !working_.is_going_on() &&
        (!composed_ || composed_of_ != wish->revision))
        compose(*wish->scene, wish->revision);
}

std::optional<DrawTask> Comparison::add_to(DrawWish& wish) {
    if (!is_on_ || !composed_ || composed_of_ != wish.revision) return std::nullopt;
    const Camera camera =
        choices_.file ? seeing(wish.camera, ball_around(world_bounds(*composed_))) : wish.camera;
    wish.beside = BesideWish{composed_, revision_, camera};
    const SidesKey key = key_of(wish);
    const bool rests = last_ == key;
    last_ = key;
    const bool are_there = numbers() && numbers()->key == key;
    if (shown_ != SidesShown::both && are_there && numbers()->error.empty())
        wish.instead = shown_ == SidesShown::flip ? numbers()->flip : numbers()->absolute;
    const bool are_wanted = are_numbers_asked_ || shown_ != SidesShown::both;
    if (!are_wanted || are_there || !rests) return std::nullopt;
    std::optional<DrawTask> task = pictures_.begin(wish);
    if (task) are_numbers_asked_ = false;
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
    json["shown"] = word_for(shown_);
    json["working"] = is_working();
    json["error"] = error_;
    json["revision"] = composed_ ? revision_ : 0;
    json["numbers"] = json_of(numbers());
    return json;
}

}  // namespace relief::tools
