// SPDX-License-Identifier: Apache-2.0
// Measures the difference of a model from its source in pictures. Each view is drawn with more
// samples than pixels; the samples of a pixel are averaged here, so that other sample positions
// (the noise floor) cover the same pixels. Tests: tests/shade/render/fidelity_test.cpp.
#include "relief/shade/fidelity.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "relief/mesh/statistics.h"
#include "relief/shade/environment.h"
#include "relief/shade/image_compare.h"

namespace relief::shade {

namespace {

constexpr double sphere_share = 0.9;  ///< Of the side of the pictures.
constexpr float middle_gray = 0.18F;  ///< Linear.
/// White surfaces stay below the largest value of a picture.
constexpr float studio_intensity = 0.75F;
/// Every fourth view measures the noise floor, and the difference on black.
constexpr std::size_t floor_stride = 4;

/// Sine and cosine of 75 degrees.
constexpr float sin_grazing = 0.965925826F;
constexpr float cos_grazing = 0.258819045F;

struct Sphere {
    glm::dvec3 center{0.0};
    double radius = 0.0;
};

/// Calls visit(position) for every finite vertex in world space.
template <typename Visit>
void for_each_vertex(const Scene& scene, const Visit& visit) {
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const glm::dmat4 world_from_object(scene.instances[i].world_from_object);
        const Shared<Mesh> mesh = deformed_mesh(scene, i);
        for (const glm::vec3& position : mesh->positions) {
            const glm::dvec3 world(world_from_object * glm::dvec4(glm::dvec3(position), 1.0));
            if (std::isfinite(world.x + world.y + world.z)) visit(world);
        }
    }
}

double radius_around(const Scene& scene, const glm::dvec3& center) {
    double squared = 0.0;
    for_each_vertex(scene, [&](const glm::dvec3& position) {
        const glm::dvec3 offset = position - center;
        squared = std::max(squared, glm::dot(offset, offset));
    });
    return std::sqrt(squared);
}

bool has_triangles(const Scene& scene) {
    return std::any_of(scene.instances.begin(), scene.instances.end(), [&](const Instance& one) {
        return !scene.meshes[one.mesh]->triangles.empty();
    });
}

Sphere bounding_sphere(const Scene& source) {
    const Bounds bounds = world_bounds(source);
    if (!has_triangles(source) || bounds.empty())
        throw InvalidInput("the source has no triangle, so nothing can be compared with it");
    Sphere sphere;
    sphere.center = (glm::dvec3(bounds.min) + glm::dvec3(bounds.max)) / 2.0;
    sphere.radius = radius_around(source, sphere.center);
    constexpr double min_radius = 1e-12, max_radius = 1e12;
    if (!(sphere.radius >= min_radius && sphere.radius <= max_radius)) {
        throw InvalidInput(fmt::format(
            "the radius of the source is {:g}, but must be within [1e-12, 1e12]", sphere.radius));
    }
    return sphere;
}

/// The materials of the pictures.
enum class Materials {
    as_authored,
    gray,     ///< Matte, of the default gray. The source has neither materials nor colors.
    colored,  ///< Matte, with base colors. The source has only vertex colors.
};

bool is_default(const Material& material) {
    return material.name == default_material().name && !material.metallic_roughness &&
           !material.diffuse_texture && material.diffuse == default_material().diffuse;
}

/// Sources without materials have no gloss, and often no color, that a result could lose.
Materials materials_for(const Scene& source) {
    if (!std::all_of(source.materials.begin(), source.materials.end(), is_default))
        return Materials::as_authored;
    const bool has_colors =
        std::any_of(source.instances.begin(), source.instances.end(),
                    [&](const Instance& one) { return !source.meshes[one.mesh]->colors.empty(); });
    return has_colors ? Materials::colored : Materials::gray;
}

/// Keeps normals, opacity and, for Materials::colored, base colors.
Material matte(const Material& material, Materials materials) {
    Material result;
    result.name = material.name;
    result.interpolation = material.interpolation;
    result.normal_map = material.normal_map;
    result.bump_map = material.bump_map;
    result.tangent_frame = material.tangent_frame;
    result.opacity_texture = material.opacity_texture;
    result.alpha_mode = material.alpha_mode;
    result.opacity = material.opacity;
    result.alpha_cutoff = material.alpha_cutoff;
    result.double_sided = material.double_sided;
    if (materials == Materials::colored) {
        const auto& model = material.metallic_roughness;
        result.diffuse = model                  ? model->base_color
                         : is_default(material) ? glm::vec3(1.0F)
                                                : material.diffuse;
    }
    if (materials == Materials::colored || material.alpha_mode != AlphaMode::opaque)
        result.diffuse_texture = material.diffuse_texture;
    return result;
}

/// Moves and scales a scene so that the sphere is the unit sphere around the origin, and removes
/// all that is not a surface.
Scene normalized(Scene scene, const Sphere& sphere, Materials materials) {
    const double scale = 1.0 / sphere.radius;
    glm::dmat4 unit_from_world(1.0);
    for (int axis = 0; axis < 3; ++axis) {
        unit_from_world[axis][axis] = scale;
        unit_from_world[3][axis] = -sphere.center[axis] * scale;
    }
    for (Instance& instance : scene.instances) {
        instance.world_from_object =
            glm::mat4(unit_from_world * glm::dmat4(instance.world_from_object));
        instance.open_shares = {};
    }
    for (Material& material : scene.materials) {
        if (material.metallic_roughness && material.metallic_roughness->attenuation_distance)
            *material.metallic_roughness->attenuation_distance *= static_cast<float>(scale);
    }
    Scene surfaces;
    surfaces.meshes = std::move(scene.meshes);
    surfaces.materials = std::move(scene.materials);
    surfaces.images = std::move(scene.images);
    surfaces.instances = std::move(scene.instances);
    name_default_material(surfaces);
    if (materials != Materials::as_authored) {
        for (Material& material : surfaces.materials)
            material = matte(material, materials);
    }
    return surfaces;
}

glm::mat3 axes_of(std::size_t view) {
    const glm::vec3 back = fidelity_view(view);
    const glm::vec3 right = glm::normalize(glm::cross(glm::vec3(0, 1, 0), back));
    return {right, glm::cross(back, right), back};
}

/// \param reach  the radius of the scene around the origin
Camera camera_of(std::size_t view, double reach) {
    const glm::mat3 axes = axes_of(view);
    const auto distance = static_cast<float>(1.5 * reach);
    Camera camera;
    camera.world_from_view = glm::mat4(axes);
    camera.world_from_view[3] = glm::vec4(axes[2] * distance, 1.0F);
    camera.near = static_cast<float>(0.45 * reach);
    camera.far = static_cast<float>(2.55 * reach);
    camera.orthographic_height = static_cast<float>(2.0 / sphere_share);
    return camera;
}

DirectionalLight grazing_light(std::size_t view) {
    const glm::mat3 axes = axes_of(view);
    const float side = sin_grazing * std::sqrt(0.5F);
    const glm::vec3 to_light = side * (axes[1] - axes[0]) + cos_grazing * axes[2];
    return {-to_light, glm::vec3(1.0F)};
}

Scene lit(Scene scene, FidelityLight light) {
    switch (light) {
        case FidelityLight::studio:
            scene.environment = studio_environment();
            scene.environment->intensity = studio_intensity;
            break;
        case FidelityLight::grazing:
            scene.directional_lights = {grazing_light(0)};
            break;
        case FidelityLight::base_color:
            for (Material& material : scene.materials)
                material.unlit = true;
            break;
    }
    return scene;
}

/// A picture in linear light, multiplied by alpha: 65535 stands for 1.
using ColorPicture = std::vector<glm::u16vec4>;

struct NormalPicture {
    std::vector<glm::vec3> normals;  ///< The sums of the samples, of any length.
    std::vector<float> coverage;     ///< The covered part of each pixel.
};

/// Calls add(pixel, sample) for every sample of a drawn image.
template <typename Add>
void for_each_sample(const Image& drawn, int per_side, const Add& add) {
    const std::span<const float> samples = drawn.as<float>();
    const int size = drawn.width / per_side;
    for (int y = 0; y < drawn.height; ++y) {
        for (int x = 0; x < drawn.width; ++x) {
            const auto i = static_cast<std::size_t>(y * drawn.width + x);
            const auto pixel = static_cast<std::size_t>(y / per_side * size + x / per_side);
            add(pixel, glm::vec4(samples[4 * i], samples[4 * i + 1], samples[4 * i + 2],
                                 samples[4 * i + 3]));
        }
    }
}

ColorPicture averaged_colors(const Image& drawn, int per_side) {
    const int size = drawn.width / per_side;
    std::vector<glm::vec4> sums(static_cast<std::size_t>(size * size), glm::vec4(0.0F));
    for_each_sample(drawn, per_side, [&](std::size_t pixel, const glm::vec4& sample) {
        sums[pixel] += glm::vec4(glm::vec3(sample) * sample.a, sample.a);
    });
    constexpr float largest = 65535.0F;
    const float scale = largest / static_cast<float>(per_side * per_side);
    ColorPicture picture(sums.size());
    for (std::size_t i = 0; i < sums.size(); ++i)
        picture[i] = glm::u16vec4(glm::clamp(sums[i] * scale, 0.0F, largest) + 0.5F);
    return picture;
}

NormalPicture averaged_normals(const Image& drawn, int per_side) {
    const int size = drawn.width / per_side;
    const auto pixels = static_cast<std::size_t>(size * size);
    NormalPicture picture{std::vector<glm::vec3>(pixels, glm::vec3(0.0F)),
                          std::vector<float>(pixels, 0.0F)};
    const float share = 1.0F / static_cast<float>(per_side * per_side);
    for_each_sample(drawn, per_side, [&](std::size_t pixel, const glm::vec4& sample) {
        if (!(sample.a > 0.5F)) return;
        picture.normals[pixel] += 2.0F * glm::vec3(sample) - 1.0F;
        picture.coverage[pixel] += share;
    });
    return picture;
}

/// Returns the color of all surfaces if they have the same one.
std::optional<glm::vec3> only_color(const Scene& scene) {
    const auto has_colors = [&](const Instance& one) {
        return !scene.meshes[one.mesh]->colors.empty();
    };
    if (scene.materials.empty() ||
        std::any_of(scene.instances.begin(), scene.instances.end(), has_colors))
        return std::nullopt;
    const glm::vec3 color = scene.materials.front().diffuse;
    const bool is_same =
        std::all_of(scene.materials.begin(), scene.materials.end(), [&](const Material& one) {
            return !one.metallic_roughness && !one.diffuse_texture && one.diffuse == color &&
                   one.alpha_mode == AlphaMode::opaque;
        });
    return is_same ? std::optional(glm::min(color, 1.0F)) : std::nullopt;
}

/// Returns the picture of surfaces of one color without light.
ColorPicture one_color_picture(const glm::vec3& color, const NormalPicture& covered) {
    constexpr float largest = 65535.0F;
    ColorPicture picture(covered.coverage.size());
    for (std::size_t i = 0; i < picture.size(); ++i) {
        const float coverage = std::min(covered.coverage[i], 1.0F);
        picture[i] = glm::u16vec4(glm::vec4(color * coverage, coverage) * largest + 0.5F);
    }
    return picture;
}

/// A scene on the GPU, with a renderer for each light and for normals.
class DrawnScene {
  public:
    /// \param scene  normalized, with at least one triangle
    DrawnScene(RenderCache& cache, const Context& context, const Scene& scene, int size,
               int per_side, Report& report)
        : reach_(std::clamp(radius_around(scene, glm::dvec3(0.0)), 1.0, max_reach)),
          per_side_(per_side),
          color_(only_color(scene)),
          grazing_(lit(scene, FidelityLight::grazing)) {
        FrameSettings settings{.width = size * per_side,
                               .height = size * per_side,
                               .samples = 1,
                               .output = OutputCoding::clamped};
        for (std::size_t i = 0; i < fidelity_light_count; ++i) {
            const auto light = static_cast<FidelityLight>(i);
            if (light == FidelityLight::base_color && color_) continue;
            const Scene with_light = lit(scene, light);
            lights_[i].emplace(cache, context, with_light, plan_effects(with_light, settings),
                               settings, i == 0 ? report : IgnoredReport());
        }
        settings.output = OutputCoding::linear;
        settings.view = DebugView::shading_normal;
        normals_.emplace(cache, context, scene, plan_effects(scene, settings), settings,
                         IgnoredReport());
    }

    ColorPicture draw(FidelityLight light, std::size_t view) {
        Renderer& renderer = *lights_[static_cast<std::size_t>(light)];
        if (light == FidelityLight::grazing) {
            grazing_.directional_lights = {grazing_light(view)};
            renderer.move(grazing_);
        }
        return averaged_colors(renderer.draw(camera_of(view, reach_)).image, per_side_);
    }

    /// The color of all surfaces if they have the same one. Their base color needs no drawing.
    [[nodiscard]] const std::optional<glm::vec3>& color() const { return color_; }

    NormalPicture draw_normals(std::size_t view) {
        return averaged_normals(normals_->draw(camera_of(view, reach_)).image, per_side_);
    }

  private:
    /// Beyond this distance, the depths of a model lose their resolution.
    static constexpr double max_reach = 100.0;

    double reach_;
    int per_side_;
    std::optional<glm::vec3> color_;
    Scene grazing_;
    std::array<std::optional<Renderer>, fidelity_light_count> lights_;
    std::optional<Renderer> normals_;
};

/// All pictures of a view.
struct ViewPictures {
    std::array<ColorPicture, fidelity_light_count> colors;
    NormalPicture normals;
};

ViewPictures drawn_view(DrawnScene& scene, std::size_t view) {
    ViewPictures pictures;
    pictures.normals = scene.draw_normals(view);
    for (std::size_t i = 0; i < fidelity_light_count; ++i) {
        const auto light = static_cast<FidelityLight>(i);
        pictures.colors[i] = light == FidelityLight::base_color && scene.color()
                                 ? one_color_picture(*scene.color(), pictures.normals)
                                 : scene.draw(light, view);
    }
    return pictures;
}

ViewPictures empty_view(int size) {
    const auto pixels = static_cast<std::size_t>(size * size);
    ViewPictures pictures;
    pictures.colors.fill(ColorPicture(pixels, glm::u16vec4(0)));
    pictures.normals = {std::vector<glm::vec3>(pixels, glm::vec3(0.0F)),
                        std::vector<float>(pixels, 0.0F)};
    return pictures;
}

/// The pixels of a view that are compared, and the rectangle of those that influence them.
struct ComparedPart {
    std::vector<std::uint8_t> is_compared;
    ImagePart part;
};

/// Marks the pixels within fidelity_margin of marked ones, along rows (step 1) or columns.
std::vector<std::uint8_t> grown(const std::vector<std::uint8_t>& marked, int size, bool is_row) {
    std::vector<std::uint8_t> result(marked.size(), 0);
    const auto index = [&](int line, int i) {
        return static_cast<std::size_t>(is_row ? line * size + i : i * size + line);
    };
    for (int line = 0; line < size; ++line) {
        int next = -1;  // The last pixel that is marked in the result.
        for (int i = 0; i < size; ++i) {
            if (marked[index(line, i)] == 0) continue;
            const int end = std::min(i + fidelity_margin, size - 1);
            for (int j = std::max(next + 1, i - fidelity_margin); j <= end; ++j)
                result[index(line, j)] = 1;
            next = end;
        }
    }
    return result;
}

ComparedPart compared_part(const NormalPicture& a, const NormalPicture& b, int size) {
    std::vector<std::uint8_t> covered(a.coverage.size(), 0);
    glm::ivec2 begin(size);
    glm::ivec2 end(0);
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const auto i = static_cast<std::size_t>(y * size + x);
            if (!(a.coverage[i] > 0.0F) && !(b.coverage[i] > 0.0F)) continue;
            covered[i] = 1;
            begin = glm::min(begin, glm::ivec2(x, y));
            end = glm::max(end, glm::ivec2(x + 1, y + 1));
        }
    }
    if (begin.x >= end.x) return {std::move(covered), {}};
    // Twice: the filters at the outermost pixels that are compared reach as far again.
    begin = glm::max(begin - 2 * fidelity_margin, glm::ivec2(0));
    end = glm::min(end + 2 * fidelity_margin, glm::ivec2(size));
    return {grown(grown(covered, size, true), size, false),
            {begin.x, begin.y, end.x - begin.x, end.y - begin.y}};
}

/// Returns a part of a picture over a background, in linear float.
Image over_gray(const ColorPicture& picture, int size, const ImagePart& part, float background) {
    Image image = make_image(part.width, part.height, 3, 32, ColorSpace::linear);
    const std::span<float> samples = image.as<float>();
    std::size_t sample = 0;
    for (int y = 0; y < part.height; ++y) {
        for (int x = 0; x < part.width; ++x) {
            const auto i = static_cast<std::size_t>((part.y + y) * size + part.x + x);
            const glm::vec4 color = glm::vec4(picture[i]) / 65535.0F;
            for (int channel = 0; channel < 3; ++channel)
                samples[sample++] = color[channel] + (1.0F - color.a) * background;
        }
    }
    return image;
}

/// Returns the FLIP values of the compared pixels of a part.
std::vector<float> compared_values(const Image& map, const ComparedPart& compared, int size) {
    const std::span<const float> errors = map.as<float>();
    std::vector<float> values;
    std::size_t i = 0;
    for (int y = 0; y < map.height; ++y) {
        for (int x = 0; x < map.width; ++x, ++i) {
            const auto pixel =
                static_cast<std::size_t>((compared.part.y + y) * size + compared.part.x + x);
            if (compared.is_compared[pixel] != 0) values.push_back(errors[i]);
        }
    }
    return values;
}

double mean_of(std::span<const float> values) {
    double sum = 0.0;
    for (const float value : values)
        sum += static_cast<double>(value);
    return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

/// Returns the smallest value that a percentage of all do not exceed; 0 if there is none.
double percentile(std::vector<float> values, std::size_t percent) {
    if (values.empty()) return 0.0;
    const std::size_t rank = (values.size() * percent + 99) / 100 - 1;
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(rank),
                     values.end());
    return static_cast<double>(values[rank]);
}

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

bool is_covered_completely(float coverage) {
    return coverage > 1.0F - 1e-3F;
}

struct AngleValues {
    std::vector<float> degrees;
    std::size_t undefined = 0;
};

AngleValues angles_between(const NormalPicture& a, const NormalPicture& b) {
    AngleValues values;
    for (std::size_t i = 0; i < a.normals.size(); ++i) {
        if (!is_covered_completely(a.coverage[i]) || !is_covered_completely(b.coverage[i]))
            continue;
        const double degrees =
            a.normals[i] == b.normals[i] && a.normals[i] != glm::vec3(0.0F)
                ? 0.0
                : degrees_between(glm::dvec3(a.normals[i]), glm::dvec3(b.normals[i]));
        if (std::isnan(degrees))
            ++values.undefined;
        else
            values.degrees.push_back(static_cast<float>(degrees));
    }
    return values;
}

/// The length of silhouettes, and the area that only one of two models covers, in pixels.
struct SilhouetteSums {
    double area = 0.0;
    double length = 0.0;

    [[nodiscard]] double width() const { return length > 0.0 ? area / length : 0.0; }
};

/// The length is the integral of the gradient of the coverage.
SilhouetteSums silhouette_sums(const NormalPicture& source, const NormalPicture& result, int size) {
    SilhouetteSums sums;
    const auto coverage = [&](int x, int y) {
        return x < size && y < size
                   ? static_cast<double>(source.coverage[static_cast<std::size_t>(y * size + x)])
                   : 0.0;
    };
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const double here = coverage(x, y);
            const double dx = coverage(x + 1, y) - here;
            const double dy = coverage(x, y + 1) - here;
            sums.length += std::sqrt(dx * dx + dy * dy);
            sums.area +=
                std::abs(here - static_cast<double>(
                                    result.coverage[static_cast<std::size_t>(y * size + x)]));
        }
    }
    return sums;
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
}

/// Returns a picture of the whole size with the values of a part, and 0 elsewhere.
Image whole_map(const Image& part_map, const ImagePart& part, int size) {
    Image map = make_image(size, size, 1, 32, ColorSpace::data);
    const std::span<const float> from = part_map.as<float>();
    const std::span<float> to = map.as<float>();
    for (int y = 0; y < part.height; ++y) {
        const auto row = from.subspan(static_cast<std::size_t>(y * part.width),
                                      static_cast<std::size_t>(part.width));
        std::copy(row.begin(), row.end(),
                  to.begin() + static_cast<std::ptrdiff_t>((part.y + y) * size + part.x));
    }
    return map;
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
    Sphere sphere;
    Materials materials = Materials::as_authored;
    std::vector<ViewPictures> source;
    Floors floors;
};

FidelityMeter::Implementation::Implementation(const Context& gl, const Scene& scene,
                                              const FidelityOptions& requested, Report& report)
    : options(requested), per_side(1), context(gl), cache(gl) {
    check(options);
    while (per_side * per_side < options.samples)
        ++per_side;
    sphere = bounding_sphere(scene);
    materials = materials_for(scene);
    if (materials != Materials::as_authored) {
        report.add("source without materials", "model", 0,
                   materials == Materials::gray
                       ? "models are drawn matte and gray, with the normal maps of results"
                       : "models are drawn matte, with colors and the normal maps of results");
    }
    const Scene unit = normalized(scene, sphere, materials);
    {
        DrawnScene drawn(cache, context, unit, options.size, per_side, report);
        for (std::size_t view = 0; view < options.views; ++view)
            source.push_back(drawn_view(drawn, view));
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
        const ViewPictures other = drawn_view(drawn, view);
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
        drawn.emplace(self.cache, self.context, normalized(result, self.sphere, self.materials),
                      options.size, self.per_side, report);
    }
    Fidelity fidelity;
    std::array<Collected, fidelity_light_count> flip;
    Collected on_black, degrees;
    SilhouetteSums silhouettes;
    for (std::size_t view = 0; view < options.views; ++view) {
        const ViewPictures pictures = drawn ? drawn_view(*drawn, view) : empty_view(options.size);
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
    fidelity.pixels_across = sphere_share * static_cast<double>(options.size);
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
