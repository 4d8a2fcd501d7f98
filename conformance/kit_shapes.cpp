// SPDX-License-Identifier: Apache-2.0
#include "kit_shapes.h"

#include <cmath>
#include <numbers>

namespace relief::conformance {

glm::vec2 invertible(const glm::dvec2& texcoord) {
    return glm::round(texcoord * 65536.0) / 65536.0;
}

std::uint32_t add(Mesh& mesh, const Point& point) {
    mesh.positions.emplace_back(point.position);
    mesh.normals.emplace_back(glm::normalize(point.normal));
    mesh.texcoords.push_back(invertible(point.texcoord));
    return static_cast<std::uint32_t>(mesh.positions.size() - 1);
}

Mesh patch(int columns, int rows, const std::function<Point(double, double)>& point) {
    Mesh mesh;
    for (int row = 0; row <= rows; ++row) {
        for (int column = 0; column <= columns; ++column)
            add(mesh,
                point(static_cast<double>(column) / columns, static_cast<double>(row) / rows));
    }
    const auto width = static_cast<std::uint32_t>(columns + 1);
    for (std::uint32_t row = 0; row < static_cast<std::uint32_t>(rows); ++row) {
        for (std::uint32_t column = 0; column + 1 < width; ++column) {
            const std::uint32_t corner = row * width + column;
            mesh.triangles.emplace_back(corner, corner + 1, corner + width + 1);
            mesh.triangles.emplace_back(corner, corner + width + 1, corner + width);
        }
    }
    return mesh;
}

Point hill(double x, double y) {
    const double u = 2.0 * x - 1.0;
    const double v = 2.0 * y - 1.0;
    const double height = 0.2 * std::sin(3.0 * u + 1.0) * std::cos(2.5 * v);
    const glm::dvec3 normal(-0.6 * std::cos(3.0 * u + 1.0) * std::cos(2.5 * v),
                            0.5 * std::sin(3.0 * u + 1.0) * std::sin(2.5 * v), 1.0);
    return {{u, v, height}, normal, {x, 1.0 - y}};
}

Mesh hills(int cells) {
    return patch(cells, cells, hill);
}

namespace {

Point on_sphere(double x, double y) {
    const double longitude = 2.0 * std::numbers::pi * x;
    const double latitude = std::numbers::pi * (y - 0.5);
    const glm::dvec3 place(std::sin(longitude) * std::cos(latitude), std::sin(latitude),
                           std::cos(longitude) * std::cos(latitude));
    return {place, place, {x, 1.0 - y}};
}

}  // namespace

Mesh sphere(int slices, int stacks) {
    const auto at = [&](int slice, int stack) {
        // Each slice has its own vertex at a pole, with the u of the center of the slice.
        const bool is_pole = stack == 0 || stack == stacks;
        Point point = on_sphere((slice + (is_pole ? 0.5 : 0.0)) / slices,
                                static_cast<double>(stack) / stacks);
        if (is_pole) point.position = point.normal = {0, stack == 0 ? -1 : 1, 0};
        if (slice == slices && !is_pole) {
            const double u = point.texcoord.x;
            point = on_sphere(0.0, static_cast<double>(stack) / stacks);
            point.texcoord.x = u;
        }
        return point;
    };
    Mesh mesh;
    for (int stack = 0; stack <= stacks; ++stack) {
        const bool is_pole = stack == 0 || stack == stacks;
        for (int slice = 0; slice < slices + (is_pole ? 0 : 1); ++slice)
            add(mesh, at(slice, stack));
    }
    const auto index = [&](int slice, int stack) {
        return static_cast<std::uint32_t>(stack == 0 ? slice
                                                     : slices + (stack - 1) * (slices + 1) + slice);
    };
    for (int stack = 0; stack < stacks; ++stack) {
        for (int slice = 0; slice < slices; ++slice) {
            const std::uint32_t here = index(slice, stack);
            const std::uint32_t above = index(slice, stack + 1);
            if (stack == 0) {
                mesh.triangles.emplace_back(here, above + 1, above);
            } else {
                mesh.triangles.emplace_back(here, here + 1, stack + 1 < stacks ? above + 1 : above);
                if (stack + 1 < stacks) mesh.triangles.emplace_back(here, above + 1, above);
            }
        }
    }
    return mesh;
}

Mesh torus(int slices, int sides) {
    const auto point = [&](double x, double y) {
        // Both ends of the circle have exactly the same position.
        const double around = 2.0 * std::numbers::pi * (x == 1.0 ? 0.0 : x);
        const double tube = 2.0 * std::numbers::pi * (y == 1.0 ? 0.0 : y);
        const glm::dvec3 out(std::sin(around), 0.0, std::cos(around));
        const glm::dvec3 normal = std::cos(tube) * out + glm::dvec3(0, std::sin(tube), 0);
        return Point{out + 0.4 * normal, normal, {x, 1.0 - y}};
    };
    return patch(slices, sides, point);
}

Mesh cube(int cells, bool is_smooth) {
    Mesh all;
    for (int side = 0; side < 6; ++side) {
        const int axis = side / 2;
        const double sign = side % 2 == 0 ? 1.0 : -1.0;
        glm::dvec3 out(0.0);
        glm::dvec3 right(0.0);
        out[axis] = sign;
        right[(axis + 1) % 3] = sign;
        const glm::dvec3 up = glm::cross(out, right);
        const bool is_mirrored = side == 1 || side == 4;
        const Mesh face = patch(cells, cells, [&](double x, double y) {
            const glm::dvec3 place = out + (2.0 * x - 1.0) * right + (2.0 * y - 1.0) * up;
            const double u = ((is_mirrored ? 1.0 - x : x) + side % 3) / 3.0;
            return Point{place, is_smooth ? place : out, {u, (1.0 - y + side / 3) / 2.0}};
        });
        const auto first = static_cast<std::uint32_t>(all.positions.size());
        all.positions.insert(all.positions.end(), face.positions.begin(), face.positions.end());
        all.normals.insert(all.normals.end(), face.normals.begin(), face.normals.end());
        all.texcoords.insert(all.texcoords.end(), face.texcoords.begin(), face.texcoords.end());
        for (const glm::uvec3& triangle : face.triangles)
            all.triangles.push_back(triangle + first);
    }
    return all;
}

Mesh fan(int count) {
    Mesh mesh;
    const auto lay = [](const glm::dvec3& p) {
        return glm::dvec2(0.5 + 0.4 * p.x + 0.1 * p.z, 0.5 - 0.4 * p.y);
    };
    const auto point = [&](const glm::dvec3& p) {
        return Point{p, {0.7 * p.x, 0.7 * p.y, 1.0}, lay(p)};
    };
    add(mesh, point({0, 0, 0.5}));
    for (int i = 0; i < count; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / count;
        const double radius = 1.0 + 0.3 * std::sin(5.0 * angle);
        add(mesh, point({radius * std::cos(angle), radius * std::sin(angle),
                         0.2 * std::cos(3.0 * angle)}));
        const auto here = static_cast<std::uint32_t>(i + 1);
        mesh.triangles.emplace_back(0U, here,
                                    here == static_cast<std::uint32_t>(count) ? 1U : here + 1);
    }
    return mesh;
}

Mesh soup(const Mesh& mesh) {
    Mesh loose;
    for (const glm::uvec3& triangle : mesh.triangles) {
        const auto first = static_cast<std::uint32_t>(loose.positions.size());
        for (int i = 0; i < 3; ++i) {
            loose.positions.push_back(mesh.positions[triangle[i]]);
            loose.normals.push_back(mesh.normals[triangle[i]]);
            loose.texcoords.push_back(mesh.texcoords[triangle[i]]);
        }
        loose.triangles.emplace_back(first, first + 1, first + 2);
    }
    return loose;
}

Mesh retextured(Mesh mesh, const std::function<glm::dvec2(glm::dvec2)>& change) {
    for (glm::vec2& texcoord : mesh.texcoords)
        texcoord = invertible(change(glm::dvec2(texcoord)));
    return mesh;
}

}  // namespace relief::conformance
