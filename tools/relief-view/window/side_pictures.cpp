// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/window/compare_window_test.cpp.
#include "window/side_pictures.h"

#include <algorithm>

#include "relief/mesh/heat_picture.h"

namespace relief::tools {
namespace {

Image drawn_image(const Context& context, RenderCache& cache, const Scene& scene,
                  const Camera& camera, const DrawWish& wish) {
    Report known;  // The window has shown these findings.
    Renderer renderer(cache, context, scene, forced_plan(scene, wish.settings, wish.effects),
                      wish.settings, known);
    return renderer.draw(camera).image;
}

SideNumbers numbers_of(const SidesKey& key, const Image& left, const Image& right) {
    SideNumbers numbers;
    numbers.key = key;
    try {
        numbers.comparison = compare_pictures(left, right);
        const Image apart = largest_differences(left, right);
        const auto values = apart.as<float>();
        const float largest = *std::max_element(values.begin(), values.end());
        numbers.absolute =
            std::make_shared<const Image>(heat_picture(apart, largest > 0.0F ? largest : 1.0F));
        numbers.flip =
            std::make_shared<const Image>(heat_picture(numbers.comparison.flip.map, 1.0));
    } catch (const std::exception& error) {
        numbers.error = error.what();
    }
    return numbers;
}

}  // namespace

SidesKey key_of(const DrawWish& wish) {
    return {wish.revision,
            wish.beside ? wish.beside->revision : 0,
            wish.camera.world_from_view,
            wish.camera.vertical_fov,
            wish.settings.width,
            wish.settings.height};
}

std::optional<DrawTask> SidePictures::begin(const DrawWish& wish) {
    if (begun_ || !wish.beside) return std::nullopt;
    begun_ = key_of(wish);
    drawn_ = std::make_shared<Drawn>();
    return [wish, drawn = drawn_](const Context& context, RenderCache& cache) {
        Image left, right;
        std::string error;
        try {
            left = drawn_image(context, cache, *wish.scene, wish.camera, wish);
            right = drawn_image(context, cache, *wish.beside->scene, wish.beside->camera, wish);
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

void SidePictures::follow() {
    if (drawn_) {
        const std::lock_guard lock(drawn_->mutex);
        if (drawn_->is_done) {
            comparing_.start([key = *begun_, drawn = drawn_](const Progress&) {
                const std::lock_guard none_else(drawn->mutex);
                if (drawn->error.empty()) return numbers_of(key, drawn->left, drawn->right);
                SideNumbers failed;
                failed.key = key;
                failed.error = drawn->error;
                return failed;
            });
        }
    }
    if (drawn_ && comparing_.is_going_on()) drawn_.reset();
    if (std::optional<SideNumbers> numbers = comparing_.take()) {
        numbers_ = std::move(numbers);
        begun_.reset();
    }
}

void SidePictures::forget() {
    numbers_.reset();
    drawn_.reset();
    begun_.reset();
    comparing_.cancel();
}

}  // namespace relief::tools
