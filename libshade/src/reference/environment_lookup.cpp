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
#include "environment/environment_brdf.h"
#include "environment/ggx.h"
#include "environment/radiance.h"
#include "relief/mesh/error.h"
#include "relief/shade/image_source.h"

namespace relief::reference {

namespace {

using std::numbers::pi;

/// Directions drawn for a blurred lookup: enough for the mean of a smooth environment to settle to
/// a thousandth.
constexpr unsigned blur_samples = 1024;

/// Two directions that complete a unit one to a right-handed basis.
glm::dmat3 basis_about(const glm::dvec3& z) {
    const glm::dvec3 axis = std::abs(z.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 x = glm::normalize(glm::cross(axis, z));
    return {x, glm::cross(z, x), z};
}

/// The images of an environment: six faces for our world, or one.
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
    : intensity_(static_cast<double>(environment.intensity)) {
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
    const FacePoint across = face_point(
        face_direction(face, (2.0 * x + 1.0) / size - 1.0, (2.0 * y + 1.0) / size - 1.0));
    const auto texel = [&](double s) {
        return std::clamp(static_cast<int>((s * 0.5 + 0.5) * size), 0, size - 1);
    };
    return images_[across.face].at(texel(across.s), texel(across.t));
}

glm::dvec3 EnvironmentLookup::face_radiance(const glm::dvec3& direction) const {
    const FacePoint point = face_point(direction);
    const glm::dvec2 place = (glm::dvec2(point.s, point.t) * 0.5 + 0.5) *
                                 static_cast<double>(images_[point.face].width()) -
                             0.5;
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
        const glm::dvec2 uv = angular_map_place(d, images_.front().width());
        found = images_.front().bilinear(uv, TextureWrap::clamp, TextureWrap::clamp);
    }
    return found * intensity_;
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
    for (unsigned i = 0; i < blur_samples; ++i) {
        const glm::dvec3 h = ggx_facet(hammersley(i, blur_samples), roughness * roughness);
        const glm::dvec3 light = 2.0 * h.z * h - glm::dvec3(0, 0, 1);
        if (light.z <= 0.0) continue;
        sum += radiance(world_from_local * light) * light.z;
        weights += light.z;
    }
    return sum / weights;
}

/// A panorama or probe becomes faces of a quarter of its width, each texel the mean of four
/// lookups.
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
            sum += radiance(face_direction(face, 2.0 * (x + right) / size - 1.0,
                                           2.0 * (y + down) / size - 1.0));
        }
    }
    return sum / 4.0;
}

glm::dvec3 EnvironmentLookup::diffuse(const glm::dvec3& normal_world) const {
    return glm::max(irradiance_over_pi(irradiance_, normal_world), 0.0);
}

glm::dvec2 directional_albedo(double n_dot_v, double roughness) {
    // Where the surface is seen edge-on, what it tends to.
    return environment_brdf(std::max(n_dot_v, 1e-4), roughness);
}

}  // namespace relief::reference
