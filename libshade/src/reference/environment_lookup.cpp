// SPDX-License-Identifier: Apache-2.0
// The environment by direction, in double. World space, linear light. See environment_lookup.h.
// Bilinear, across the edges of faces as well (OpenGL's seamless cube maps).
// Tests: tests/shade/reference/environment_lookup_test.cpp.
#include "reference/environment_lookup.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "environment/angular_map.h"
#include "environment/cube_faces.h"
#include "scene/image_source.h"

namespace relief::reference {

namespace {

using std::numbers::pi;

/// Directions drawn for a blurred lookup: enough for the mean of a smooth environment to settle to
/// a thousandth.
constexpr std::uint32_t blur_samples = 1024;

/// A point of the square with evenly spread ones: Hammersley's, in base 2.
glm::dvec2 hammersley(std::uint32_t index, std::uint32_t count) {
    std::uint32_t bits = index;
    bits = (bits << 16) | (bits >> 16);
    bits = ((bits & 0x55555555U) << 1) | ((bits & 0xAAAAAAAAU) >> 1);
    bits = ((bits & 0x33333333U) << 2) | ((bits & 0xCCCCCCCCU) >> 2);
    bits = ((bits & 0x0F0F0F0FU) << 4) | ((bits & 0xF0F0F0F0U) >> 4);
    bits = ((bits & 0x00FF00FFU) << 8) | ((bits & 0xFF00FF00U) >> 8);
    return {(index + 0.5) / count, bits * 0x1p-32};
}

/// A microfacet's normal about z, drawn from GGX's distribution times its cosine.
glm::dvec3 ggx_normal(const glm::dvec2& point, double roughness) {
    const double alpha = roughness * roughness;
    const double cosine = std::sqrt((1.0 - point.x) / (1.0 + (alpha * alpha - 1.0) * point.x));
    const double sine = std::sqrt(std::max(1.0 - cosine * cosine, 0.0));
    const double around = 2.0 * pi * point.y;
    return {sine * std::cos(around), sine * std::sin(around), cosine};
}

/// Two directions that complete a unit one to a right-handed basis.
glm::dmat3 basis_about(const glm::dvec3& z) {
    const glm::dvec3 axis = std::abs(z.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 x = glm::normalize(glm::cross(axis, z));
    return {x, glm::cross(z, x), z};
}

/// Face, and where on it: s and t from -1 to 1, t down. OpenGL 3.3, table 3.10.
struct FacePoint {
    std::size_t face;
    glm::dvec2 st;
};

FacePoint on_face(const glm::dvec3& d) {
    const glm::dvec3 size = glm::abs(d);
    if (size.x >= size.y && size.x >= size.z) {
        return d.x > 0.0 ? FacePoint{0, glm::dvec2(-d.z, -d.y) / size.x}
                         : FacePoint{1, glm::dvec2(d.z, -d.y) / size.x};
    }
    if (size.y >= size.z) {
        return d.y > 0.0 ? FacePoint{2, glm::dvec2(d.x, d.z) / size.y}
                         : FacePoint{3, glm::dvec2(d.x, -d.z) / size.y};
    }
    return d.z > 0.0 ? FacePoint{4, glm::dvec2(d.x, -d.y) / size.z}
                     : FacePoint{5, glm::dvec2(-d.x, -d.y) / size.z};
}

glm::dvec3 direction_on_face(std::size_t face, double s, double t) {
    switch (face) {
        case 0:
            return {1, -t, -s};
        case 1:
            return {-1, -t, s};
        case 2:
            return {s, 1, t};
        case 3:
            return {s, -1, -t};
        case 4:
            return {s, -t, 1};
        default:
            return {-s, -t, -1};
    }
}

/// Spherical harmonics of order 2, real, at a unit direction.
std::array<double, 9> harmonics_at(const glm::dvec3& d) {
    return {0.282094791773878,
            0.488602511902920 * d.y,
            0.488602511902920 * d.z,
            0.488602511902920 * d.x,
            1.092548430592079 * d.x * d.y,
            1.092548430592079 * d.y * d.z,
            0.315391565252520 * (3.0 * d.z * d.z - 1.0),
            1.092548430592079 * d.x * d.z,
            0.546274215296040 * (d.x * d.x - d.y * d.y)};
}

glm::dvec3 finite_or_zero(const glm::dvec3& radiance) {
    glm::dvec3 result(0.0);
    for (int i = 0; i < 3; ++i) {
        if (std::isfinite(radiance[i])) result[i] = radiance[i];
    }
    return result;
}

}  // namespace

EnvironmentLookup::EnvironmentLookup(const Environment& environment)
    : intensity_(static_cast<double>(environment.intensity)) {
    const auto add = [&](const ImageSource& source) {
        images_.emplace_back(decode(source, ImageUse::color));
    };
    if (const auto* faces = std::get_if<CubeFaces>(&environment.source)) {
        left_handed_ = faces->left_handed;
        for (const ImageSource& face : faces->faces)
            add(face);
    } else if (const auto* cross = std::get_if<CubeCross>(&environment.source)) {
        const Image image = decode(cross->image, ImageUse::color);
        for (const Image& face : faces_of_cross(image, cross->image.name))
            images_.emplace_back(face);
    } else if (const auto* panorama = std::get_if<Equirectangular>(&environment.source)) {
        layout_ = Layout::equirectangular;
        add(panorama->image);
    } else if (const auto* probe = std::get_if<AngularMap>(&environment.source)) {
        layout_ = Layout::angular;
        add(probe->image);
    }
    if (environment.lights) project();
}

/// A texel of a face, or beyond its border the one across the edge that the faces share. Beyond a
/// corner, where three faces meet, their mean.
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
    const FacePoint across = on_face(
        direction_on_face(face, (2.0 * x + 1.0) / size - 1.0, (2.0 * y + 1.0) / size - 1.0));
    const glm::dvec2 place =
        glm::clamp(glm::floor((across.st * 0.5 + 0.5) * static_cast<double>(size)), glm::dvec2(0.0),
                   glm::dvec2(size - 1.0));
    return images_[across.face].at(static_cast<int>(place.x), static_cast<int>(place.y));
}

glm::dvec3 EnvironmentLookup::face_radiance(const glm::dvec3& direction) const {
    const glm::dvec3 d =
        left_handed_ ? glm::dvec3(-direction.x, direction.y, direction.z) : direction;
    const FacePoint point = on_face(d);
    const glm::dvec2 place =
        (point.st * 0.5 + 0.5) * static_cast<double>(images_[point.face].width()) - 0.5;
    const glm::dvec2 corner = glm::floor(place);
    const glm::dvec2 share = place - corner;
    const int x = static_cast<int>(corner.x);
    const int y = static_cast<int>(corner.y);
    const auto texel = [&](int right, int down) {
        return face_texel(point.face, x + right, y + down);
    };
    return glm::mix(glm::mix(texel(0, 0), texel(1, 0), share.x),
                    glm::mix(texel(0, 1), texel(1, 1), share.x), share.y);
}

glm::dvec3 EnvironmentLookup::radiance(const glm::dvec3& direction_world) const {
    const glm::dvec3 d = glm::normalize(direction_world);
    glm::dvec3 found(0.0);
    if (layout_ == Layout::faces) {
        found = face_radiance(d);
    } else if (layout_ == Layout::equirectangular) {
        const double across = std::hypot(d.x, d.z);
        const glm::dvec2 uv(0.5 + std::atan2(d.x, -d.z) / (2.0 * pi),
                            0.5 - std::atan2(d.y, across) / pi);
        found = images_.front().bilinear(uv, TextureWrap::repeat, TextureWrap::clamp);
    } else {
        // The distance from the centre is the angle to -z; the rim, at 1, is +z all around, and its
        // own texels are left out.
        const double across = std::hypot(d.x, d.y);
        const double distance =
            std::min(std::atan2(across, -d.z) / pi, angular_map_reach(images_.front().width()));
        const glm::dvec2 way = across > 0.0 ? glm::dvec2(d.x, -d.y) / across : glm::dvec2(1, 0);
        const glm::dvec2 uv = 0.5 + 0.5 * distance * way;
        found = images_.front().bilinear(uv, TextureWrap::clamp, TextureWrap::clamp);
    }
    return finite_or_zero(found) * intensity_;
}

glm::dvec3 EnvironmentLookup::looked_up(const glm::dvec3& direction_world, Trace& trace) const {
    // Texels that pass by in a radian where they are finest, at the corner of a face; a panorama
    // becomes a cube map of a quarter of its width.
    const int width = images_.front().width();
    const double size = layout_ == Layout::faces ? width : width / 4.0;
    trace.look_up(glm::normalize(direction_world) * size);
    return radiance(direction_world);
}

glm::dvec3 EnvironmentLookup::blurred(const glm::dvec3& direction_world, double roughness,
                                      Trace& trace) const {
    if (roughness <= 0.0) return looked_up(direction_world, trace);
    const glm::dmat3 world_from_local = basis_about(glm::normalize(direction_world));
    glm::dvec3 sum(0.0);
    double weights = 0.0;
    for (std::uint32_t i = 0; i < blur_samples; ++i) {
        const glm::dvec3 h = ggx_normal(hammersley(i, blur_samples), roughness);
        const glm::dvec3 light = 2.0 * h.z * h - glm::dvec3(0, 0, 1);
        if (light.z <= 0.0) continue;
        sum += radiance(world_from_local * light) * light.z;
        weights += light.z;
    }
    return sum / weights;
}

void EnvironmentLookup::project() {
    const int wide = images_.front().width();
    const int grid = std::clamp(layout_ == Layout::faces ? wide : wide / 2, 64, 1024);
    double whole = 0.0;
    for (std::size_t face = 0; face < 6; ++face) {
        for (int y = 0; y < grid; ++y) {
            for (int x = 0; x < grid; ++x) {
                const glm::dvec3 way = direction_on_face(face, (2.0 * x + 1.0) / grid - 1.0,
                                                         (2.0 * y + 1.0) / grid - 1.0);
                const double solid_angle = std::pow(glm::dot(way, way), -1.5);
                whole += solid_angle;
                const glm::dvec3 light = radiance(way) * solid_angle;
                const std::array<double, 9> at = harmonics_at(glm::normalize(way));
                for (std::size_t i = 0; i < 9; ++i)
                    harmonics_.at(i) += light * at.at(i);
            }
        }
    }
    for (glm::dvec3& coefficient : harmonics_)
        coefficient *= 4.0 * pi / whole;
}

glm::dvec3 EnvironmentLookup::diffuse(const glm::dvec3& normal_world) const {
    // The clamped cosine's own coefficients, over pi.
    constexpr std::array<double, 9> cosine{1.0,  2.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0, 0.25,
                                           0.25, 0.25,      0.25,      0.25};
    const std::array<double, 9> at = harmonics_at(normal_world);
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i < 9; ++i)
        sum += harmonics_.at(i) * (cosine.at(i) * at.at(i));
    return glm::max(sum, 0.0);
}

glm::dvec2 directional_albedo(double n_dot_v, double roughness) {
    const glm::dvec3 view(std::sqrt(std::max(1.0 - n_dot_v * n_dot_v, 0.0)), 0.0, n_dot_v);
    const double alpha = roughness * roughness;
    const auto smith = [&](double cosine) {
        return std::sqrt(cosine * cosine * (1.0 - alpha * alpha) + alpha * alpha);
    };
    glm::dvec2 sum(0.0);
    for (std::uint32_t i = 0; i < blur_samples; ++i) {
        const glm::dvec3 h = ggx_normal(hammersley(i, blur_samples), roughness);
        const double v_dot_h = glm::dot(view, h);
        const glm::dvec3 light = 2.0 * v_dot_h * h - view;
        if (light.z <= 0.0 || v_dot_h <= 0.0) continue;
        const double visibility = 0.5 / (light.z * smith(n_dot_v) + n_dot_v * smith(light.z));
        const double weight = 4.0 * visibility * light.z * v_dot_h / h.z;
        const double grazing = std::pow(1.0 - v_dot_h, 5.0);
        sum += weight * glm::dvec2(1.0 - grazing, grazing);
    }
    return sum / static_cast<double>(blur_samples);
}

}  // namespace relief::reference
