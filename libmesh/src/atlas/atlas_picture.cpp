// SPDX-License-Identifier: Apache-2.0
#include "relief/mesh/atlas_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "atlas/atlas_stats.h"
#include "atlas/flatten.h"
#include "portable_math.h"
#include "progress_stage.h"

namespace relief {
using namespace relief::detail;

namespace {

/// Each pixel is the mean of 2 x 2 samples.
constexpr int samples_per_pixel = 2;
constexpr double largest_stretch = 4.0;

constexpr glm::vec3 blue(59.0F, 76.0F, 192.0F);
constexpr glm::vec3 gray(221.0F, 221.0F, 221.0F);
constexpr glm::vec3 red(180.0F, 4.0F, 38.0F);
constexpr glm::vec3 border(20.0F, 20.0F, 20.0F);

/// A color of full saturation at its hue, softened.
glm::vec3 chart_color(std::uint32_t chart) {
    // Steps of the golden ratio keep the hues of successive charts apart.
    const float hue = static_cast<float>((chart * 0x9E3779B9U) >> 8) / 0x1p24F * 6.0F;
    const auto channel = [&](float offset) {
        const float sum = hue + offset;
        const float position = sum < 6.0F ? sum : sum - 6.0F;
        return std::clamp(std::abs(position - 3.0F) - 1.0F, 0.0F, 1.0F);
    };
    return 90.0F + 150.0F * glm::vec3(channel(0.0F), channel(4.0F), channel(2.0F));
}

glm::vec3 mixed(const glm::vec3& from, const glm::vec3& to, double share) {
    return from + static_cast<float>(std::clamp(share, 0.0, 1.0)) * (to - from);
}

glm::vec3 density_color(double relative) {
    const double octaves = portable::log(std::max(relative, 1e-30)) / std::numbers::ln2;
    return octaves < 0.0 ? mixed(gray, blue, -octaves) : mixed(gray, red, octaves);
}

glm::vec3 stretch_color(double anisotropy) {
    return mixed(gray, red, portable::log(anisotropy) / portable::log(largest_stretch));
}

/// The samples of the picture: the triangle at each of them.
class SampledTriangles {
  public:
    SampledTriangles(const glm::ivec2& size, std::span<const glm::vec2> corner_texcoords,
                     std::span<const std::optional<std::uint32_t>> chart)
        : size_(size), triangles_(static_cast<std::size_t>(size.x) * size.y, no_face) {
        for (std::uint32_t t = 0; t < chart.size(); ++t) {
            check_cancelled(t);
            if (chart[t]) draw(t, corner_texcoords.subspan(3 * std::size_t{t}, 3));
        }
    }

    /// Returns no_face outside of the picture.
    [[nodiscard]] std::uint32_t at(int x, int y) const {
        if (x < 0 || y < 0 || x >= size_.x || y >= size_.y) return no_face;
        return triangles_[static_cast<std::size_t>(y) * size_.x + x];
    }

  private:
    void draw(std::uint32_t triangle, std::span<const glm::vec2> corners) {
        std::array<glm::dvec2, 3> p;
        for (std::size_t i = 0; i < 3; ++i)
            p[i] = glm::dvec2(corners[i]) * glm::dvec2(size_);
        const auto [low, high] = std::minmax({p[0].y, p[1].y, p[2].y});
        if (!(high >= 0.0 && low <= size_.y)) return;
        const int first = static_cast<int>(std::ceil(std::max(low, 0.5) - 0.5));
        const int last = static_cast<int>(std::floor(std::min(high, size_.y - 0.5) - 0.5));
        for (int row = first; row <= last; ++row)
            draw_row(triangle, p, row);
    }

    /// Fills the samples between the edges that cross a row.
    void draw_row(std::uint32_t triangle, const std::array<glm::dvec2, 3>& p, int row) {
        const double y = row + 0.5;
        double begin = size_.x;
        double end = 0.0;
        for (std::size_t i = 0; i < 3; ++i) {
            const glm::dvec2& a = p[i];
            const glm::dvec2& b = p[(i + 1) % 3];
            if (std::min(a.y, b.y) > y || std::max(a.y, b.y) < y) continue;
            const double x = a.y == b.y ? a.x : a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y));
            begin = std::min(begin, x);
            end = std::max({end, x, a.y == b.y ? b.x : x});
        }
        const int first = static_cast<int>(std::ceil(std::max(begin, 0.5) - 0.5));
        const int last = static_cast<int>(std::floor(std::min(end, size_.x - 0.5) - 0.5));
        if (first > last) return;
        std::uint32_t* const samples = &triangles_[static_cast<std::size_t>(row) * size_.x];
        std::fill(samples + first, samples + last + 1, triangle);
    }

    glm::ivec2 size_;
    std::vector<std::uint32_t> triangles_;
};

/// The color of each triangle.
std::vector<glm::vec3> colors_of(const Mesh& mesh, std::span<const glm::vec2> corner_texcoords,
                                 std::span<const std::optional<std::uint32_t>> chart,
                                 const glm::ivec2& size, AtlasPicture picture) {
    std::vector<glm::vec3> colors(mesh.triangles.size(), gray);
    if (picture == AtlasPicture::charts) {
        for (std::size_t t = 0; t < colors.size(); ++t)
            if (chart[t]) colors[t] = chart_color(*chart[t]);
        return colors;
    }
    const AtlasSurface surface = atlas_surface(mesh, {}, IgnoredReport());
    const std::vector<std::uint32_t> triangles = triangles_of_faces(surface);
    std::vector<Stretch> stretches(surface.faces.size());
    double area = 0.0;
    double map_area = 0.0;
    for (std::uint32_t face = 0; face < surface.faces.size(); ++face) {
        if (!chart[triangles[face]]) continue;
        stretches[face] =
            stretch_of(surface, face, texels_of(corner_texcoords, surface, triangles[face], size));
        stretches[face].smallest = std::abs(stretches[face].smallest);
        area += surface.areas[face];
        map_area += surface.areas[face] * stretches[face].largest * stretches[face].smallest;
    }
    for (std::size_t t = 0; t < colors.size(); ++t) {
        const std::uint32_t face = surface.face_of_triangle[t];
        if (face == no_face || !chart[t]) continue;
        const Stretch& stretch = stretches[face];
        if (picture == AtlasPicture::density)
            colors[t] =
                density_color(std::sqrt(stretch.largest * stretch.smallest * area / map_area));
        else if (stretch.smallest > 0.0)
            colors[t] = stretch_color(stretch.largest / stretch.smallest);
        else
            colors[t] = red;
    }
    return colors;
}

}  // namespace

Image draw_atlas(const Mesh& mesh, std::span<const glm::vec2> corner_texcoords,
                 std::span<const std::optional<std::uint32_t>> chart, const glm::ivec2& size,
                 AtlasPicture picture) {
    for (const int side : {size.x, size.y})
        if (side < 1 || side > 16384)
            throw InvalidInput(
                fmt::format("the size of the picture is {}, but must be 1 to 16384 pixels", side));
    validate(mesh);
    if (chart.size() != mesh.triangles.size() || corner_texcoords.size() != 3 * chart.size())
        throw InvalidInput(
            fmt::format("there are {} texture coordinates and {} charts for {} triangles",
                        corner_texcoords.size(), chart.size(), mesh.triangles.size()));
    const std::vector<glm::vec3> colors = colors_of(mesh, corner_texcoords, chart, size, picture);
    const SampledTriangles samples(samples_per_pixel * size, corner_texcoords, chart);
    Image image = make_image(size.x, size.y, 3, 8, ColorSpace::srgb);
    const auto color_at = [&](int x, int y) {
        const std::uint32_t triangle = samples.at(x, y);
        if (triangle == no_face) return glm::vec3(0.0F);
        const auto is_other = [&](std::uint32_t neighbor) {
            return neighbor == no_face || chart[neighbor] != chart[triangle];
        };
        return is_other(samples.at(x - 1, y)) || is_other(samples.at(x + 1, y)) ||
                       is_other(samples.at(x, y - 1)) || is_other(samples.at(x, y + 1))
                   ? border
                   : colors[triangle];
    };
    std::uint8_t* out = image.as<std::uint8_t>().data();
    for (int y = 0; y < size.y; ++y) {
        check_cancelled(static_cast<std::size_t>(y));
        for (int x = 0; x < size.x; ++x) {
            glm::vec3 sum(0.0F);
            for (int i = 0; i < samples_per_pixel; ++i)
                for (int j = 0; j < samples_per_pixel; ++j)
                    sum += color_at(samples_per_pixel * x + j, samples_per_pixel * y + i);
            const glm::vec3 mean = sum / static_cast<float>(samples_per_pixel * samples_per_pixel);
            for (int c = 0; c < 3; ++c)
                *out++ = static_cast<std::uint8_t>(mean[c] + 0.5F);
        }
    }
    return image;
}

}  // namespace relief
