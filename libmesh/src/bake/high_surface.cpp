// SPDX-License-Identifier: Apache-2.0
// Tests: tests/mesh/bake/bake_test.cpp, high_detail_test.cpp.
#include "bake/high_surface.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <tuple>
#include <utility>

#include "bake/surface_texture.h"
#include "bake/texel_frame.h"
#include "geometry/direction.h"
#include "relief/mesh/curvature.h"
#include "relief/mesh/frames.h"

namespace relief {
namespace {

constexpr double usual_share = 0.99;  // Of the area.
constexpr std::size_t most_asked = 250'000;

const HighDetail* detail_of(const Mesh& mesh, const BakeOptions& options) {
    for (const HighDetail& detail : options.details) {
        if (detail.mesh != &mesh) continue;
        check(detail);
        return &detail;
    }
    return nullptr;
}

bool has_normal_map(const HighDetail* detail) {
    if (detail == nullptr) return false;
    if (detail->otherwise && detail->otherwise->normal_map) return true;
    return std::any_of(detail->materials.begin(), detail->materials.end(),
                       [](const HighMaterial& material) { return material.normal_map; });
}

/// What is asked of a mesh that it does not have.
void count_missing(const Mesh& mesh, const HighDetail* detail, std::size_t index,
                   const BakeLayers& layers, Report& report) {
    if (layers.colors && mesh.colors.empty() &&
        (detail == nullptr || (detail->materials.empty() && !detail->otherwise)))
        report.add("high mesh without colours", "mesh", index, "is white");
    if (!mesh.texcoords.empty() || detail == nullptr) return;
    if (layers.normals && has_normal_map(detail))
        report.add("normal map without texture coordinates", "mesh", index, "is left out");
    if (!layers.colors || !detail->color_texcoords.empty()) return;
    for (const HighMaterial& material : detail->materials) {
        if (!material.color_texture) continue;
        report.add("colour texture without texture coordinates", "mesh", index, "is left out");
        break;
    }
}

template <typename Value, typename Wide>
Wide interpolated(std::span<const Value> values, const glm::uvec3& corners, const RayHit& hit,
                  Wide sum) {
    for (int i = 0; i < 3; ++i)
        sum += hit.weights[i] * Wide(values[corners[i]]);
    return sum;
}

/// Of maps that are covered all over.
double expected_rays(const BakeOptions& options) {
    const int rays = options.layers.occlusion ? options.layers.occlusion->rays : 0;
    return static_cast<double>(options.map_count) * options.width * options.height *
           (options.samples + rays);
}

}  // namespace

HighSurface::HighSurface(std::span<const Mesh> meshes, const BakeOptions& options, Report& report)
    : made_(meshes.size()) {
    std::vector<RayMesh> ray_meshes;
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        validate(meshes[i]);
        entries_.push_back(entry(meshes[i], i, options, report));
        ray_meshes.push_back({entries_[i].mesh->positions, entries_[i].mesh->triangles});
    }
    scene_ = std::make_unique<RayScene>(std::move(ray_meshes), expected_rays(options),
                                        [this](const MetTriangle& a, const MetTriangle& b) {
                                            return attributes(a) < attributes(b);
                                        });
}

std::vector<std::uint32_t> HighSurface::attributes(const MetTriangle& met) const {
    const Entry& entry = entries_[met.mesh];
    const Mesh& mesh = *entry.mesh;
    glm::uvec3 corners = mesh.triangles[met.triangle];
    const auto is_before = [&](std::uint32_t a, std::uint32_t b) {
        const glm::vec3& p = mesh.positions[a];
        const glm::vec3& q = mesh.positions[b];
        return std::tie(p.x, p.y, p.z) < std::tie(q.x, q.y, q.z);
    };
    std::sort(&corners[0], &corners[0] + 3, is_before);
    std::vector<std::uint32_t> result;
    const auto add = [&](const auto& values, std::uint32_t vertex) {
        if (values.empty()) return;
        const float* numbers = reinterpret_cast<const float*>(&values[vertex]);
        for (std::size_t i = 0; i < sizeof(values[0]) / sizeof(float); ++i)
            result.push_back(std::bit_cast<std::uint32_t>(numbers[i]));
    };
    for (int i = 0; i < 3; ++i) {
        add(mesh.normals, corners[i]);
        add(mesh.tangents, corners[i]);
        add(mesh.texcoords, corners[i]);
        add(mesh.colors, corners[i]);
        add(entry.color_texcoords, corners[i]);
        add(entry.curvature, corners[i]);
    }
    const auto range =
        std::upper_bound(mesh.material_ranges.begin(), mesh.material_ranges.end(), met.triangle,
                         [](std::uint32_t triangle, const MaterialRange& one) {
                             return triangle < one.first_triangle;
                         });
    if (range != mesh.material_ranges.begin())
        result.push_back(static_cast<std::uint32_t>(std::prev(range)->material.value_or(-1)));
    return result;
}

HighSurface::Entry HighSurface::entry(const Mesh& mesh, std::size_t index,
                                      const BakeOptions& options, Report& report) {
    const BakeLayers& layers = options.layers;
    Entry result;
    result.mesh = &mesh;
    const HighDetail* detail = detail_of(mesh, options);
    count_missing(mesh, detail, index, layers, report);
    if (layers.normals || layers.colors) result.detail = detail;
    if (layers.colors && detail != nullptr) {
        result.color_texcoords =
            detail->color_texcoords.empty() ? mesh.texcoords : detail->color_texcoords;
    }
    const bool needs_tangents = layers.normals && has_normal_map(detail) &&
                                !mesh.texcoords.empty() &&
                                (mesh.tangents.empty() || mesh.normals.empty());
    if (!mesh.triangles.empty() && (mesh.normals.empty() || needs_tangents)) {
        FrameOptions frames;
        frames.tangents = needs_tangents ? TangentMode::mikktspace : TangentMode::none;
        FramedMesh framed = with_frames(mesh, frames, report);
        made_[index] = std::move(framed.mesh);
        result.mesh = &made_[index];
        for (const std::uint32_t vertex : framed.source_vertex) {
            if (!result.color_texcoords.empty())
                result.split_texcoords.push_back(result.color_texcoords[vertex]);
        }
        if (!result.split_texcoords.empty()) result.color_texcoords = result.split_texcoords;
    }
    if (layers.curvature)
        result.curvature = mean_curvatures(result.mesh->positions, result.mesh->triangles, report);
    return result;
}

const HighMaterial* HighSurface::material(const RayHit& hit) const {
    const Entry& entry = entries_[hit.mesh];
    if (entry.detail == nullptr) return nullptr;
    const HighMaterial* otherwise = entry.detail->otherwise ? &*entry.detail->otherwise : nullptr;
    const std::vector<MaterialRange>& ranges = entry.mesh->material_ranges;
    if (ranges.empty()) {
        // Nothing is said of triangles: the only material is that of all.
        return otherwise != nullptr || entry.detail->materials.empty()
                   ? otherwise
                   : &entry.detail->materials.front();
    }
    const auto next = std::upper_bound(ranges.begin(), ranges.end(), hit.triangle,
                                       [](std::uint32_t triangle, const MaterialRange& range) {
                                           return triangle < range.first_triangle;
                                       });
    const MaterialRange& range = *std::prev(next);
    return range.material ? &entry.detail->materials[*range.material] : otherwise;
}

glm::dvec3 HighSurface::face_normal(const RayHit& hit) const {
    const auto place = scene_->corners(hit.mesh, hit.triangle);
    return direction_or_zero(glm::cross(place[1] - place[0], place[2] - place[0]));
}

glm::dvec3 HighSurface::smooth_normal(const RayHit& hit, std::size_t sample, Report& found) const {
    const Mesh& mesh = *entries_[hit.mesh].mesh;
    const glm::dvec3 unit = direction_or_zero(
        interpolated<glm::vec3>(mesh.normals, mesh.triangles[hit.triangle], hit, glm::dvec3(0.0)));
    if (unit != glm::dvec3(0.0)) return unit;
    found.add("high normal without direction", "texel", sample, "is its triangle's");
    return face_normal(hit);
}

glm::dvec3 HighSurface::normal(const RayHit& hit, std::size_t sample, Report& found) const {
    const HighMaterial* what = material(hit);
    const Mesh& mesh = *entries_[hit.mesh].mesh;
    if (what == nullptr || !what->normal_map || mesh.tangents.empty() || mesh.texcoords.empty())
        return smooth_normal(hit, sample, found);
    TexelFrame frame(mesh, hit.triangle, hit.weights);
    const GltfTextureTransform& transform = what->normal_map->texture.transform;
    if (transform != GltfTextureTransform{}) frame = frame.transformed_by(transform);
    const glm::dvec2 texcoord =
        interpolated<glm::vec2>(mesh.texcoords, mesh.triangles[hit.triangle], hit, glm::dvec2(0.0));
    const glm::dvec3 unit =
        direction_or_zero(frame.to_object(normal_at(*what->normal_map, texcoord)));
    if (frame.is_usable() && unit != glm::dvec3(0.0)) return unit;
    found.add("high normal map without a frame or a direction", "texel", sample, "is left out");
    return smooth_normal(hit, sample, found);
}

glm::dvec3 HighSurface::position(const RayHit& hit) const {
    const auto corners = scene_->corners(hit.mesh, hit.triangle);
    return hit.weights.x * corners[0] + hit.weights.y * corners[1] + hit.weights.z * corners[2];
}

double HighSurface::curvature(const RayHit& hit) const {
    const Entry& entry = entries_[hit.mesh];
    const glm::uvec3& corners = entry.mesh->triangles[hit.triangle];
    const double value = interpolated<float>(entry.curvature, corners, hit, 0.0);
    return hit.faces_origin ? value : -value;
}

glm::dvec3 HighSurface::color(const RayHit& hit) const {
    const Entry& entry = entries_[hit.mesh];
    const glm::uvec3& corners = entry.mesh->triangles[hit.triangle];
    glm::dvec3 color(1.0);
    if (!entry.mesh->colors.empty()) {
        color =
            glm::dvec3(interpolated<glm::vec4>(entry.mesh->colors, corners, hit, glm::dvec4(0.0)));
    }
    const HighMaterial* what = material(hit);
    if (what == nullptr) return color;
    color *= glm::dvec3(what->color);
    if (!what->color_texture || entry.color_texcoords.empty()) return color;
    const glm::dvec2 texcoord =
        interpolated<glm::vec2>(entry.color_texcoords, corners, hit, glm::dvec2(0.0));
    return color * color_at(*what->color_texture, texcoord);
}

HighSurface::CurvatureRange HighSurface::curvature_range() const {
    CurvatureRange range;
    std::vector<std::pair<float, double>> sizes;  // Of each corner, with its share of the area.
    double area = 0.0;
    for (std::size_t i = 0; i < entries_.size(); ++i) {
        const Entry& entry = entries_[i];
        for (const float value : entry.curvature)
            range.greatest = std::max(range.greatest, static_cast<double>(std::abs(value)));
        // Of many triangles some all over.
        const std::size_t stride = entry.mesh->triangles.size() / most_asked + 1;
        for (std::size_t triangle = 0; triangle < entry.mesh->triangles.size();
             triangle += stride) {
            const auto corners = scene_->corners(static_cast<std::uint32_t>(i),
                                                 static_cast<std::uint32_t>(triangle));
            const double share =
                glm::length(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
            if (entry.curvature.empty() || !std::isfinite(share)) continue;
            for (int corner = 0; corner < 3; ++corner) {
                const std::uint32_t vertex = entry.mesh->triangles[triangle][corner];
                sizes.emplace_back(std::abs(entry.curvature[vertex]), share);
                area += share;
            }
        }
    }
    std::sort(sizes.begin(), sizes.end());
    double below = 0.0;
    for (const auto& [size, share] : sizes) {
        range.usual = static_cast<double>(size);
        below += share;
        if (below >= usual_share * area) break;
    }
    return range;
}

double HighSurface::largest_coordinate(const glm::dmat4& axes_from_mesh) const {
    double largest = 0.0;
    for (const Entry& entry : entries_) {
        const Bounds box = bounds_of(*entry.mesh);
        if (box.empty()) continue;
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec4 place((corner & 1) != 0 ? box.max.x : box.min.x,
                                   (corner & 2) != 0 ? box.max.y : box.min.y,
                                   (corner & 4) != 0 ? box.max.z : box.min.z, 1.0);
            const glm::dvec3 size = glm::abs(glm::dvec3(axes_from_mesh * place));
            largest = std::max({largest, size.x, size.y, size.z});
        }
    }
    return largest;
}

}  // namespace relief
