// SPDX-License-Identifier: Apache-2.0
// Makes hard inputs for the stability experiments, and holds the textbook code that is measured
// with them.
#include "experiment_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

namespace relief::accuracy::detail {
namespace {

std::uint32_t added_vertex(Mesh& mesh, const glm::vec3& position) {
    mesh.positions.push_back(position);
    return static_cast<std::uint32_t>(mesh.positions.size() - 1);
}

glm::uvec3 hard_one(Mesh& mesh, const glm::uvec3& beside, HardTriangle kind) {
    const auto& [a, b, c] = std::array{beside.x, beside.y, beside.z};
    constexpr float no_number = std::numeric_limits<float>::quiet_NaN();
    switch (kind) {
        case HardTriangle::collapsed:
            return {a, b, b};
        case HardTriangle::coinciding:
            return {a, b, added_vertex(mesh, mesh.positions[b])};
        case HardTriangle::needle:
            return {a, b, added_vertex(mesh, 0.5F * (mesh.positions[a] + mesh.positions[b]))};
        case HardTriangle::nowhere:
            return {a, b, added_vertex(mesh, glm::vec3(no_number))};
        case HardTriangle::back:
            break;
    }
    return {a, c, b};
}

}  // namespace

Mesh with_hard_triangles(const Mesh& mesh, HardTriangle kind, std::size_t count) {
    Mesh hard;
    hard.positions = mesh.positions;
    hard.triangles = mesh.triangles;
    const std::size_t own = mesh.triangles.size();
    if (kind == HardTriangle::back) count = std::min(count, own);
    for (std::size_t i = 0; i < count; ++i) {
        const glm::uvec3 beside = mesh.triangles[i * own / count];
        hard.triangles.push_back(hard_one(hard, beside, kind));
    }
    return hard;
}

namespace {

/// Vectors that are evenly distributed in a spherical shell; the sequence is the same on every
/// machine.
class Directions {
  public:
    explicit Directions(std::uint32_t seed) : numbers_(seed) {}

    glm::dvec3 next() {
        for (;;) {
            const glm::dvec3 v(coordinate(), coordinate(), coordinate());
            const double length = glm::length(v);
            if (length > 0.3 && length < 1.0) return v;
        }
    }

  private:
    double coordinate() { return static_cast<double>(numbers_()) * 0x1p-31 - 1.0; }

    std::mt19937 numbers_;
};

}  // namespace

AnalyticMesh make_needles(std::size_t count, double width, std::uint32_t seed) {
    AnalyticMesh needles;
    Directions directions(seed);
    for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec3 along = glm::normalize(directions.next());
        const glm::dvec3 across = glm::normalize(glm::cross(along, directions.next()));
        const glm::vec3 b(along);
        const glm::vec3 a(width * directions.next());
        const glm::vec3 c(glm::dvec3(a) + width * across);
        // (b - a) x (c - a). Only a and c are close to each other, and both are small. The division
        // by the width keeps all products in the range of double.
        const glm::dvec3 side = (glm::dvec3(c) - glm::dvec3(a)) / width;
        const glm::dvec3 normal = glm::normalize(glm::cross(glm::dvec3(b) - glm::dvec3(a), side));
        const auto first = static_cast<std::uint32_t>(3 * i);
        const std::array corners = {a, b, c};
        for (std::size_t corner = 0; corner < 3; ++corner) {
            needles.mesh.positions.push_back(corners.at((corner + i) % 3));
            needles.normals.push_back(normal);
            needles.inner.push_back(1);
        }
        needles.mesh.triangles.emplace_back(first, first + 1, first + 2);
    }
    return needles;
}

namespace {

glm::vec3 over_length(const glm::vec3& v) {
    return v / std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
}

}  // namespace

std::vector<glm::vec3> textbook_area_normals(const Mesh& mesh) {
    std::vector<glm::vec3> sums(mesh.positions.size(), glm::vec3(0.0F));
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::vec3& a = mesh.positions[t.x];
        const glm::vec3 normal = glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a);
        for (int i = 0; i < 3; ++i)
            sums[t[i]] += normal;
    }
    for (glm::vec3& sum : sums)
        sum = over_length(sum);
    return sums;
}

std::vector<glm::vec3> textbook_angle_normals(const Mesh& mesh) {
    std::vector<glm::vec3> sums(mesh.positions.size(), glm::vec3(0.0F));
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::vec3& a = mesh.positions[t.x];
        const glm::vec3 normal =
            over_length(glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a));
        for (int i = 0; i < 3; ++i) {
            const glm::vec3& corner = mesh.positions[t[i]];
            const glm::vec3 to_next = over_length(mesh.positions[t[(i + 1) % 3]] - corner);
            const glm::vec3 to_last = over_length(mesh.positions[t[(i + 2) % 3]] - corner);
            sums[t[i]] += std::acos(glm::dot(to_next, to_last)) * normal;
        }
    }
    for (glm::vec3& sum : sums)
        sum = over_length(sum);
    return sums;
}

std::vector<glm::vec4> textbook_tangents(const Mesh& mesh) {
    std::vector<glm::vec3> along_u(mesh.positions.size(), glm::vec3(0.0F));
    std::vector<glm::vec3> along_v = along_u;
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::vec3 first = mesh.positions[t.y] - mesh.positions[t.x];
        const glm::vec3 second = mesh.positions[t.z] - mesh.positions[t.x];
        const glm::vec2 first_uv = mesh.texcoords[t.y] - mesh.texcoords[t.x];
        const glm::vec2 second_uv = mesh.texcoords[t.z] - mesh.texcoords[t.x];
        const float r = 1.0F / (first_uv.x * second_uv.y - second_uv.x * first_uv.y);
        const glm::vec3 u = (first * second_uv.y - second * first_uv.y) * r;
        const glm::vec3 v = (second * first_uv.x - first * second_uv.x) * r;
        for (int i = 0; i < 3; ++i) {
            along_u[t[i]] += u;
            along_v[t[i]] += v;
        }
    }
    std::vector<glm::vec4> corners;
    for (const glm::uvec3& t : mesh.triangles) {
        for (int i = 0; i < 3; ++i) {
            const glm::vec3& n = mesh.normals[t[i]];
            const glm::vec3& u = along_u[t[i]];
            const glm::vec3 tangent = over_length(u - n * glm::dot(n, u));
            // The bitangent points towards smaller v, which is up in the image.
            const bool is_mirrored = glm::dot(glm::cross(n, u), along_v[t[i]]) > 0.0F;
            corners.emplace_back(tangent, is_mirrored ? -1.0F : 1.0F);
        }
    }
    return corners;
}

Image textbook_sobel_normals(const Image& height, float strength) {
    Image normals = make_image(height.width, height.height, 3, 32, ColorSpace::data);
    const std::span<const float> heights = height.as<float>();
    const std::span<float> to = normals.as<float>();
    const auto place = [&](int x, int y) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(height.width) +
               static_cast<std::size_t>(x);
    };
    for (int y = 0; y < height.height; ++y) {
        for (int x = 0; x < height.width; ++x) {
            const auto h = [&](int dx, int dy) { return heights[place(x + dx, y + dy)]; };
            glm::vec3 normal(0.0F, 0.0F, 1.0F);
            if (x > 0 && y > 0 && x + 1 < height.width && y + 1 < height.height) {
                const float right = h(1, -1) + 2.0F * h(1, 0) + h(1, 1);
                const float left = h(-1, -1) + 2.0F * h(-1, 0) + h(-1, 1);
                const float below = h(-1, 1) + 2.0F * h(0, 1) + h(1, 1);
                const float above = h(-1, -1) + 2.0F * h(0, -1) + h(1, -1);
                normal = over_length(
                    {-strength * (right - left) / 8.0F, strength * (below - above) / 8.0F, 1.0F});
            }
            for (int i = 0; i < 3; ++i)
                to[3 * place(x, y) + static_cast<std::size_t>(i)] = normal[i];
        }
    }
    return normals;
}

}  // namespace relief::accuracy::detail
