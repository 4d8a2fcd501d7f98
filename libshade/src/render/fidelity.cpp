// SPDX-License-Identifier: Apache-2.0
// Measures the difference of a model from its source in pictures.
// Tests: tests/shade/render/fidelity_test.cpp.
#include "relief/shade/fidelity.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
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
/// Every fourth view measures the noise floor, and the difference on black.
constexpr std::size_t floor_stride = 4;

void raise(WorstView& worst, std::size_t view, double value) {
    if (value > worst.value) worst = {view, value};
}

/// The values of all views.
struct Collected {
    std::vector<float> values;

    /// \return the mean of the added values
    double add(const std::vector<float>& added) {
        values.insert(values.end(), added.begin(), added.end());
        return mean_of(added);
    }
};

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

struct FidelityMeter::Implementation {
    Implementation(const Context& gl, const Scene& scene, const FidelityOptions& requested,
                   Report& report);

    /// The noise floors.
    struct Floors {
        std::array<double, fidelity_light_count> flip{};
        double degrees = 0.0;
        double silhouette_pixels = 0.0;
    };

    void measure_floor(const Scene& scene);
    /// Adds the difference of a view with one light. \return FLIP by compared pixel
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
    std::vector<ViewPictures> source;
    Floors floors;
};

FidelityMeter::Implementation::Implementation(const Context& gl, const Scene& scene,
                                              const FidelityOptions& requested, Report& report)
    : options(requested), per_side(1), context(gl), cache(gl) {
    check(options);
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
        for (std::size_t view = 0; view < options.views; ++view)
            source.push_back(drawn.draw(view));
    }
    measure_floor(unit);
    cache.drop_unused();
}

void FidelityMeter::Implementation::measure_floor(const Scene& scene) {
    DrawnScene drawn(cache, context, scene, options.size, per_side + 1, IgnoredReport());
    std::array<Collected, fidelity_light_count> flip;
    Collected degrees;
    SilhouetteSums silhouettes;
    for (std::size_t view = 0; view < options.views; view += floor_stride) {
        const ViewPictures other = drawn.draw(view);
        const ComparedPart compared =
            compared_part(source[view].normals, other.normals, options.size);
        for (std::size_t i = 0; i < fidelity_light_count; ++i)
            flip[i].add(
                compare_light(other, view, static_cast<FidelityLight>(i), compared, nullptr));
        degrees.add(angles_between(source[view].normals, other.normals).degrees);
        const SilhouetteSums sums =
            silhouette_sums(source[view].normals, other.normals, options.size);
        silhouettes.area += sums.area;
        silhouettes.length += sums.length;
    }
    for (std::size_t i = 0; i < fidelity_light_count; ++i)
        floors.flip[i] = mean_of(flip[i].values);
    floors.degrees = mean_of(degrees.values);
    floors.silhouette_pixels = silhouettes.width();
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
    std::optional<DrawnScene> drawn;
    if (has_triangles(result)) {
        drawn.emplace(self.cache, self.context,
                      normalized_scene(result, self.sphere, self.materials), options.size,
                      self.per_side, report);
    }
    Fidelity fidelity;
    std::array<Collected, fidelity_light_count> flip;
    Collected on_black, degrees;
    SilhouetteSums silhouettes;
    for (std::size_t view = 0; view < options.views; ++view) {
        const ViewPictures pictures = drawn ? drawn->draw(view) : empty_view(options.size);
        const NormalPicture& before = self.source[view].normals;
        const ComparedPart compared = compared_part(before, pictures.normals, options.size);
        ViewLoss& loss = fidelity.views.emplace_back();
        for (std::size_t i = 0; i < fidelity_light_count; ++i) {
            loss.flip[i] = flip[i].add(self.compare_light(
                pictures, view, static_cast<FidelityLight>(i), compared, &fidelity.pictures[i]));
        }
        std::optional<double> view_on_black;
        if (view % floor_stride == 0) {
            view_on_black = on_black.add(self.flip_on_black(pictures, view, compared));
        }
        const AngleValues angles = angles_between(before, pictures.normals);
        fidelity.normals.undefined += angles.undefined;
        loss.degrees = degrees.add(angles.degrees);
        raise(fidelity.normals.worst, view, loss.degrees);
        const SilhouetteSums sums = silhouette_sums(before, pictures.normals, options.size);
        silhouettes.area += sums.area;
        silhouettes.length += sums.length;
        loss.silhouette_pixels = sums.width();
        raise(fidelity.silhouettes.worst, view, loss.silhouette_pixels);
        add_findings(before, pictures.normals, options.size, loss, view_on_black,
                     angles.degrees.size() + angles.undefined, view, report);
    }
    for (std::size_t i = 0; i < fidelity_light_count; ++i) {
        PictureLoss& loss = fidelity.pictures[i];
        loss.mean = mean_of(flip[i].values);
        loss.p95 = percentile(std::move(flip[i].values), 95);
        loss.floor = self.floors.flip[i];
    }
    fidelity.studio_mean_on_black = mean_of(on_black.values);
    NormalLoss& normals = fidelity.normals;
    normals.mean = mean_of(degrees.values);
    normals.pixels = degrees.values.size();
    double squares = 0.0;
    for (const float value : degrees.values) {
        const auto angle = static_cast<double>(value);
        normals.max = std::max(normals.max, angle);
        squares += angle * angle;
    }
    if (normals.pixels > 0) normals.rms = std::sqrt(squares / static_cast<double>(normals.pixels));
    normals.p95 = percentile(degrees.values, 95);
    normals.p99 = percentile(std::move(degrees.values), 99);
    normals.floor = self.floors.degrees;
    fidelity.silhouettes.width = silhouettes.width();
    fidelity.silhouettes.floor = self.floors.silhouette_pixels;
    fidelity.diameter = 2.0 * self.sphere.radius;
    fidelity.pixels_across = fidelity_sphere_share * static_cast<double>(options.size);
    drawn.reset();
    self.cache.drop_unused();
    return fidelity;
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
