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

/// The largest size that is drawn, 215 pixels. A larger one is compared in pictures of this size,
/// with an error that is the same part of the mesh: both differences shrink alike. The result
/// differs by up to 3 steps from that of larger pictures, which take several times as long.
constexpr int max_drawn_step = 31;

/// The search begins with at most 64 pixels, because small pictures cost less and predict the
/// others.
constexpr int max_first_step = 24;

int drawn_step(int step) {
    return std::min(step, max_drawn_step);
}

/// Returns the number of steps, not 0, to where a level probably differs as much as the moved
/// input.
int predicted_stride(const LevelSwitch& here) {
    // The ratio of both differences is about proportional to this power of the size.
    constexpr double power = 0.5;
    constexpr double max_stride = 12.0;
    constexpr double steps_per_octave = 4.0;
    const double difference = std::max(here.flip, 1e-6);
    const double moved = std::max(here.moved_flip, 1e-6);
    const double octaves =
        (relief::detail::portable::log(moved) - relief::detail::portable::log(difference)) /
        (power * std::numbers::ln2);
    const double steps = std::clamp(steps_per_octave * octaves, -max_stride, max_stride);
    const bool grows = here.flip <= here.moved_flip;
    return grows ? std::max(1, static_cast<int>(steps)) : std::min(-1, static_cast<int>(steps));
}

int step_below(double pixels) {
    int step = max_step;
    while (step > min_step && pixels_at(step) > pixels)
        --step;
    return step;
}

/// A part of a picture; empty if begin and end are equal.
struct Rectangle {
    glm::ivec2 begin{0};
    glm::ivec2 end{0};

    [[nodiscard]] glm::ivec2 size() const { return end - begin; }
};

/// Returns the pixels around those that one of the pictures covers, and their number.
std::pair<Rectangle, std::size_t> covered_part(const Image& a, const Image& b) {
    const auto of_a = a.as<std::uint8_t>();
    const auto of_b = b.as<std::uint8_t>();
    const glm::ivec2 whole(a.width, a.height);
    Rectangle covered{whole, glm::ivec2(0)};
    std::size_t count = 0;
    for (int y = 0; y < whole.y; ++y) {
        for (int x = 0; x < whole.x; ++x) {
            const auto alpha = 4 * static_cast<std::size_t>(y * whole.x + x) + 3;
            if (of_a[alpha] == 0 && of_b[alpha] == 0) continue;
            covered.begin = glm::min(covered.begin, glm::ivec2(x, y));
            covered.end = glm::max(covered.end, glm::ivec2(x + 1, y + 1));
            ++count;
        }
    }
    // FLIP is zero beyond the radius of its filters, 5 pixels.
    constexpr int margin = 6;
    if (count == 0) return {};
    return {
        {glm::max(covered.begin - margin, glm::ivec2(0)), glm::min(covered.end + margin, whole)},
        count};
}

Image cropped(const Image& image, const Rectangle& part) {
    const auto from = image.as<std::uint8_t>();
    const auto row = static_cast<std::size_t>(image.width) * 4;
    std::vector<std::uint8_t> samples;
    for (int y = part.begin.y; y < part.end.y; ++y) {
        const auto line = from.subspan(static_cast<std::size_t>(y) * row, row)
                              .subspan(4 * static_cast<std::size_t>(part.begin.x),
                                       4 * static_cast<std::size_t>(part.size().x));
        samples.insert(samples.end(), line.begin(), line.end());
    }
    return {part.size().x, part.size().y, 4, image.color_space, std::move(samples)};
}

/// Returns the mean FLIP difference over the pixels that one of the pictures covers.
double difference_of(const Image& reference, const Image& picture) {
    // A viewer at a distance of the screen's width.
    constexpr double pixels_per_degree = lod_screen_width * std::numbers::pi / 180.0;
    const auto [part, count] = covered_part(reference, picture);
    if (count == 0) return 0.0;
    const FlipDifference difference =
        flip_difference(cropped(reference, part), cropped(picture, part), pixels_per_degree);
    double sum = 0.0;
    for (const float value : difference.map.as<float>())
        sum += static_cast<double>(value);
    return sum / static_cast<double>(count);
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

    using Key = std::pair<int, std::size_t>;  ///< The step of a size and the index of a view.

    struct Subject {
        Scene input;
        Scene level;
        glm::dvec3 center{0.0};
        double diameter = 0.0;
        bool is_drawable = false;
        // By step and view. Levels share what is known of the input.
        std::map<Key, Image> pictures;      ///< Of the input.
        std::map<Key, double> moved_flips;  ///< Of the moved input.
        std::map<Key, double> level_flips;  ///< Of the level.
    };

    Image draw(const Scene& scene, Key at, double shift);
    const Image& picture(Subject& subject, Key at);
    double moved_flip(Subject& subject, Key at);
    double level_flip(Subject& subject, Key at);
    /// Returns the difference in the view in which it is largest relative to that of the moved
    /// input, or in the first view in which it is larger.
    LevelSwitch difference(Subject& subject, int step);

    double pixel_error;
    std::unique_ptr<Context> context;
    RenderCache cache;
    std::vector<Subject> subjects;
    std::size_t first_view = 0;  ///< The view that decided last.
};

Image LevelPictures::Implementation::draw(const Scene& scene, Key at, double shift) {
    const auto [step, view] = at;
    const double pixels = pixels_at(step);
    // Perspective enlarges the sphere by up to 6 %.
    constexpr double enlarged = 1.06;
    constexpr int margin = 8;
    const int side = static_cast<int>(std::ceil(enlarged * pixels)) + margin;
    const FrameSettings settings{.width = side, .height = side};
    Scene lit = scene;
    add_default_lights(lit, camera_at(level_views[view], pixels, side, 0.0));
    Report ignored;  // Findings of images are those of the input, which is reported elsewhere.
    Renderer renderer(cache, *context, lit, plan_effects(lit, settings), settings, ignored);
    return renderer.draw(camera_at(level_views[view], pixels, side, shift)).image;
}

const Image& LevelPictures::Implementation::picture(Subject& subject, Key at) {
    const auto [place, is_new] = subject.pictures.try_emplace(at);
    if (is_new) place->second = draw(subject.input, at, 0.0);
    return place->second;
}

double LevelPictures::Implementation::moved_flip(Subject& subject, Key at) {
    const auto [place, is_new] = subject.moved_flips.try_emplace(at);
    if (is_new) {
        const Key drawn{drawn_step(at.first), at.second};
        const double shift =
            pixel_error / std::numbers::sqrt2 * pixels_at(drawn.first) / pixels_at(at.first);
        place->second = difference_of(picture(subject, drawn), draw(subject.input, drawn, shift));
    }
    return place->second;
}

double LevelPictures::Implementation::level_flip(Subject& subject, Key at) {
    const Key drawn{drawn_step(at.first), at.second};
    const auto [place, is_new] = subject.level_flips.try_emplace(drawn);
    if (is_new)
        place->second = difference_of(picture(subject, drawn), draw(subject.level, drawn, 0.0));
    return place->second;
}

LevelSwitch LevelPictures::Implementation::difference(Subject& subject, int step) {
    LevelSwitch worst{pixels_at(step), 0.0, 0.0};
    double largest = -std::numeric_limits<double>::infinity();
    const std::size_t first = first_view;
    for (std::size_t i = 0; i < level_views.size(); ++i) {
        const Key at{step, (first + i) % level_views.size()};
        const double flip = level_flip(subject, at);
        const double moved = moved_flip(subject, at);
        if (flip - moved <= largest) continue;
        largest = flip - moved;
        worst.flip = flip;
        worst.moved_flip = moved;
        first_view = at.second;
        // At the smallest size, the worst view is reported in any case.
        if (flip > moved && step > min_step) break;
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
    implementation_->cache.drop_unused();
    implementation_->first_view = 0;
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
        subject.level_flips.clear();
        // The same values, so that the cache does not read images again.
        subject.level.images = subject.input.images;
        subject.level.materials = subject.input.materials;
    }
}

std::optional<LevelSwitch> LevelPictures::find_switch(std::size_t mesh, double start, double most) {
    Implementation::Subject& subject = implementation_->subjects[mesh];
    if (!subject.is_drawable || !(most >= pixels_at(min_step))) return std::nullopt;
    const int last = step_below(most);
    // The search jumps to where the ratio of the differences predicts the limit, between the bounds
    // that are known. The largest step that is known to be within the error, and the smallest one
    // beyond it.
    std::optional<int> within, beyond;
    std::optional<LevelSwitch> found;
    int step = std::min({step_below(start), last, max_first_step});
    while (true) {
        const LevelSwitch here = implementation_->difference(subject, step);
        if (here.flip <= here.moved_flip) {
            within = step;
            found = here;
            if (step == last) break;
        } else {
            beyond = step;
            if (step == min_step) return here;
        }
        if (within && beyond && *beyond - *within == 1) break;
        step = std::clamp(step + predicted_stride(here), within ? *within + 1 : min_step,
                          beyond ? *beyond - 1 : last);
    }
    return found;
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
