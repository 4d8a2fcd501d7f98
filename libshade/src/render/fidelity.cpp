// SPDX-License-Identifier: Apache-2.0
// Measures the difference of a model from its source in pictures.
// Tests: tests/shade/render/fidelity_test.cpp.
#include "relief/shade/fidelity.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include "relief/mesh/statistics.h"
#include "relief/shade/image_compare.h"
#include "render/fidelity_figures.h"
#include "render/fidelity_pictures.h"

namespace relief::shade {
using namespace relief::shade::detail;

namespace {

constexpr float middle_gray = 0.18F;  ///< Linear.

void raise(WorstView& worst, std::size_t view, double value) {
    if (value > worst.value) worst = {view, value};
}

/// The values of some views.
struct Differences {
    std::array<std::vector<float>, fidelity_light_count> flip;
    AngleValues angles;
    SilhouetteSums silhouettes;
    WorstView worst_degrees;

    /// \param one  the values of a view
    void add(const Differences& one, std::size_t view) {
        for (std::size_t i = 0; i < fidelity_light_count; ++i)
            flip[i].insert(flip[i].end(), one.flip[i].begin(), one.flip[i].end());
        const std::vector<float>& degrees = one.angles.degrees;
        angles.degrees.insert(angles.degrees.end(), degrees.begin(), degrees.end());
        angles.undefined += one.angles.undefined;
        silhouettes.area += one.silhouettes.area;
        silhouettes.length += one.silhouettes.length;
        raise(worst_degrees, view, mean_of(degrees));
    }
};

NormalLoss normal_loss(const Differences& differences) {
    const std::vector<float>& degrees = differences.angles.degrees;
    NormalLoss normals;
    normals.mean = mean_of(degrees);
    normals.pixels = degrees.size();
    normals.undefined = differences.angles.undefined;
    normals.worst = differences.worst_degrees;
    double squares = 0.0;
    for (const float value : degrees) {
        const auto angle = static_cast<double>(value);
        normals.max = std::max(normals.max, angle);
        squares += angle * angle;
    }
    if (normals.pixels > 0) normals.rms = std::sqrt(squares / static_cast<double>(normals.pixels));
    normals.p95 = percentile(degrees, 95);
    normals.p99 = percentile(degrees, 99);
    return normals;
}

SampledFidelity sampled_fidelity(const Differences& differences) {
    SampledFidelity sampled;
    for (std::size_t i = 0; i < fidelity_light_count; ++i)
        sampled.flip[i] = mean_of(differences.flip[i]);
    sampled.normals = normal_loss(differences);
    sampled.silhouette_pixels = differences.silhouettes.width();
    return sampled;
}

void check(const FidelityOptions& options) {
    constexpr int min_size = 16, max_size = 4096, max_samples = 16;
    if (options.size < min_size || options.size > max_size) {
        throw InvalidInput(
            fmt::format("the pictures have {} pixels a side, but must have from {} "
                        "to {}",
                        options.size, min_size, max_size));
    }
    if (options.samples != 1 && options.samples != 4 && options.samples != 9 &&
        options.samples != max_samples) {
        throw InvalidInput(fmt::format("a pixel has {} samples, but must have 1, 4, 9 or {}",
                                       options.samples, max_samples));
    }
    if (options.views < 1 || options.views > fidelity_view_count) {
        throw InvalidInput(fmt::format("{} views are requested, but there must be 1 to {}",
                                       options.views, fidelity_view_count));
    }
    for (const glm::vec3& view : options.more_views) {
        const float squared = glm::dot(view, view);
        if (!(squared > 0.0F && std::isfinite(squared)))
            throw InvalidInput("the direction of a view must be finite and not zero");
    }
}

/// Returns the directions to the cameras of all views.
std::vector<glm::vec3> views_of(const FidelityOptions& options) {
    std::vector<glm::vec3> views;
    for (std::size_t i = 0; i < options.views; ++i)
        views.push_back(fidelity_view(i));
    for (const glm::vec3& view : options.more_views)
        views.push_back(glm::normalize(view));
    return views;
}

}  // namespace

glm::vec3 fidelity_view(std::size_t view) {
    // The golden ratio. Opposite vertices follow each other.
    constexpr float phi = 1.61803398875F;
    constexpr std::array<glm::vec3, fidelity_view_count / 2> half = {
        glm::vec3(0, 1, phi),  glm::vec3(phi, 0, 1),  glm::vec3(1, phi, 0),
        glm::vec3(0, -1, phi), glm::vec3(phi, 0, -1), glm::vec3(1, -phi, 0)};
    const glm::vec3 direction = glm::normalize(half.at(view / 2));
    return view % 2 == 0 ? direction : glm::vec3(0.0F) - direction;
}

double Fidelity::max_picture_mean() const {
    double most = 0.0;
    for (const PictureLoss& loss : pictures)
        most = std::max(most, loss.mean);
    return most;
}

std::vector<std::size_t> worst_views_first(const Fidelity& loss) {
    std::vector<std::size_t> order(loss.views.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto largest = [&](std::size_t view) {
        return *std::ranges::max_element(loss.views[view].flip);
    };
    std::ranges::stable_sort(order, std::greater(), largest);
    return order;
}

struct FidelityMeter::Implementation {
    Implementation(const Context& gl, const Scene& scene, const FidelityOptions& requested,
                   Report& report);

    [[nodiscard]] bool is_sampled(std::size_t view) const {
        return view < options.views && view % fidelity_sample_stride == 0;
    }
    /// Loads a result; null if it has no triangles.
    std::unique_ptr<DrawnScene> load(const Scene& result, Report& report);
    void measure_floor(const Scene& scene);
    /// \param losses  by light; get the pictures of the worst view. May be null
    Differences compare(const ViewPictures& result, std::size_t view, const ComparedPart& compared,
                        std::array<PictureLoss, fidelity_light_count>* losses) const;
    /// Compares a view with one light. \return FLIP by compared pixel
    std::vector<float> compare_light(const ViewPictures& result, std::size_t view,
                                     FidelityLight light, const ComparedPart& compared,
                                     PictureLoss* loss) const;
    [[nodiscard]] std::vector<float> flip_on_black(const ViewPictures& result, std::size_t view,
                                                   const ComparedPart& compared) const;

    FidelityOptions options;
    int per_side;
    const Context& context;
    RenderCache cache;
    FidelitySphere sphere;
    FidelityMaterials materials = FidelityMaterials::as_authored;
    std::vector<glm::vec3> views;  ///< The directions to the cameras.
    std::vector<ViewPictures> source;
    SampledFidelity floor;
};

FidelityMeter::Implementation::Implementation(const Context& gl, const Scene& scene,
                                              const FidelityOptions& requested, Report& report)
    : options(requested), per_side(1), context(gl), cache(gl) {
    check(options);
    views = views_of(options);
    while (per_side * per_side < options.samples)
        ++per_side;
    sphere = fidelity_sphere(scene);
    materials = fidelity_materials(scene);
    if (materials != FidelityMaterials::as_authored) {
        report.add("source without materials", "model", 0,
                   materials == FidelityMaterials::gray
                       ? "models are drawn matte and gray, with the normal maps of results"
                       : "models are drawn matte, with colors and the normal maps of results");
    }
    const Scene unit = normalized_scene(scene, sphere, materials);
    {
        DrawnScene drawn(cache, context, unit, options.size, per_side, report);
        for (const glm::vec3& from : views)
            source.push_back(drawn.draw(from));
    }
    measure_floor(unit);
    cache.drop_unused();
}

std::unique_ptr<DrawnScene> FidelityMeter::Implementation::load(const Scene& result,
                                                                Report& report) {
    if (!has_triangles(result)) return nullptr;
    return std::make_unique<DrawnScene>(cache, context, normalized_scene(result, sphere, materials),
                                        options.size, per_side, report);
}

void FidelityMeter::Implementation::measure_floor(const Scene& scene) {
    DrawnScene drawn(cache, context, scene, options.size, per_side + 1, IgnoredReport());
    Differences differences;
    for (std::size_t view = 0; view < views.size(); ++view) {
        if (!is_sampled(view)) continue;
        const ViewPictures other = drawn.draw(views[view]);
        const ComparedPart compared =
            compared_part(source[view].normals, other.normals, options.size);
        differences.add(compare(other, view, compared, nullptr), view);
    }
    floor = sampled_fidelity(differences);
}

Differences FidelityMeter::Implementation::compare(
    const ViewPictures& result, std::size_t view, const ComparedPart& compared,
    std::array<PictureLoss, fidelity_light_count>* losses) const {
    Differences differences;
    for (std::size_t i = 0; i < fidelity_light_count; ++i) {
        differences.flip[i] = compare_light(result, view, static_cast<FidelityLight>(i), compared,
                                            losses == nullptr ? nullptr : &(*losses)[i]);
    }
    const NormalPicture& before = source[view].normals;
    differences.angles = angles_between(before, result.normals);
    differences.silhouettes = silhouette_sums(before, result.normals, options.size);
    return differences;
}

std::vector<float> FidelityMeter::Implementation::compare_light(const ViewPictures& result,
                                                                std::size_t view,
                                                                FidelityLight light,
                                                                const ComparedPart& compared,
                                                                PictureLoss* loss) const {
    if (compared.part.width == 0) return {};
    const auto i = static_cast<std::size_t>(light);
    const ColorPicture& before = source[view].colors[i];
    const ColorPicture& after = result.colors[i];
    const Image map = flip_difference(over_gray(before, options.size, compared.part, middle_gray),
                                      over_gray(after, options.size, compared.part, middle_gray))
                          .map;
    std::vector<float> values = compared_values(map, compared, options.size);
    if (loss == nullptr) return values;
    const bool is_first = loss->source.empty();
    const double mean = mean_of(values);
    if (mean > loss->worst.value || is_first) {
        if (mean > loss->worst.value) loss->worst = {view, mean};
        const ImagePart whole{0, 0, options.size, options.size};
        loss->source = to_srgb(over_gray(before, options.size, whole, middle_gray), 8);
        loss->result = to_srgb(over_gray(after, options.size, whole, middle_gray), 8);
        loss->difference = whole_map(map, compared.part, options.size);
    }
    return values;
}

std::vector<float> FidelityMeter::Implementation::flip_on_black(
    const ViewPictures& result, std::size_t view, const ComparedPart& compared) const {
    if (compared.part.width == 0) return {};
    const auto studio = static_cast<std::size_t>(FidelityLight::studio);
    return compared_values(
        flip_difference(over_gray(source[view].colors[studio], options.size, compared.part, 0.0F),
                        over_gray(result.colors[studio], options.size, compared.part, 0.0F))
            .map,
        compared, options.size);
}

FidelityMeter::FidelityMeter(const Context& context, const Scene& source,
                             const FidelityOptions& options, Report& report)
    : implementation_(std::make_unique<Implementation>(context, source, options, report)) {}

FidelityMeter::~FidelityMeter() = default;

namespace {

/// Returns whether a model reaches the edge of a picture.
bool reaches_edge(const NormalPicture& picture, int size) {
    const auto is_covered = [&](int x, int y) {
        return picture.coverage[static_cast<std::size_t>(y * size + x)] > 0.0F;
    };
    for (int i = 0; i < size; ++i) {
        if (is_covered(i, 0) || is_covered(i, size - 1) || is_covered(0, i) ||
            is_covered(size - 1, i))
            return true;
    }
    return false;
}

/// Adds the findings on a view.
/// \param on_black  the mean FLIP in the studio on black, if it was measured
void add_findings(const NormalPicture& source, const NormalPicture& result, int size,
                  const ViewLoss& loss, const std::optional<double>& on_black,
                  std::size_t compared_normals, std::size_t view, Report& report) {
    constexpr double max_share = 0.1;
    const double on_gray = loss.flip[static_cast<std::size_t>(FidelityLight::studio)];
    if (on_black && std::abs(on_gray - *on_black) > max_share * on_gray) {
        report.add("difference of pictures that depends on the background", "view", view,
                   "silhouettes contribute much of the difference");
    }
    if (reaches_edge(result, size)) {
        report.add("result that reaches the edge of the picture", "view", view,
                   "what is beyond the edge is not compared");
    }
    const bool has_normals =
        std::any_of(source.coverage.begin(), source.coverage.end(), is_covered_completely);
    if (has_normals && compared_normals == 0) {
        report.add("picture without a pixel that both models cover", "view", view,
                   "no angle between normals is measured");
    }
}

}  // namespace

Fidelity FidelityMeter::measure(const Scene& result, Report& report) {
    Implementation& self = *implementation_;
    const FidelityOptions& options = self.options;
    Fidelity fidelity;
    Differences all, sampled;
    std::vector<float> on_black;
    {
        const std::unique_ptr<DrawnScene> drawn = self.load(result, report);
        for (std::size_t view = 0; view < self.views.size(); ++view) {
            const ViewPictures pictures =
                drawn ? drawn->draw(self.views[view]) : empty_view(options.size);
            const NormalPicture& before = self.source[view].normals;
            const ComparedPart compared = compared_part(before, pictures.normals, options.size);
            const Differences one = self.compare(pictures, view, compared, &fidelity.pictures);
            all.add(one, view);
            ViewLoss& loss = fidelity.views.emplace_back();
            loss.from = self.views[view];
            for (std::size_t i = 0; i < fidelity_light_count; ++i)
                loss.flip[i] = mean_of(one.flip[i]);
            loss.degrees = mean_of(one.angles.degrees);
            loss.silhouette_pixels = one.silhouettes.width();
            raise(fidelity.silhouettes.worst, view, loss.silhouette_pixels);
            std::optional<double> view_on_black;
            if (self.is_sampled(view)) {
                sampled.add(one, view);
                const std::vector<float> values = self.flip_on_black(pictures, view, compared);
                view_on_black = mean_of(values);
                on_black.insert(on_black.end(), values.begin(), values.end());
            }
            add_findings(before, pictures.normals, options.size, loss, view_on_black,
                         one.angles.degrees.size() + one.angles.undefined, view, report);
        }
    }
    self.cache.drop_unused();
    for (std::size_t i = 0; i < fidelity_light_count; ++i) {
        PictureLoss& loss = fidelity.pictures[i];
        loss.mean = mean_of(all.flip[i]);
        loss.p95 = percentile(all.flip[i], 95);
        loss.floor = self.floor.flip[i];
    }
    fidelity.normals = normal_loss(all);
    fidelity.normals.floor = self.floor.normals.mean;
    fidelity.silhouettes.width = all.silhouettes.width();
    fidelity.silhouettes.floor = self.floor.silhouette_pixels;
    fidelity.sampled = sampled_fidelity(sampled);
    fidelity.studio_mean_on_black = mean_of(on_black);
    fidelity.diameter = 2.0 * self.sphere.radius;
    fidelity.pixels_across = fidelity_sphere_share * static_cast<double>(options.size);
    return fidelity;
}

SampledFidelity FidelityMeter::measure_sampled(const Scene& result, Report& report) {
    Implementation& self = *implementation_;
    Differences differences;
    {
        const std::unique_ptr<DrawnScene> drawn = self.load(result, report);
        for (std::size_t view = 0; view < self.views.size(); ++view) {
            if (!self.is_sampled(view)) continue;
            const ViewPictures pictures =
                drawn ? drawn->draw(self.views[view]) : empty_view(self.options.size);
            const ComparedPart compared =
                compared_part(self.source[view].normals, pictures.normals, self.options.size);
            differences.add(self.compare(pictures, view, compared, nullptr), view);
        }
    }
    self.cache.drop_unused();
    return sampled_fidelity(differences);
}

double NormalLoss::error(ErrorKind kind) const {
    switch (kind) {
        case ErrorKind::mean:
            return mean;
        case ErrorKind::rms:
            return rms;
        case ErrorKind::p99:
            return p99;
        case ErrorKind::max:
            break;
    }
    return max;
}

Fidelity measure_fidelity(const Scene& source, const Scene& result, const FidelityOptions& options,
                          Report& report) {
    const Context context;
    FidelityMeter meter(context, source, options, report);
    return meter.measure(result, report);
}

Mesh world_surface(const Scene& scene) {
    Mesh surface;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const Shared<Mesh> mesh = deformed_mesh(scene, i);
        const glm::dmat4 world_from_object(scene.instances[i].world_from_object);
        const auto first = static_cast<std::uint32_t>(surface.positions.size());
        for (const glm::vec3& position : mesh->positions) {
            surface.positions.emplace_back(
                glm::dvec3(world_from_object * glm::dvec4(glm::dvec3(position), 1.0)));
        }
        for (const glm::uvec3& triangle : mesh->triangles)
            surface.triangles.push_back(triangle + first);
    }
    return surface;
}

}  // namespace relief::shade
