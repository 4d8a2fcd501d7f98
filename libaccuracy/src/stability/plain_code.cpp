// SPDX-License-Identifier: Apache-2.0
// Tests: tests/accuracy/plain_code_test.cpp.
#include "stability/plain_code.h"

#include <cmath>

namespace relief {
namespace {

glm::vec3 over_length(const glm::vec3& v) {
    return v / std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
}

}  // namespace

std::vector<glm::vec3> plain_area_normals(const Mesh& mesh) {
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

std::vector<glm::vec3> plain_angle_normals(const Mesh& mesh) {
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

std::vector<glm::vec4> plain_tangents(const Mesh& mesh) {
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
            // Towards smaller v, which is up in the image.
            const bool is_mirrored = glm::dot(glm::cross(n, u), along_v[t[i]]) > 0.0F;
            corners.emplace_back(tangent, is_mirrored ? -1.0F : 1.0F);
        }
    }
    return corners;
}

Image plain_sobel_normals(const Image& height, float strength) {
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

}  // namespace relief
