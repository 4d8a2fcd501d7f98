// SPDX-License-Identifier: Apache-2.0
// The images of an environment, and the built-in studio; environment_images.h has the conventions.
// Angular maps are computed in double; their GLSL counterpart is in gl/cube_map.cpp. Images that do
// not fit together throw InvalidInput.
#include "environment/environment_images.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "portable_math.h"
#include "relief/mesh/report.h"
#include "relief/shade/environment.h"
#include "relief/shade/lights.h"
#include "relief/shade/shared.h"

namespace relief::shade {
using namespace relief::shade::detail;

// Cube faces

namespace {

/// Returns an image of this size whose texel (x, y) is the texel source(x, y) of another image.
template <typename Source>
Image rearranged(const Image& from, int width, int height, Source source) {
    Image to = make_image(width, height, from.channels, from.bits(), from.color_space);
    const auto channels = static_cast<std::size_t>(from.channels);
    std::visit(
        [&](const auto& samples) {
            auto& moved = std::get<std::decay_t<decltype(samples)>>(to.samples);
            std::size_t i = 0;
            for (int y = 0; y < height; ++y) {
                for (int x = 0; x < width; ++x) {
                    const glm::ivec2 from_texel = source(x, y);
                    const auto texel = static_cast<std::size_t>(from_texel.y) *
                                           static_cast<std::size_t>(from.width) +
                                       static_cast<std::size_t>(from_texel.x);
                    for (std::size_t c = 0; c < channels; ++c)
                        moved[i++] = samples[texel * channels + c];
                }
            }
        },
        from.samples);
    return to;
}

/// The columns and rows of the faces in a cross.
using Cells = std::array<glm::ivec2, 6>;
constexpr Cells horizontal_cells{{{2, 1}, {0, 1}, {1, 0}, {1, 2}, {1, 1}, {3, 1}}};
constexpr Cells vertical_cells{{{2, 1}, {0, 1}, {1, 0}, {1, 2}, {1, 1}, {1, 3}}};

/// Returns the integral of 1 / (1 + s^2 + t^2)^(3/2) from (0, 0).
double corner_solid_angle(double s, double t) {
    return relief::detail::portable::atan2(s * t, std::sqrt(1.0 + s * s + t * t));
}

}  // namespace

const std::array<glm::mat3, 6>& detail::world_from_face() {
    static const std::array<glm::mat3, 6> matrices{
        glm::mat3{{0, 0, -1}, {0, -1, 0}, {1, 0, 0}}, glm::mat3{{0, 0, 1}, {0, -1, 0}, {-1, 0, 0}},
        glm::mat3{{1, 0, 0}, {0, 0, 1}, {0, 1, 0}},   glm::mat3{{1, 0, 0}, {0, 0, -1}, {0, -1, 0}},
        glm::mat3{{1, 0, 0}, {0, -1, 0}, {0, 0, 1}},  glm::mat3{{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}},
    };
    return matrices;
}

glm::dvec3 detail::face_direction(std::size_t face, double s, double t) {
    return glm::dmat3(world_from_face().at(face)) * glm::dvec3(s, t, 1.0);
}

FacePoint detail::face_point(const glm::dvec3& direction) {
    const glm::dvec3 size = glm::abs(direction);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
    const std::size_t face = 2 * static_cast<std::size_t>(axis) + (direction[axis] < 0.0 ? 1 : 0);
    const glm::dvec3 point =
        glm::transpose(glm::dmat3(world_from_face().at(face))) * (direction / size[axis]);
    return {face, point.x, point.y};
}

double detail::solid_angle(const glm::dvec2& from, const glm::dvec2& to) {
    return corner_solid_angle(to.x, to.y) - corner_solid_angle(from.x, to.y) -
           corner_solid_angle(to.x, from.y) + corner_solid_angle(from.x, from.y);
}

void detail::check_faces(std::span<const Image> faces, std::string_view name) {
    if (faces.size() != 6) {
        throw InvalidInput(
            fmt::format("cube map '{}' has {} faces, but needs 6", name, faces.size()));
    }
    const Image& first = faces.front();
    for (std::size_t i = 0; i < faces.size(); ++i) {
        const Image& face = faces[i];
        const auto refuse = [&](const std::string& reason) {
            throw InvalidInput(
                fmt::format("cube map '{}': face {} {}", name, cube_face_names.at(i), reason));
        };
        if (face.empty()) refuse("has no texels");
        if (face.width != face.height) {
            refuse(fmt::format("has {} x {} texels, but must be square", face.width, face.height));
        }
        if (face.width != first.width) {
            refuse(fmt::format("has {0} x {0} texels, but face +x has {1} x {1}", face.width,
                               first.width));
        }
        if (face.bits() != first.bits() || face.channels != first.channels ||
            face.color_space != first.color_space) {
            refuse("differs from face +x in channels, bits or color space");
        }
    }
}

std::vector<Image> detail::faces_of_cross(const Image& cross, std::string_view name) {
    const bool is_horizontal = cross.width / 4 * 3 == cross.height && cross.width % 4 == 0;
    const bool is_vertical = cross.height / 4 * 3 == cross.width && cross.height % 4 == 0;
    if (cross.empty() || (!is_horizontal && !is_vertical)) {
        throw InvalidInput(
            fmt::format("cross '{}' has {} x {} texels, but the faces of a cube "
                        "lie in 4 x 3 (horizontal) or "
                        "3 x 4 (vertical) squares",
                        name, cross.width, cross.height));
    }
    const int size = is_horizontal ? cross.width / 4 : cross.width / 3;
    std::vector<Image> faces;
    for (std::size_t face = 0; face < 6; ++face) {
        const glm::ivec2 corner =
            (is_horizontal ? horizontal_cells : vertical_cells).at(face) * size;
        const bool is_rotated = is_vertical && face == 5;
        faces.push_back(rearranged(cross, size, size, [&](int x, int y) {
            const glm::ivec2 texel(x, y);
            return corner + (is_rotated ? glm::ivec2(size - 1) - texel : texel);
        }));
    }
    return faces;
}

std::vector<Image> detail::other_handed(std::span<const Image> faces) {
    std::vector<Image> mirrored;
    for (const std::size_t face : {1U, 0U, 2U, 3U, 4U, 5U}) {
        const Image& from = faces[face];
        mirrored.push_back(rearranged(from, from.width, from.height, [&](int x, int y) {
            return glm::ivec2(from.width - 1 - x, y);
        }));
    }
    return mirrored;
}

// Angular maps

double detail::angular_map_reach(int width) {
    return std::max(0.0, 1.0 - 2.0 * angular_map_rim / width);
}

glm::dvec2 detail::angular_map_place(const glm::dvec3& direction, int width) {
    const double across = std::hypot(direction.x, direction.y);
    const double angle = relief::detail::portable::atan2(across, -direction.z) / std::numbers::pi;
    const double radius = std::min(angle, angular_map_reach(width));
    const glm::dvec2 side = across > 0.0 ? glm::dvec2(direction) / across : glm::dvec2(1.0, 0.0);
    return {0.5 + 0.5 * radius * side.x, 0.5 - 0.5 * radius * side.y};
}

void detail::check_angular_map(const Image& image, std::string_view name) {
    if (image.empty()) throw InvalidInput(fmt::format("angular map '{}' has no texels", name));
    if (image.width != image.height) {
        throw InvalidInput(fmt::format("angular map '{}' has {} x {} texels, but must be square",
                                       name, image.width, image.height));
    }
}

// Radiance

namespace {

/// Returns the nearest value that radiance may have; changes are counted.
float storable(float value, std::size_t texel, Report& report) {
    if (std::isfinite(value) && std::abs(value) <= max_light) return value;
    if (!std::isfinite(value)) {
        report.add("radiance that is not finite", "texel", texel,
                   "counts as 65504 if positive infinity, else as 0");
        return value > 0.0F ? max_half : 0.0F;
    }
    report.add("radiance beyond 1e18", "texel", texel, "is clamped to 1e18");
    return std::copysign(max_light, value);
}

}  // namespace

Image detail::storable_radiance(const Image& image, Report& report) {
    Image linear = to_linear(image);
    const auto samples = linear.as<float>();
    const auto channels = static_cast<std::size_t>(linear.channels);
    for (std::size_t i = 0; i < samples.size(); ++i)
        samples[i] = storable(samples[i], i / channels, report);
    return linear;
}

bool detail::fits_half_floats(const Image& radiance) {
    const auto samples = radiance.as<float>();
    return std::all_of(samples.begin(), samples.end(),
                       [](float sample) { return std::abs(sample) <= max_half; });
}

// The studio

namespace {

/// A light with soft edges: a rectangle of angles around its center, in degrees.
struct Softbox {
    double azimuth = 0.0;  ///< From +z towards +x.
    double elevation = 0.0;
    double half_width = 0.0;
    double half_height = 0.0;
    double radiance = 0.0;
};

constexpr std::array studio_lights = {
    Softbox{-40.0, 38.0, 24.0, 18.0, 6.0},  // The key light.
    Softbox{65.0, 15.0, 14.0, 26.0, 1.4},   // Fills the shadows.
    Softbox{-150.0, 25.0, 5.0, 32.0, 4.5},  // Two strips outline the model.
    Softbox{150.0, 25.0, 5.0, 32.0, 4.5},
};
constexpr double ceiling_radiance = 2.0;

/// Rises from 0 at -1 to 1 at 1, with a slope of 0 at both.
double smooth(double x) {
    const double t = std::clamp(0.5 * (x + 1.0), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

/// \param azimuth, elevation  in degrees
double studio_radiance(double azimuth, double elevation) {
    constexpr double edge = 2.0;  // Half of the width of soft edges, in degrees.
    double radiance = 0.07 + 0.14 * smooth(elevation / 90.0);
    for (const Softbox& light : studio_lights) {
        const double across = std::abs(std::remainder(azimuth - light.azimuth, 360.0));
        const double up = std::abs(elevation - light.elevation);
        radiance += light.radiance * smooth((light.half_width - across) / edge) *
                    smooth((light.half_height - up) / edge);
    }
    return radiance + ceiling_radiance * smooth((elevation - 68.0) / edge);
}

Image studio_image() {
    constexpr int height = 256;
    constexpr int width = 2 * height;
    Image image = make_image(width, height, 3, 32, ColorSpace::linear);
    const auto samples = image.as<float>();
    std::size_t next = 0;
    for (int y = 0; y < height; ++y) {
        const double elevation = 90.0 - 180.0 * (y + 0.5) / height;
        for (int x = 0; x < width; ++x) {
            // The center of a panorama is -z, and +x is to its right.
            const double azimuth = 180.0 - 360.0 * ((x + 0.5) / width - 0.5);
            const auto radiance = static_cast<float>(studio_radiance(azimuth, elevation));
            for (int channel = 0; channel < 3; ++channel)
                samples[next++] = radiance;
        }
    }
    return image;
}

constexpr const char* studio_name = "studio";

}  // namespace

Environment studio_environment() {
    static const Shared<Image> image = studio_image();
    Environment environment;
    environment.source = Equirectangular{{studio_name, image}};
    environment.skybox = false;
    environment.lights = true;
    return environment;
}

bool is_studio(const Environment& environment) {
    const auto* panorama = std::get_if<Equirectangular>(&environment.source);
    return panorama != nullptr && panorama->image.name == studio_name &&
           std::holds_alternative<Shared<Image>>(panorama->image.source);
}

}  // namespace relief::shade
