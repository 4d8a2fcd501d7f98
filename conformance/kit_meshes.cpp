// SPDX-License-Identifier: Apache-2.0
// A function per mesh, except for simple ones. The tables at the end list all meshes.
// Tests: tests/tools/conformance_test.cpp.
#include "kit_meshes.h"

#include <algorithm>
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

namespace {

using Texcoord = glm::dvec2;

template <typename Change>
Mesh changed(Mesh mesh, const Change& change) {
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
        change(mesh, v);
    return mesh;
}

void append(Mesh& mesh, const Mesh& other) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
    mesh.normals.insert(mesh.normals.end(), other.normals.begin(), other.normals.end());
    mesh.texcoords.insert(mesh.texcoords.end(), other.texcoords.begin(), other.texcoords.end());
    for (const glm::uvec3& triangle : other.triangles)
        mesh.triangles.push_back(triangle + first);
}

Mesh mirrored_torus() {
    return retextured(torus(20, 10), [](Texcoord t) { return Texcoord(std::abs(t.x - 0.5), t.y); });
}

Mesh mirrored_hills() {
    return retextured(
        hills(8), [](Texcoord t) { return Texcoord(std::abs(t.x - 0.5), std::abs(t.y - 0.5)); });
}

/// Squares of 2 x 2 cells, each with another rotation, scale and position of the image.
Mesh islands() {
    Mesh all;
    Random random(11);
    for (int island = 0; island < 16; ++island) {
        const double turn = 2.0 * std::numbers::pi * random.unit();
        const double scale = 0.1 + 0.4 * random.unit();
        const Texcoord place{random.unit(), random.unit()};
        append(all, patch(2, 2, [&](double x, double y) {
                   const Texcoord at((island % 4 + x) / 4.0, (island / 4 + y) / 4.0);
                   Point point = hill(at.x, at.y);
                   point.texcoord =
                       place + scale * Texcoord(std::cos(turn) * x + std::sin(turn) * y,
                                                std::sin(turn) * x - std::cos(turn) * y);
                   return point;
               }));
    }
    return all;
}

Mesh sheared() {
    return retextured(hills(10), [](Texcoord t) { return Texcoord(16.0 * t.x + 9.0 * t.y, t.y); });
}

/// Random texture coordinates: handedness and size differ between adjacent triangles.
Mesh scrambled() {
    Random random(12);
    return retextured(hills(10), [&](Texcoord) { return Texcoord{random.unit(), random.unit()}; });
}

Mesh scaled() {
    return changed(hills(6), [](Mesh& mesh, std::size_t v) {
        mesh.positions[v] = mesh.positions[v] * 1024.0F + glm::vec3(300, -200, 100);
        mesh.texcoords[v] = mesh.texcoords[v] * 0.0078125F + 3.0F;
    });
}

Mesh long_triangles() {
    return changed(hills(8), [](Mesh& mesh, std::size_t v) { mesh.positions[v].x *= 40.0F; });
}

Mesh leaning_normals() {
    Random random(13);
    return changed(hills(8), [&](Mesh& mesh, std::size_t v) {
        const double x = 3.0 * random.unit() - 1.5;
        const double y = 3.0 * random.unit() - 1.5;
        mesh.normals[v] = glm::normalize(glm::dvec3(x, y, 1.0));
    });
}

/// Flat normals, which glTF requires for meshes without normals.
Mesh facets() {
    Mesh mesh = soup(hills(7));
    for (const glm::uvec3& triangle : mesh.triangles) {
        const glm::dvec3 origin(mesh.positions[triangle.x]);
        const glm::dvec3 normal =
            glm::normalize(glm::cross(glm::dvec3(mesh.positions[triangle.y]) - origin,
                                      glm::dvec3(mesh.positions[triangle.z]) - origin));
        for (int i = 0; i < 3; ++i)
            mesh.normals[triangle[i]] = normal;
    }
    return mesh;
}

/// Degenerate triangles among sound ones: with a repeated vertex, two corners at the same position,
/// collinear corners, or a texture that is a line or a point of the image.
Mesh degenerate() {
    Mesh mesh = hills(8);
    Random random(14);
    const auto count = static_cast<std::uint32_t>(mesh.positions.size());
    for (int i = 0; i < 8; ++i) {
        const std::uint32_t a = random.below(count);
        const std::uint32_t b = random.below(count);
        mesh.triangles.emplace_back(a, b, a);
    }
    for (int i = 0; i < 8; ++i) {
        const glm::uvec3 near = mesh.triangles[random.below(128)];
        mesh.positions.push_back(mesh.positions[near.x]);
        mesh.normals.push_back(mesh.normals[near.x]);
        mesh.texcoords.emplace_back(mesh.texcoords[near.y]);
        mesh.triangles.emplace_back(near.x, near.y,
                                    static_cast<std::uint32_t>(mesh.positions.size() - 1));
    }
    // The third corner is the midpoint of an edge: collinear in space, but not in the image.
    for (int i = 0; i < 8; ++i) {
        const glm::uvec3 near = mesh.triangles[random.below(128)];
        mesh.positions.push_back((mesh.positions[near.x] + mesh.positions[near.y]) * 0.5F);
        mesh.normals.push_back(mesh.normals[near.x]);
        mesh.texcoords.push_back(mesh.texcoords[near.z]);
        mesh.triangles.emplace_back(near.y, near.x,
                                    static_cast<std::uint32_t>(mesh.positions.size() - 1));
    }
    for (const std::size_t v : {40U, 41U, 49U})
        mesh.texcoords[v] = mesh.texcoords[31];
    return mesh;
}

/// Five pages of a book around the y axis with different orientations. Each edge of the spine has
/// several possible neighbors.
Mesh book() {
    Mesh all;
    for (int page = 0; page < 5; ++page) {
        const double turn = 2.0 * std::numbers::pi * page / 5.0 + 0.1;
        const bool is_left = page % 2 == 1;
        append(all, patch(2, 6, [&](double x, double y) {
                   const double radius = is_left ? 1.0 - x : x;
                   const double u = radius * (1.0 + page);
                   return Point{{radius * std::cos(turn), y, radius * std::sin(turn)},
                                {0.2, 0.1, 1.0},
                                {is_left ? -u : u, 1.0 - y}};
               }));
    }
    return all;
}

/// Triangles that share corners, but no edge.
Mesh bow_ties() {
    Mesh mesh = hills(8);
    std::vector<glm::uvec3> kept;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (t % 4 == (t / 16) % 4) kept.push_back(mesh.triangles[t]);
    }
    mesh.triangles = kept;
    return mesh;
}

Mesh flipped() {
    Mesh mesh = hills(8);
    Random random(15);
    for (glm::uvec3& triangle : mesh.triangles) {
        if (random.below(4) == 0) std::swap(triangle.x, triangle.z);
    }
    return mesh;
}

/// Each vertex is stored three times, once with -0 instead of 0. Triangles refer to random copies.
Mesh duplicates() {
    Mesh mesh = changed(hills(8), [](Mesh& m, std::size_t v) {
        m.positions[v].z = std::abs(m.positions[v].x) < 0.3F ? 0.0F : m.positions[v].z;
    });
    const auto count = static_cast<std::uint32_t>(mesh.positions.size());
    const auto negated = [](float value) { return value == 0.0F ? -0.0F : value; };
    for (int copy = 0; copy < 2; ++copy) {
        for (std::uint32_t v = 0; v < count; ++v) {
            glm::vec3 position = mesh.positions[v];
            glm::vec3 normal = mesh.normals[v];
            glm::vec2 texcoord = mesh.texcoords[v];
            if (copy == 1) {
                position = {negated(position.x), negated(position.y), negated(position.z)};
                normal = {negated(normal.x), negated(normal.y), negated(normal.z)};
                texcoord = {negated(texcoord.x), negated(texcoord.y)};
            }
            mesh.positions.push_back(position);
            mesh.normals.push_back(normal);
            mesh.texcoords.push_back(texcoord);
        }
    }
    Random random(16);
    for (glm::uvec3& triangle : mesh.triangles) {
        for (int i = 0; i < 3; ++i)
            triangle[i] += count * random.below(3);
    }
    return mesh;
}

/// An S-shaped strip with overhangs. Its texture is continuous. Projected along the common normal,
/// the texture reverses exactly where the strip does.
Mesh folded_back() {
    constexpr double places[] = {0, 1, 2, 1, 0, 1, 2};
    return patch(6, 2, [&](double x, double y) {
        const auto step = static_cast<std::size_t>(std::lround(6.0 * x));
        return Point{{places[step], 2.0 * y, 0.5 * static_cast<double>(step)},
                     {0, 0, 1},
                     {static_cast<double>(step) / 8.0, 1.0 - y}};
    });
}

/// The same strip along the other axis, with a texture that each triangle shears differently: v
/// reverses exactly, u only slightly. Half of the triangles face away from their normals.
Mesh folded_over() {
    constexpr double places[] = {0, 1, 2, 1, 0, 1, 2};
    Random random(21);
    return patch(3, 6, [&](double x, double y) {
        const auto step = static_cast<std::size_t>(std::lround(6.0 * y));
        const double v = 1.0 - (static_cast<double>(step) + 0.6 * random.unit()) / 8.0;
        return Point{{std::round(3.0 * x), places[step], 0.5 * static_cast<double>(step)},
                     {0, 0, 1},
                     {std::round(3.0 * x) / 4.0, v}};
    });
}

/// Quads, of which some have one shorter diagonal in the image and some the other.
KitMesh quads() {
    const int cells = 8;
    Random random(17);
    const Mesh whole = patch(cells, cells, [&](double x, double y) {
        Point point = hill(x, y);
        const double u = x + 0.06 * (random.unit() - 0.5);
        point.texcoord = {u, 1.0 - y + 0.06 * (random.unit() - 0.5)};
        return point;
    });
    KitMesh kit{"quads",
                KitGroup::conformance,
                "Quads, also as OBJ; each is cut along the diagonal that is shorter in the image.",
                whole,
                {}};
    kit.mesh.triangles.clear();
    for (std::uint32_t row = 0; row < cells; ++row) {
        for (std::uint32_t column = 0; column < cells; ++column) {
            const std::uint32_t a = row * (cells + 1) + column;
            const glm::uvec4 quad(a, a + 1, a + cells + 2, a + cells + 1);
            kit.quads.push_back(quad);
            const auto squared = [&](std::uint32_t i, std::uint32_t j) {
                const glm::vec2 d = whole.texcoords[i] - whole.texcoords[j];
                return d.x * d.x + d.y * d.y;
            };
            if (squared(quad.x, quad.z) < squared(quad.y, quad.w)) {
                kit.mesh.triangles.emplace_back(quad.x, quad.y, quad.z);
                kit.mesh.triangles.emplace_back(quad.x, quad.z, quad.w);
            } else {
                kit.mesh.triangles.emplace_back(quad.x, quad.y, quad.w);
                kit.mesh.triangles.emplace_back(quad.y, quad.z, quad.w);
            }
        }
    }
    return kit;
}

/// Hills with an order of triangles for which the reference misses neighbors: it does not sort the
/// last run of edges completely. About one order in a hundred has this effect.
Mesh unsorted_bucket() {
    Random random(284);
    Mesh mesh = retextured(hills(4), [&](Texcoord t) {
        const double x = random.unit();
        return t + 0.3 * Texcoord(x, random.unit());
    });
    for (std::size_t t = mesh.triangles.size(); t > 1; --t)
        std::swap(mesh.triangles[t - 1],
                  mesh.triangles[random.below(static_cast<std::uint32_t>(t))]);
    return mesh;
}

Mesh one_triangle() {
    Mesh mesh;
    add(mesh, {{0, 0, 0}, {0, 0.25, 1}, {0.25, 0.75}});
    add(mesh, {{2, 0, 0}, {0, 0.25, 1}, {0.75, 0.5}});
    add(mesh, {{0.5, 1.5, 0.5}, {0, 0.25, 1}, {0.5, 0.25}});
    mesh.triangles = {{0, 1, 2}};
    return mesh;
}

std::vector<KitMesh> conformance_meshes() {
    const auto judged = KitGroup::conformance;
    return {
        {"one-triangle", judged, "Nothing else.", one_triangle(), {}},
        {"sphere", judged, "A sphere with a texture seam and two poles.", sphere(16, 8), {}},
        {"torus-mirrored",
         judged,
         "A torus whose image is mirrored along two of its circles.",
         mirrored_torus(),
         {}},
        {"hills-mirrored",
         judged,
         "Hills whose image is mirrored in u and in v, on shared vertices.",
         mirrored_hills(),
         {}},
        {"cube-hard",
         judged,
         "A cube with hard edges; two of its sides are mirrored.",
         cube(3, false),
         {}},
        {"cube-smooth",
         judged,
         "A cube with smooth normals; sides do not share texture coordinates.",
         cube(3, true),
         {}},
        {"fan", judged, "Many triangles around one vertex.", fan(150), {}},
        {"islands",
         judged,
         "Hills in 16 islands, each turned and scaled in the image.",
         islands(),
         {}},
        {"sheared", judged, "Hills with a texture stretched 16 to 1, and sheared.", sheared(), {}},
        {"scrambled", judged, "Hills with texture coordinates at random.", scrambled(), {}},
        {"scaled",
         judged,
         "Hills a thousand times as large, off the origin, in a small part of "
         "the image.",
         scaled(),
         {}},
        {"long-triangles", judged, "Hills drawn out 40 times along u.", long_triangles(), {}},
        {"leaning-normals",
         judged,
         "Hills whose normals lean away from the surface.",
         leaning_normals(),
         {}},
        {"facets", judged, "Hills with flat normals: no corner shares a vertex.", facets(), {}},
        {"degenerate",
         judged,
         "Hills with triangles that have no area, in space or in the image.",
         degenerate(),
         {}},
        {"non-manifold", judged, "Five pages on one edge, and one normal for all.", book(), {}},
        {"bow-ties", judged, "Triangles that touch in corners only.", bow_ties(), {}},
        {"flipped", judged, "Hills with every fourth triangle wound the other way.", flipped(), {}},
        quads(),
        {"soup",
         judged,
         "Hills with three vertices for every triangle, and no indices.",
         soup(hills(7)),
         {},
         false},
        {"duplicates",
         judged,
         "Hills whose vertices are stored three times, with -0 for 0.",
         duplicates(),
         {}},
        {"folded-back",
         judged,
         "A strip that turns back on itself under one normal: the limit of 180 degrees.",
         folded_back(),
         {}},
        {"folded-over",
         judged,
         "A strip that turns back under one normal in v, with a texture sheared at random.",
         folded_over(),
         {}},
        {"unsorted-bucket",
         KitGroup::defect,
         "A vertex whose edges the reference does not sort, so that it misses neighbors.",
         unsorted_bucket(),
         {}},
    };
}

Mesh with_texture(float scale) {
    return changed(sphere(12, 6), [=](Mesh& mesh, std::size_t v) { mesh.texcoords[v] *= scale; });
}

Mesh with_far_texture() {
    return changed(sphere(24, 12), [](Mesh& mesh, std::size_t v) { mesh.texcoords[v] += 1e6F; });
}

Mesh with_positions(float scale, float offset) {
    return changed(sphere(12, 6), [=](Mesh& mesh, std::size_t v) {
        mesh.positions[v] = mesh.positions[v] * scale + offset;
    });
}

Mesh with_normals_of_lengths() {
    Random random(18);
    return changed(sphere(12, 6), [&](Mesh& mesh, std::size_t v) {
        mesh.normals[v] *= static_cast<float>(0.1 + 9.0 * random.unit());
    });
}

/// Normals in the plane of the surface: along the axes of the texture.
Mesh normals_in_the_surface() {
    return changed(hills(6), [](Mesh& mesh, std::size_t v) {
        mesh.normals[v] = v % 2 == 0 ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
    });
}

Mesh slivers() {
    return changed(hills(6), [](Mesh& mesh, std::size_t v) {
        mesh.positions[v].y = 1e-6F * mesh.positions[v].y + 0.3F * mesh.positions[v].x;
    });
}

Mesh half_textured() {
    return retextured(hills(6), [](Texcoord t) { return Texcoord(std::min(t.x, 0.5), t.y); });
}

std::vector<KitMesh> stability_meshes() {
    const auto usable = KitGroup::stability;
    const auto none = [](Texcoord) { return Texcoord(0.5); };
    const auto line = [](Texcoord t) { return Texcoord(t.x, 0.5 * t.x); };
    return {
        {"texture-1e-19",
         usable,
         "A sphere, texture coordinates times 1e-19.",
         with_texture(1e-19F),
         {}},
        {"texture-1e-25",
         usable,
         "A sphere, texture coordinates times 1e-25.",
         with_texture(1e-25F),
         {}},
        {"texture-1e18",
         usable,
         "A sphere, texture coordinates times 1e18.",
         with_texture(1e18F),
         {}},
        {"texture-far",
         usable,
         "A sphere, texture coordinates plus a million.",
         with_far_texture(),
         {}},
        {"positions-1e-25", usable, "A sphere of radius 1e-25.", with_positions(1e-25F, 0), {}},
        {"positions-1e20", usable, "A sphere of radius 1e20.", with_positions(1e20F, 0), {}},
        {"positions-1e25", usable, "A sphere of radius 1e25.", with_positions(1e25F, 0), {}},
        {"positions-far",
         usable,
         "A unit sphere a million from the origin.",
         with_positions(1, 1e6F),
         {}},
        {"normals-of-lengths",
         usable,
         "A sphere with normals of lengths from 0.1 to 9.1.",
         with_normals_of_lengths(),
         {}},
        {"normals-in-the-surface",
         usable,
         "Hills whose normals lie along their edges.",
         normals_in_the_surface(),
         {}},
        {"texture-of-a-point",
         usable,
         "Hills with one texture coordinate.",
         retextured(hills(6), none),
         {}},
        {"texture-of-a-line",
         usable,
         "Hills that show a line of the image.",
         retextured(hills(6), line),
         {}},
        {"texture-on-one-side",
         usable,
         "Hills half of which show a line of the image.",
         half_textured(),
         {}},
        {"slivers", usable, "Hills pressed together to a millionth along v.", slivers(), {}},
        {"degenerate-usable", usable, "The mesh `degenerate`, every corner.", degenerate(), {}},
        {"non-manifold-usable", usable, "The mesh `non-manifold`, every corner.", book(), {}},
    };
}

}  // namespace

std::vector<KitMesh> kit_meshes() {
    std::vector<KitMesh> all = conformance_meshes();
    for (KitMesh& mesh : stability_meshes())
        all.push_back(std::move(mesh));
    return all;
}

}  // namespace relief::conformance
