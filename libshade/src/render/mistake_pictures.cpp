// SPDX-License-Identifier: Apache-2.0
// The pictures of a mistake, and what it costs. Tests:
// tests/shade/render/mistake_pictures_test.cpp.
#include <cmath>
#include <limits>
#include <utility>

#include "effects/mistake_texts.h"
#include "relief/mesh/image.h"
#include "relief/shade/effects.h"
#include "relief/shade/mistakes.h"

namespace relief::shade {
using namespace relief::shade::detail;

namespace {

/// Draws pictures of one camera.
class Drawing {
  public:
    Drawing(const Camera& camera, const Context& context, RenderCache& cache)
        : camera_(camera), context_(context), cache_(cache) {}

    [[nodiscard]] Image picture(const Scene& scene, const FrameSettings& settings,
                                Report& report) const {
        Renderer renderer(cache_, context_, scene, plan_effects(scene, settings), settings, report);
        Image image = renderer.draw(camera_).image;
        if (scene.background.a == 1.0F) drop_alpha(image);
        return image;
    }

    /// The measured direction at each pixel; zero where there is none.
    [[nodiscard]] Image directions(Scene scene, const FrameSettings& picture,
                                   ShaderTexts texts) const {
        scene.background = glm::vec4(0.0F);
        const FrameSettings settings = {
            .width = picture.width,
            .height = picture.height,
            .samples = 1,
            .output = OutputCoding::linear,
            .view = DebugView::shading_normal,
            .shaders = std::make_shared<const ShaderTexts>(std::move(texts))};
        Report same;
        FramePlan plan = plan_view(scene, settings, plan_effects(scene, settings), same);
        Renderer renderer(cache_, context_, scene, std::move(plan), settings, same);
        return renderer.draw(camera_).image;
    }

  private:
    const Camera& camera_;
    const Context& context_;
    RenderCache& cache_;
};

struct Direction {
    glm::dvec3 vector;
    bool exists;
};

Direction direction_at(const Image& image, std::size_t pixel) {
    const std::vector<float>& samples = std::get<std::vector<float>>(image.samples);
    const auto channels = static_cast<std::size_t>(image.channels);
    const glm::dvec3 v(samples[channels * pixel], samples[channels * pixel + 1],
                       samples[channels * pixel + 2]);
    const double squared = glm::dot(v, v);
    return {v, squared > 1e-30 && squared < 1e30};
}

ErrorStats angles_between(const Image& right, const Image& wrong) {
    std::vector<float> degrees;
    const auto pixels =
        static_cast<std::size_t>(right.width) * static_cast<std::size_t>(right.height);
    for (std::size_t i = 0; i < pixels; ++i) {
        const auto [a, has_a] = direction_at(right, i);
        const auto [b, has_b] = direction_at(wrong, i);
        if (!has_a && !has_b) continue;
        const double angle = std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
        degrees.push_back(has_a && has_b ? static_cast<float>(glm::degrees(angle))
                                         : std::numeric_limits<float>::quiet_NaN());
    }
    return error_stats(std::move(degrees));
}

}  // namespace

MistakeCost mistake_cost(const Mistake& mistake, const Scene& scene, const Camera& camera,
                         const FrameSettings& settings, const Context& context, RenderCache& cache,
                         Report& report, const Image* right) {
    const Drawing drawing(camera, context, cache);
    MistakeCost cost;
    cost.right = right != nullptr ? *right : drawing.picture(scene, settings, report);
    FrameSettings mistaken = settings;
    mistaken.shaders = with_mistake(mistake, settings.shaders);
    Report same;
    cost.wrong = drawing.picture(with_mistake(mistake, scene), mistaken, same);
    cost.difference = compare(cost.right, cost.wrong);
    cost.flip = flip_difference(cost.right, cost.wrong);
    if (mistake.vector == MistakenVector::none) return cost;
    cost.angles =
        angles_between(drawing.directions(scene, settings,
                                          measuring_texts(mistake, scene, settings.shaders, false)),
                       drawing.directions(scene, settings,
                                          measuring_texts(mistake, scene, settings.shaders, true)));
    return cost;
}

}  // namespace relief::shade
