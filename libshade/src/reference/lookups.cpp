// SPDX-License-Identifier: Apache-2.0
// Texture and environment lookups in double. Lookups in cube maps are bilinear, also across the
// edges of faces (OpenGL's seamless cube maps).
#include "reference/reference_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "environment/convolution.h"
#include "environment/environment_images.h"
#include "geometry/direction.h"
#include "portable_math.h"
#include "relief/mesh/report.h"
#include "relief/shade/scene_file.h"
#include "scene/scene_parts.h"

namespace relief::shade::reference {
using namespace relief::detail;
using namespace relief::shade::detail;

// Textures

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

}  // namespace

int wrapped(double index, int size, Wrap wrap) {
    const double n = size;
    if (wrap == Wrap::clamp) return static_cast<int>(std::clamp(index, 0.0, n - 1.0));
    const double period = wrap == Wrap::mirror ? 2.0 * n : n;
    const double within = index - std::floor(index / period) * period;
    // Far away, where doubles are coarser than texels, the remainder may round up to the period.
    const double first = std::min(within, period - 1.0);
    return static_cast<int>(first < n ? first : period - 1.0 - first);
}

Texels::Texels(const Image& image) : image_(to_linear(image)) {}

glm::dvec4 Texels::at(int x, int y) const {
    const std::span<const float> samples = image_.as<float>();
    const auto first = (static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width) +
                        static_cast<std::size_t>(x)) *
                       static_cast<std::size_t>(image_.channels);
    const auto sample = [&](std::size_t channel) {
        return static_cast<double>(samples[first + channel]);
    };
    const double red = sample(0);
    switch (image_.channels) {
        case 1:
            return {red, red, red, 1.0};
        case 2:
            return {red, red, red, sample(1)};
        case 3:
            return {red, sample(1), sample(2), 1.0};
        default:
            return {red, sample(1), sample(2), sample(3)};
    }
}

glm::dvec4 Texels::bilinear(const glm::dvec2& uv, Wrap u, Wrap v) const {
    if (!is_finite(uv)) return glm::dvec4(not_a_number);
    const glm::dvec2 position = uv * glm::dvec2(image_.width, image_.height) - 0.5;
    const glm::dvec2 corner = glm::floor(position);
    const glm::dvec2 share = position - corner;
    const int left = wrapped(corner.x, image_.width, u);
    const int right = wrapped(corner.x + 1.0, image_.width, u);
    const int top = wrapped(corner.y, image_.height, v);
    const int bottom = wrapped(corner.y + 1.0, image_.height, v);
    const glm::dvec4 upper = at(left, top) * (1.0 - share.x) + at(right, top) * share.x;
    const glm::dvec4 lower = at(left, bottom) * (1.0 - share.x) + at(right, bottom) * share.x;
    return upper * (1.0 - share.y) + lower * share.y;
}

glm::dvec4 Texels::nearest(const glm::dvec2& uv, Wrap u, Wrap v, Trace& trace) const {
    if (!is_finite(uv)) return glm::dvec4(not_a_number);
    const int x = wrapped(std::floor(uv.x * image_.width), image_.width, u);
    const int y = wrapped(std::floor(uv.y * image_.height), image_.height, v);
    trace.decide(x);
    trace.decide(y);
    return at(x, y);
}

void SceneTexels::request(const Scene& scene, const Material& material) {
    for (const TextureSlotInfo& slot : texture_slots) {
        const Texture* const texture = find_texture(material, slot.slot);
        if (texture == nullptr) continue;
        const auto key = std::pair(texture->image, slot.use);
        if (texels_.contains(key) || unreadable_.contains(texture->image)) continue;
        const ImageSource& source = scene.images[texture->image];
        try {
            texels_.emplace(key, Texels(decode(source, slot.use)));
        } catch (const FileError& error) {
            if (source.is_required) throw;
            unreadable_.emplace(texture->image, error.what());
        }
    }
}

glm::dvec4 SceneTexels::look_up(const Texture& texture, ImageUse use, const glm::dvec2& uv,
                                Trace& trace) const {
    const Texels& texels = get(texture.image, use);
    trace.look_up({uv * glm::dvec2(texels.width(), texels.height()), 0.0});
    const glm::dvec4 value = texture.filter == TextureFilter::nearest
                                 ? texels.nearest(uv, texture.wrap_u, texture.wrap_v, trace)
                                 : texels.bilinear(uv, texture.wrap_u, texture.wrap_v);
    if (Recorder* const recorder = trace.recorder()) {
        ProbeLookup lookup;
        lookup.image = texture.image;
        lookup.use = use;
        lookup.second_texcoords = texture.second_texcoords;
        lookup.filter = texture.filter;
        lookup.size = {texels.width(), texels.height()};
        lookup.texcoord = uv;
        lookup.texel = uv * glm::dvec2(lookup.size);
        lookup.value = value;
        recorder->add_lookup(lookup);
    }
    return value;
}

// Environments

namespace {

using std::numbers::pi;

/// Returns the samples of a blurred lookup. They are so many that the mean of a smooth environment
/// has an error of about a thousandth.
const std::vector<FacetSample>& blur_samples() {
    constexpr unsigned count = 1024;
    static const std::vector<FacetSample> samples = [] {
        std::vector<FacetSample> all;
        for (unsigned i = 0; i < count; ++i)
            all.push_back(facet_sample(hammersley(i, count)));
        return all;
    }();
    return samples;
}

/// Returns a right-handed basis with this unit vector as its z axis.
glm::dmat3 basis_about(const glm::dvec3& z) {
    const glm::dvec3 axis = std::abs(z.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 x = glm::normalize(glm::cross(axis, z));
    return {x, glm::cross(z, x), z};
}

/// Returns the images of an environment: six faces for a right-handed world, or one image.
std::vector<Image> images_of(const Environment& environment) {
    const auto decoded = [](const ImageSource& source) { return decode(source, ImageUse::color); };
    std::vector<Image> images;
    if (const auto* faces = std::get_if<CubeFaces>(&environment.source)) {
        for (const ImageSource& face : faces->faces)
            images.push_back(decoded(face));
        check_faces(images, faces->faces.front().name);
        if (faces->left_handed) images = other_handed(images);
    } else if (const auto* cross = std::get_if<CubeCross>(&environment.source)) {
        images = faces_of_cross(decoded(cross->image), cross->image.name);
    } else if (const auto* panorama = std::get_if<Equirectangular>(&environment.source)) {
        images.push_back(decoded(panorama->image));
    } else if (const auto* probe = std::get_if<AngularMap>(&environment.source)) {
        images.push_back(decoded(probe->image));
        check_angular_map(images.front(), probe->image.name);
    }
    return images;
}

}  // namespace

EnvironmentLookup::EnvironmentLookup(const Environment& environment, Report& report)
    : intensity_(static_cast<double>(environment.intensity)),
      turn_(portable::cos(static_cast<double>(environment.rotation)),
            portable::sin(static_cast<double>(environment.rotation))) {
    for (const Image& image : images_of(environment))
        images_.emplace_back(storable_radiance(image, report));
    if (std::holds_alternative<Equirectangular>(environment.source)) {
        layout_ = Layout::equirectangular;
    } else if (std::holds_alternative<AngularMap>(environment.source)) {
        layout_ = Layout::angular;
    }
    if (images_.front().width() == 0) throw InvalidInput("the environment has no texels");
    if (environment.lights) irradiance_ = irradiance_sh(faces());
}

/// Returns a texel of a face, or beyond its border the texel of the adjacent face. Beyond a corner,
/// where three faces meet, it is the mean of their texels.
glm::dvec3 EnvironmentLookup::face_texel(std::size_t face, int x, int y) const {
    const int size = images_[face].width();
    if (x >= 0 && x < size && y >= 0 && y < size) return images_[face].at(x, y);
    const int inside_x = std::clamp(x, 0, size - 1);
    const int inside_y = std::clamp(y, 0, size - 1);
    if (x != inside_x && y != inside_y) {
        return (face_texel(face, inside_x, inside_y) + face_texel(face, x, inside_y) +
                face_texel(face, inside_x, y)) /
               3.0;
    }
    const FacePoint across = face_point(
        face_direction(face, (2.0 * x + 1.0) / size - 1.0, (2.0 * y + 1.0) / size - 1.0));
    const auto texel = [&](double s) {
        return std::clamp(static_cast<int>((s * 0.5 + 0.5) * size), 0, size - 1);
    };
    return images_[across.face].at(texel(across.s), texel(across.t));
}

glm::dvec3 EnvironmentLookup::face_radiance(const glm::dvec3& direction) const {
    const FacePoint point = face_point(direction);
    const glm::dvec2 position = (glm::dvec2(point.s, point.t) * 0.5 + 0.5) *
                                    static_cast<double>(images_[point.face].width()) -
                                0.5;
    const glm::dvec2 corner = glm::floor(position);
    const glm::dvec2 share = position - corner;
    const int x = static_cast<int>(corner.x);
    const int y = static_cast<int>(corner.y);
    const auto texel = [&](int right, int down) {
        return face_texel(point.face, x + right, y + down);
    };
    return glm::mix(glm::mix(texel(0, 0), texel(1, 0), share.x),
                    glm::mix(texel(0, 1), texel(1, 1), share.x), share.y);
}

glm::dvec3 EnvironmentLookup::in_map(const glm::dvec3& direction_world) const {
    const glm::dvec3& d = direction_world;
    return {turn_.x * d.x - turn_.y * d.z, d.y, turn_.y * d.x + turn_.x * d.z};
}

glm::dvec3 EnvironmentLookup::radiance(const glm::dvec3& direction_world) const {
    return map_radiance(in_map(direction_world));
}

glm::dvec3 EnvironmentLookup::map_radiance(const glm::dvec3& direction_map) const {
    const glm::dvec3 d = glm::normalize(direction_map);
    glm::dvec3 result(0.0);
    if (layout_ == Layout::faces) {
        result = face_radiance(d);
    } else if (layout_ == Layout::equirectangular) {
        const double across = std::hypot(d.x, d.z);
        const glm::dvec2 uv(0.5 + portable::atan2(d.x, -d.z) / (2.0 * pi),
                            0.5 - portable::atan2(d.y, across) / pi);
        result = images_.front().bilinear(uv, Wrap::repeat, Wrap::clamp);
    } else {
        const glm::dvec2 uv = angular_map_place(d, images_.front().width());
        result = images_.front().bilinear(uv, Wrap::clamp, Wrap::clamp);
    }
    return result * intensity_;
}

glm::dvec3 EnvironmentLookup::looked_up(const glm::dvec3& direction_world, Trace& trace) const {
    // The number of texels in a radian where they are smallest, at the corner of a face. A panorama
    // becomes a cube map of a quarter of its width.
    const int width = images_.front().width();
    const double size = layout_ == Layout::faces ? width : width / 4.0;
    trace.look_up(glm::normalize(direction_world) * size);
    return radiance(direction_world);
}

glm::dvec3 EnvironmentLookup::blurred(const glm::dvec3& direction_world, double roughness,
                                      Trace& trace) const {
    if (roughness <= 0.0) return looked_up(direction_world, trace);
    if (!trace.needs_radiance()) return glm::dvec3(0.0);
    const glm::dmat3 world_from_local = basis_about(glm::normalize(direction_world));
    glm::dvec3 sum(0.0);
    double weights = 0.0;
    for (const FacetSample& sample : blur_samples()) {
        const glm::dvec3 h = ggx_facet(sample, roughness * roughness);
        const glm::dvec3 light = 2.0 * h.z * h - glm::dvec3(0, 0, 1);
        if (light.z <= 0.0) continue;
        sum += radiance(world_from_local * light) * light.z;
        weights += light.z;
    }
    return sum / weights;
}

/// Returns six faces of the environment. A panorama or probe becomes faces of a quarter of its
/// width, each texel the mean of four lookups.
std::vector<Image> EnvironmentLookup::faces() const {
    const int wide = images_.front().width();
    const int size = layout_ == Layout::faces ? wide : std::max((wide + 3) / 4, 2);
    std::vector<Image> faces(6, make_image(size, size, 3, 32, ColorSpace::linear));
    for (std::size_t face = 0; face < 6; ++face) {
        const std::span<float> samples = faces[face].as<float>();
        for (int texel = 0; texel < size * size; ++texel) {
            const glm::dvec3 mean = texel_mean(face, texel % size, texel / size, size);
            for (int i = 0; i < 3; ++i)
                samples[static_cast<std::size_t>(3 * texel + i)] = static_cast<float>(mean[i]);
        }
    }
    return faces;
}

glm::dvec3 EnvironmentLookup::texel_mean(std::size_t face, int x, int y, int size) const {
    if (layout_ == Layout::faces) return glm::dvec3(images_[face].at(x, y)) * intensity_;
    glm::dvec3 sum(0.0);
    for (const double down : {0.25, 0.75}) {
        for (const double right : {0.25, 0.75}) {
            sum += map_radiance(face_direction(face, 2.0 * (x + right) / size - 1.0,
                                               2.0 * (y + down) / size - 1.0));
        }
    }
    return sum / 4.0;
}

glm::dvec3 EnvironmentLookup::diffuse(const glm::dvec3& normal_world) const {
    return glm::max(irradiance_over_pi(irradiance_, in_map(normal_world)), 0.0);
}

glm::dvec2 directional_albedo(double n_dot_v, double roughness) {
    // A surface seen edge-on gets the limit.
    return environment_brdf(std::max(n_dot_v, 1e-4), roughness);
}

// The picture behind transmissive surfaces

glm::dvec4 PictureBehind::Level::bilinear(const glm::dvec2& place) const {
    const glm::dvec2 scaled = place * glm::dvec2(width, height) - 0.5;
    const glm::dvec2 first = glm::floor(scaled);
    const glm::dvec2 share = scaled - first;
    const auto at = [&](double x, double y) {
        const auto column = static_cast<std::size_t>(std::clamp(x, 0.0, width - 1.0));
        const auto row = static_cast<std::size_t>(std::clamp(y, 0.0, height - 1.0));
        return texels[row * static_cast<std::size_t>(width) + column];
    };
    return glm::mix(glm::mix(at(first.x, first.y), at(first.x + 1.0, first.y), share.x),
                    glm::mix(at(first.x, first.y + 1.0), at(first.x + 1.0, first.y + 1.0), share.x),
                    share.y);
}

PictureBehind::PictureBehind(const Scene& scene, Level picture, std::vector<std::uint8_t> edges)
    : view_from_world_(glm::inverse(glm::dmat4(scene.camera->world_from_view))),
      half_size_(half_height(*scene.camera) * picture.width / picture.height,
                 half_height(*scene.camera)),
      is_orthographic_(scene.camera->orthographic_height.has_value()),
      background_(glm::dvec3(scene.background) * static_cast<double>(scene.background.a)),
      edges_(std::move(edges)) {
    levels_.push_back(std::move(picture));
    while (levels_.back().width > 1 || levels_.back().height > 1) {
        const Level& before = levels_.back();
        Level level{std::max(before.width / 2, 1), std::max(before.height / 2, 1), {}};
        for (int y = 0; y < level.height; ++y) {
            for (int x = 0; x < level.width; ++x)
                level.texels.push_back(
                    before.bilinear({(x + 0.5) / level.width, (y + 0.5) / level.height}));
        }
        levels_.push_back(std::move(level));
    }
}

std::optional<glm::dvec2> PictureBehind::place_of(const glm::dvec3& position_world) const {
    const glm::dvec3 view(view_from_world_ * glm::dvec4(position_world, 1.0));
    const double w = is_orthographic_ ? 1.0 : -view.z;
    if (!(w > 0.0)) return std::nullopt;
    const glm::dvec2 place = glm::dvec2(view) / (w * half_size_);
    return glm::clamp(glm::dvec2(0.5 + 0.5 * place.x, 0.5 - 0.5 * place.y), 0.0, 1.0);
}

bool PictureBehind::touches_edge(const glm::dvec2& place) const {
    const Level& picture = levels_.front();
    const glm::dvec2 scaled = place * glm::dvec2(picture.width, picture.height) - 0.5;
    // Weights below a millionth do not count.
    for (double y = std::floor(scaled.y + 1e-6); y <= std::ceil(scaled.y - 1e-6); y += 1.0) {
        for (double x = std::floor(scaled.x + 1e-6); x <= std::ceil(scaled.x - 1e-6); x += 1.0) {
            const double column = std::clamp(x, 0.0, picture.width - 1.0);
            const double row = std::clamp(y, 0.0, picture.height - 1.0);
            if (edges_[static_cast<std::size_t>(row * picture.width + column)] != 0) return true;
        }
    }
    return false;
}

glm::dvec3 PictureBehind::look_up(const glm::dvec3& position_world,
                                  const glm::dvec3& alternative_world, double blur,
                                  Trace& trace) const {
    std::optional<glm::dvec2> place = place_of(position_world);
    trace.decide(place ? 1 : 0);
    if (!place) place = place_of(alternative_world);
    if (!place) return glm::dvec3(0.0);
    const double level = blur * static_cast<double>(levels_.size() - 1);
    const double sharper = std::floor(level);
    const Level& first = levels_[static_cast<std::size_t>(sharper)];
    glm::dvec4 texel = first.bilinear(*place);
    if (level > sharper)
        texel = glm::mix(texel, levels_[static_cast<std::size_t>(sharper) + 1].bilinear(*place),
                         level - sharper);
    if (level < 1.0 && touches_edge(*place)) trace.doubt();
    return glm::dvec3(texel) + (1.0 - texel.a) * background_;
}

}  // namespace relief::shade::reference
