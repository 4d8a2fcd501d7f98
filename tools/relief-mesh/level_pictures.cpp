// SPDX-License-Identifier: Apache-2.0
// Pictures of levels of detail. A mesh is drawn as a viewer sees it on the screen: at the distance
// at which the sphere around it has the given diameter in pixels, with the materials of the file
// and the default lights. Tests: tests/tools/reshaping_test.cpp.
#include "reshape.h"

#include "relief/mesh/report.h"

#ifdef RELIEF_HAS_SHADE

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "portable_math.h"
#include "relief/mesh/image.h"
#include "relief/mesh/mesh.h"
#include "relief/shade/effects.h"
#include "relief/shade/image_compare.h"
#include "relief/shade/renderer.h"
#include "relief/shade/scene.h"
#include "relief/shade/scene_file.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

/// The views: a third of a turn apart, two from above and one from below.
struct LevelView {
    float azimuth;
    float elevation;
};
constexpr float third_turn = 2.0F * std::numbers::pi_v<float> / 3.0F;
constexpr std::array level_views = {
    LevelView{default_azimuth, default_elevation},
    LevelView{default_azimuth + third_turn, -default_elevation},
    LevelView{default_azimuth + 2.0F * third_turn, default_elevation}};

/// Sizes are 2^(step / 4) pixels.
constexpr int min_step = 8;
constexpr int max_step = 40;  ///< 1024 pixels, which nearly fills the height of the screen.

double pixels_at(int step) {
    // Exact roots, so that sizes do not depend on the C library.
    const double root = std::sqrt(std::numbers::sqrt2);
    constexpr int per_octave = 4;
    double pixels = std::ldexp(1.0, step / per_octave);
    for (int i = 0; i < step % per_octave; ++i)
        pixels *= root;
    return pixels;
}

int step_below(double pixels) {
    int step = max_step;
    while (step > min_step && pixels_at(step) > pixels)
        --step;
    return step;
}

/// Returns the mean of the FLIP map over the pixels that a picture covers.
double covered_mean(const FlipDifference& difference, const Image& a, const Image& b) {
    const auto map = difference.map.as<float>();
    const auto of_a = a.as<std::uint8_t>();
    const auto of_b = b.as<std::uint8_t>();
    double sum = 0.0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < map.size(); ++i) {
        sum += static_cast<double>(map[i]);
        if (of_a[4 * i + 3] != 0 || of_b[4 * i + 3] != 0) ++count;
    }
    return count == 0 ? 0.0 : sum / static_cast<double>(count);
}

double difference_of(const Image& reference, const Image& picture) {
    // A viewer at a distance of the screen's width.
    constexpr double pixels_per_degree = lod_screen_width * std::numbers::pi / 180.0;
    return covered_mean(flip_difference(reference, picture, pixels_per_degree), reference, picture);
}

/// A camera whose picture has the pixels of the screen around the mesh, which is scaled to a
/// diameter of 1 around the origin.
///
/// \param shift  of the mesh in the picture, to the lower left, in pixels in both directions
Camera camera_at(const LevelView& view, double pixels, int side, double shift) {
    const double tangent =
        relief::detail::portable::tan(static_cast<double>(default_vertical_fov) / 2.0);
    const double distance = lod_screen_height / (2.0 * tangent * pixels);
    const Bounds unit{glm::vec3(-0.5F), glm::vec3(0.5F)};
    Camera camera = framed(unit, view.azimuth, view.elevation, default_vertical_fov, 1.0F);
    const glm::mat4& axes = camera.world_from_view;
    const auto moved = static_cast<float>(shift / pixels);
    const glm::vec3 eye = glm::vec3(axes[2]) * static_cast<float>(distance) +
                          (glm::vec3(axes[0]) + glm::vec3(axes[1])) * moved;
    camera.world_from_view[3] = glm::vec4(eye, 1.0F);
    camera.vertical_fov =
        static_cast<float>(2.0 * relief::detail::portable::atan2(
                                     tangent * static_cast<double>(side) / lod_screen_height, 1.0));
    camera.near = static_cast<float>(distance - 0.6);
    camera.far = static_cast<float>(distance + 0.6);
    return camera;
}

/// Centers the scene and scales it to a diameter of 1. \return false if that is not possible
bool normalize(Scene& scene, const glm::dvec3& center, double diameter) {
    constexpr double min_size = 1e-9, max_size = 1e9;
    if (!(diameter >= min_size && diameter <= max_size)) return false;
    const glm::mat4 scaled =
        glm::scale(glm::mat4(1.0F), glm::vec3(static_cast<float>(1.0 / diameter)));
    for (Instance& instance : scene.instances)
        instance.world_from_object = scaled * glm::translate(glm::mat4(1.0F), glm::vec3(-center));
    return true;
}

}  // namespace

struct LevelPictures::Implementation {
    explicit Implementation(double error)
        : pixel_error(error), context(std::make_unique<Context>()), cache(*context) {}

    /// The input at one size.
    struct Reference {
        std::vector<Image> pictures;  ///< By view.
        std::vector<double> moved;    ///< FLIP of the moved input, by view.
    };
    struct Subject {
        Scene input;
        Scene level;
        glm::dvec3 center{0.0};
        double diameter = 0.0;
        bool is_drawable = false;
        std::map<int, Reference> references;  ///< By step.
    };

    std::vector<Image> draw(const Scene& scene, int step, double shift);
    const Reference& reference(Subject& subject, int step);
    /// Returns the difference in the view in which it is largest relative to that of the moved
    /// input.
    LevelSwitch difference(Subject& subject, int step);

    double pixel_error;
    std::unique_ptr<Context> context;
    RenderCache cache;
    std::vector<Subject> subjects;
};

std::vector<Image> LevelPictures::Implementation::draw(const Scene& scene, int step, double shift) {
    const double pixels = pixels_at(step);
    // Perspective enlarges the sphere by up to 6 %.
    constexpr double enlarged = 1.06;
    constexpr int margin = 8;
    const int side = static_cast<int>(std::ceil(enlarged * pixels)) + margin;
    const FrameSettings settings{.width = side, .height = side};
    std::vector<Image> pictures;
    std::unique_ptr<Renderer> renderer;
    Report ignored;  // Findings of images are those of the input, which is reported elsewhere.
    for (const LevelView& view : level_views) {
        Scene lit = scene;
        add_default_lights(lit, camera_at(view, pixels, side, 0.0));
        if (renderer) {
            renderer->move(lit);
        } else {
            renderer = std::make_unique<Renderer>(cache, *context, lit, plan_effects(lit, settings),
                                                  settings, ignored);
        }
        pictures.push_back(renderer->draw(camera_at(view, pixels, side, shift)).image);
    }
    return pictures;
}

const LevelPictures::Implementation::Reference& LevelPictures::Implementation::reference(
    Subject& subject, int step) {
    const auto [place, is_new] = subject.references.try_emplace(step);
    if (!is_new) return place->second;
    Reference& made = place->second;
    made.pictures = draw(subject.input, step, 0.0);
    const std::vector<Image> moved = draw(subject.input, step, pixel_error / std::numbers::sqrt2);
    for (std::size_t i = 0; i < moved.size(); ++i)
        made.moved.push_back(difference_of(made.pictures[i], moved[i]));
    return made;
}

LevelSwitch LevelPictures::Implementation::difference(Subject& subject, int step) {
    const Reference& input = reference(subject, step);
    const std::vector<Image> level = draw(subject.level, step, 0.0);
    LevelSwitch worst{pixels_at(step), 0.0, 0.0};
    double largest = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < level.size(); ++i) {
        const double flip = difference_of(input.pictures[i], level[i]);
        if (flip - input.moved[i] <= largest) continue;
        largest = flip - input.moved[i];
        worst.flip = flip;
        worst.moved_flip = input.moved[i];
    }
    return worst;
}

LevelPictures::LevelPictures(double pixel_error)
    : implementation_(std::make_unique<Implementation>(pixel_error)) {}

LevelPictures::~LevelPictures() = default;

void LevelPictures::set_input(const GltfDocument& document, std::span<const std::size_t> meshes,
                              const std::filesystem::path& file) {
    auto& subjects = implementation_->subjects;
    subjects.clear();
    for (Scene& scene : mesh_scenes(document, meshes, file)) {
        Implementation::Subject& subject = subjects.emplace_back();
        subject.input = std::move(scene);
        const Bounds bounds = world_bounds(subject.input);
        if (bounds.empty()) continue;
        subject.center = (glm::dvec3(bounds.min) + glm::dvec3(bounds.max)) / 2.0;
        subject.diameter = glm::length(glm::dvec3(bounds.max) - glm::dvec3(bounds.min));
        subject.is_drawable = normalize(subject.input, subject.center, subject.diameter);
    }
}

void LevelPictures::set_level(const GltfDocument& document, std::span<const std::size_t> meshes,
                              const std::filesystem::path& file) {
    auto& subjects = implementation_->subjects;
    std::vector<Scene> scenes = mesh_scenes(document, meshes, file);
    for (std::size_t i = 0; i < subjects.size(); ++i) {
        Implementation::Subject& subject = subjects[i];
        subject.level = std::move(scenes[i]);
        normalize(subject.level, subject.center, subject.diameter);
        // The same values, so that the cache does not read images again.
        subject.level.images = subject.input.images;
        subject.level.materials = subject.input.materials;
    }
    implementation_->cache.drop_unused();
}

std::optional<LevelSwitch> LevelPictures::find_switch(std::size_t mesh, double start, double most) {
    Implementation::Subject& subject = implementation_->subjects[mesh];
    if (!subject.is_drawable || !(most >= pixels_at(min_step))) return std::nullopt;
    const int last = step_below(most);
    // Coarser levels are smaller.
    subject.references.erase(subject.references.upper_bound(last), subject.references.end());
    int step = std::min(step_below(start), last);
    LevelSwitch at = implementation_->difference(subject, step);
    const auto is_within = [](const LevelSwitch& here) { return here.flip <= here.moved_flip; };
    // The time of a picture grows with its area. Upwards, the stride is therefore small; downwards,
    // it doubles. Then the search bisects.
    const bool grows = is_within(at);
    std::optional<int> beyond;
    for (int stride = grows ? 2 : 1; !beyond; stride *= grows ? 1 : 2) {
        const int next = grows ? std::min(step + stride, last) : std::max(step - stride, min_step);
        if (next == step) return at;
        const LevelSwitch here = implementation_->difference(subject, next);
        if (is_within(here) == grows) {
            step = next;
            at = here;
        } else {
            beyond = next;
            if (!grows) {
                std::swap(step, *beyond);
                at = here;
            }
        }
    }
    while (*beyond - step > 1) {
        const int middle = (step + *beyond) / 2;
        const LevelSwitch here = implementation_->difference(subject, middle);
        if (is_within(here)) {
            step = middle;
            at = here;
        } else {
            beyond = middle;
        }
    }
    return at;
}

const std::string& LevelPictures::backend_name() const {
    return implementation_->context->backend_name();
}

}  // namespace relief::tools

#else

namespace relief::tools {

struct LevelPictures::Implementation {};

LevelPictures::LevelPictures(double) {
    throw Error("relief-mesh was built without the component shade");
}
LevelPictures::~LevelPictures() = default;
void LevelPictures::set_input(const GltfDocument&, std::span<const std::size_t>,
                              const std::filesystem::path&) {}
void LevelPictures::set_level(const GltfDocument&, std::span<const std::size_t>,
                              const std::filesystem::path&) {}
std::optional<LevelSwitch> LevelPictures::find_switch(std::size_t, double, double) {
    return std::nullopt;
}
const std::string& LevelPictures::backend_name() const {
    static const std::string none;
    return none;
}

}  // namespace relief::tools

#endif
