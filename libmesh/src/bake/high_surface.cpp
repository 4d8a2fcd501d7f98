// SPDX-License-Identifier: Apache-2.0
// Attributes of the high-poly meshes at hits, and the filtering of their textures.
// Tests: tests/mesh/bake/bake_test.cpp, high_materials_test.cpp.
#include "bake/high_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <tuple>
#include <utility>

#include "bake/texel_frame.h"
#include "geometry/direction.h"
#include "image/normal_coding.h"
#include "parallel.h"
#include "relief/mesh/curvature.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/report.h"

namespace relief::detail {
namespace {

/// Returns the texel that a wrapped index refers to.
std::size_t wrapped(double index, int size, Wrap wrap) {
    const double count = size;
    if (wrap == Wrap::clamp) return static_cast<std::size_t>(std::clamp(index, 0.0, count - 1.0));
    const double period = wrap == Wrap::mirror ? 2.0 * count : count;
    // Large doubles are coarser than texels, so that the remainder may be a whole period.
    const double within = std::min(index - std::floor(index / period) * period, period - 1.0);
    return static_cast<std::size_t>(within < count ? within : period - 1.0 - within);
}

/// Filters value(texel) at a texture coordinate.
template <typename Value>
auto filtered(const SurfaceTexture& texture, const glm::dvec2& texcoord, const Value& value) {
    const Image& image = *texture.image;
    glm::dvec2 uv = texcoord;
    if (texture.transform != GltfTextureTransform{})
        uv = glm::dvec2(transformed(texture.transform, glm::vec2(texcoord)));
    if (!is_finite(uv)) uv = glm::dvec2(0.0);
    const glm::dvec2 place = uv * glm::dvec2(image.width, image.height);
    const auto at = [&](double x, double y) {
        return value(wrapped(y, image.height, texture.wrap_v) *
                         static_cast<std::size_t>(image.width) +
                     wrapped(x, image.width, texture.wrap_u));
    };
    if (texture.filter == TextureFilter::nearest) {
        const glm::dvec2 texel = glm::floor(place);
        return at(texel.x, texel.y);
    }
    const glm::dvec2 corner = glm::floor(place - 0.5);
    const glm::dvec2 share = place - 0.5 - corner;
    const auto upper = glm::mix(at(corner.x, corner.y), at(corner.x + 1.0, corner.y), share.x);
    const auto lower =
        glm::mix(at(corner.x, corner.y + 1.0), at(corner.x + 1.0, corner.y + 1.0), share.x);
    return glm::mix(upper, lower, share.y);
}

/// Returns the linear values of 8-bit sRGB codes.
const std::array<double, 256>& linear_from_bytes() {
    static const std::array<double, 256> table = [] {
        std::array<double, 256> linear{};
        for (std::size_t code = 0; code < linear.size(); ++code)
            linear[code] = static_cast<double>(linear_from_srgb(static_cast<float>(code) / 255.0F));
        return linear;
    }();
    return table;
}

template <typename Sample>
double linear_value(Sample sample, bool is_srgb) {
    if constexpr (std::is_same_v<Sample, std::uint8_t>) {
        return is_srgb ? linear_from_bytes()[sample] : sample / 255.0;
    } else if constexpr (std::is_same_v<Sample, std::uint16_t>) {
        return is_srgb
                   ? static_cast<double>(linear_from_srgb(static_cast<float>(sample) / 65535.0F))
                   : sample / 65535.0;
    } else {
        return static_cast<double>(sample);
    }
}

using relief::detail::check;

void check(const SurfaceTexture& texture, int min_channels, const char* what) {
    if (texture.image == nullptr || texture.image->empty())
        throw InvalidInput(fmt::format("{} without an image", what));
    if (texture.image->channels < min_channels) {
        throw InvalidInput(
            fmt::format("{} of {} channels, not {}", what, texture.image->channels, min_channels));
    }
}

constexpr double usual_share = 0.99;  // Of the area.
constexpr std::size_t max_area_samples = 250'000;

const HighMaterials* detail_of(const Mesh& mesh, const BakeOptions& options) {
    for (const HighMaterials& detail : options.materials) {
        if (detail.mesh != &mesh) continue;
        check(detail);
        return &detail;
    }
    return nullptr;
}

bool has_normal_map(const HighMaterials* detail) {
    if (detail == nullptr) return false;
    if (detail->otherwise && detail->otherwise->normal_map) return true;
    return std::any_of(detail->materials.begin(), detail->materials.end(),
                       [](const HighMaterial& material) { return material.normal_map; });
}

/// Reports layers whose input a mesh does not have.
void report_missing(const Mesh& mesh, const HighMaterials* detail, std::size_t index,
                    const BakeLayers& layers, Report& report) {
    if (layers.colors && mesh.colors.empty() &&
        (detail == nullptr || (detail->materials.empty() && !detail->otherwise)))
        report.add("high mesh without colors", "mesh", index, "is white");
    if (!mesh.texcoords.empty() || detail == nullptr) return;
    if (layers.normals && has_normal_map(detail))
        report.add("normal map without texture coordinates", "mesh", index, "is left out");
    if (!detail->color_texcoords.empty()) return;
    const auto report_if = [&](const char* what, const auto& has_texture) {
        if (std::ranges::any_of(detail->materials, has_texture))
            report.add(what, "mesh", index, "is left out");
    };
    report_if("color texture without texture coordinates", [&](const HighMaterial& material) {
        return layers.colors && material.color_texture;
    });
    report_if("surface texture without texture coordinates", [&](const HighMaterial& material) {
        return layers.surface && (material.surface_texture || material.occlusion_texture);
    });
    report_if("emission texture without texture coordinates", [&](const HighMaterial& material) {
        return layers.emission && material.emission_texture;
    });
}

template <typename Value, typename Wide>
Wide interpolated(std::span<const Value> values, const glm::uvec3& corners, const RayHit& hit,
                  Wide sum) {
    for (int i = 0; i < 3; ++i)
        sum += hit.weights[i] * Wide(values[corners[i]]);
    return sum;
}

/// Returns the names of the triangles of a mesh for the layer of ids.
std::vector<NamedTriangles> names_of(const Mesh& mesh, const BakeOptions& options) {
    const auto given = std::ranges::find(options.ids, &mesh, &HighIds::mesh);
    if (given == options.ids.end()) return names_by_material(mesh, {}, mesh.name);
    const std::vector<NamedTriangles>& names = given->triangles;
    const auto is_before = [](const NamedTriangles& a, const NamedTriangles& b) {
        return a.first_triangle >= b.first_triangle;
    };
    if (names.empty() || names.front().first_triangle != 0 ||
        std::ranges::adjacent_find(names, is_before) != names.end()) {
        throw InvalidInput(
            "the names of a high mesh's triangles do not begin at triangle 0, or are not in "
            "ascending order");
    }
    return names;
}

/// Returns the number of rays if charts cover the maps completely.
double expected_rays(const BakeOptions& options) {
    const BakeLayers& layers = options.map.layers;
    int rays = layers.thickness ? layers.thickness->rays : 0;
    if (layers.occlusion || layers.bent_normals)
        rays += (layers.occlusion ? layers.occlusion : layers.bent_normals)->rays;
    return static_cast<double>(options.map_count) * options.map.width * options.map.height *
           (options.map.samples + rays);
}

}  // namespace

glm::dvec3 color_at(const SurfaceTexture& texture, const glm::dvec2& texcoord) {
    const Image& image = *texture.image;
    const auto channels = static_cast<std::size_t>(image.channels);
    const bool is_srgb = image.color_space == ColorSpace::srgb;
    return std::visit(
        [&](const auto& samples) {
            return filtered(texture, texcoord, [&](std::size_t texel) {
                const auto* sample = &samples[channels * texel];
                const double red = linear_value(sample[0], is_srgb);
                if (channels < 3) return glm::dvec3(red);
                return glm::dvec3(red, linear_value(sample[1], is_srgb),
                                  linear_value(sample[2], is_srgb));
            });
        },
        image.samples);
}

namespace {

/// Returns the largest linear value of the color channels of a texture.
double largest_color(const SurfaceTexture& texture) {
    const Image& image = *texture.image;
    const auto channels = static_cast<std::size_t>(image.channels);
    const std::size_t colors = channels < 3 ? 1 : 3;
    const bool is_srgb = image.color_space == ColorSpace::srgb;
    return std::visit(
        [&](const auto& samples) {
            auto largest = samples[0];
            for (std::size_t i = 0; i < samples.size(); ++i)
                if (i % channels < colors) largest = std::max(largest, samples[i]);
            return linear_value(largest, is_srgb);
        },
        image.samples);
}

/// Returns the alpha of a texture; 1 if it has none.
double alpha_at(const SurfaceTexture& texture, const glm::dvec2& texcoord) {
    const auto channels = static_cast<std::size_t>(texture.image->channels);
    if (channels != 2 && channels != 4) return 1.0;
    return std::visit(
        [&](const auto& samples) {
            return filtered(texture, texcoord, [&](std::size_t texel) {
                return linear_value(samples[channels * texel + channels - 1], false);
            });
        },
        texture.image->samples);
}

}  // namespace

glm::dvec3 normal_at(const SurfaceNormalMap& map, const glm::dvec2& texcoord) {
    const Image& image = *map.texture.image;
    const auto channels = static_cast<std::size_t>(image.channels);
    const auto scale = static_cast<double>(map.scale);
    const glm::dvec3 scales(scale, map.green == Green::up ? scale : -scale, 1.0);
    return std::visit(
        [&](const auto& samples) {
            using Sample = std::decay_t<decltype(samples[0])>;
            const NormalCoding<Sample> coding{map.flat};
            const ExactFlat<Sample> exact(map.flat == FlatCode::half ? map.flat_codes
                                                                     : std::nullopt);
            return scales * filtered(map.texture, texcoord, [&](std::size_t texel) {
                       const Sample* sample = &samples[channels * texel];
                       if (exact.is_flat(sample[0], sample[1]))
                           return glm::dvec3(0.0, 0.0, coding.decoded(sample[2]));
                       return glm::dvec3(coding.decoded(sample[0]), coding.decoded(sample[1]),
                                         coding.decoded(sample[2]));
                   });
        },
        image.samples);
}

void check(const HighMaterials& detail) {
    std::vector<HighMaterial> all = detail.materials;
    if (detail.otherwise) all.push_back(*detail.otherwise);
    for (const HighMaterial& material : all) {
        if (material.color_texture) check(*material.color_texture, 1, "a color texture");
        if (material.surface_texture)
            check(*material.surface_texture, 1, "a texture of roughness and metalness");
        if (material.occlusion_texture)
            check(*material.occlusion_texture, 1, "an occlusion texture");
        if (material.emission_texture) check(*material.emission_texture, 1, "an emission texture");
        if (material.normal_map) check(material.normal_map->texture, 3, "a normal map");
    }
    const std::size_t vertices = detail.mesh->positions.size();
    if (!detail.color_texcoords.empty() && detail.color_texcoords.size() != vertices) {
        throw InvalidInput(fmt::format("{} texture coordinates for {} vertices",
                                       detail.color_texcoords.size(), vertices));
    }
    for (const MaterialRange& range : detail.mesh->material_ranges) {
        if (range.material && *range.material >= detail.materials.size()) {
            throw InvalidInput(fmt::format("a high mesh names material {}, but there are only {}",
                                           *range.material, detail.materials.size()));
        }
    }
}

glm::uvec3 from_first_position(std::span<const glm::vec3> positions, const glm::uvec3& triangle) {
    const auto is_before = [&](std::uint32_t a, std::uint32_t b) {
        const glm::vec3& p = positions[a];
        const glm::vec3& q = positions[b];
        return std::tie(p.x, p.y, p.z) < std::tie(q.x, q.y, q.z);
    };
    const std::uint32_t x = triangle.x, y = triangle.y, z = triangle.z;
    if (is_before(y, x) && !is_before(z, y)) return {y, z, x};
    if (is_before(z, x)) return {z, x, y};
    return triangle;
}

HighSurface::HighSurface(std::span<const Mesh> meshes, const BakeOptions& options, Report& report)
    : made_(meshes.size()) {
    std::vector<RayMesh> ray_meshes;
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        validate(meshes[i]);
        entries_.push_back(entry(meshes[i], i, options, report));
        ray_meshes.push_back({entries_[i].mesh->positions, entries_[i].triangles});
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
    if (!entry.ids.empty()) result.push_back(id_of(entry, met.triangle));
    return result;
}

HighSurface::Entry HighSurface::entry(const Mesh& mesh, std::size_t index,
                                      const BakeOptions& options, Report& report) {
    const BakeLayers& layers = options.map.layers;
    Entry result;
    result.mesh = &mesh;
    const HighMaterials* detail = detail_of(mesh, options);
    report_missing(mesh, detail, index, layers, report);
    const bool has_textures = layers.colors || layers.opacity || layers.surface || layers.emission;
    if (layers.normals || has_textures) result.detail = detail;
    if (has_textures && detail != nullptr) {
        result.color_texcoords =
            detail->color_texcoords.empty() ? mesh.texcoords : detail->color_texcoords;
    }
    const bool needs_tangents = layers.normals && has_normal_map(detail) &&
                                !mesh.texcoords.empty() &&
                                (mesh.tangents.empty() || mesh.normals.empty());
    if (!mesh.triangles.empty() && (mesh.normals.empty() || needs_tangents)) {
        FrameOptions frames;
        frames.tangents = needs_tangents ? TangentMethod::mikktspace : TangentMethod::none;
        FramedMesh framed = with_frames(mesh, frames, report);
        made_[index] = std::move(framed.mesh);
        result.mesh = &made_[index];
        for (const std::uint32_t vertex : framed.source_vertex) {
            if (!result.color_texcoords.empty())
                result.split_texcoords.push_back(result.color_texcoords[vertex]);
        }
        if (!result.split_texcoords.empty()) result.color_texcoords = result.split_texcoords;
    }
    result.triangles = result.mesh->triangles;
    parallel_for(result.triangles.size(), 16384, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t)
            result.triangles[t] = from_first_position(result.mesh->positions, result.triangles[t]);
    });
    if (layers.curvature)
        result.curvature = mean_curvatures(result.mesh->positions, result.triangles, report);
    if (layers.ids) result.names = names_of(mesh, options);
    return result;
}

const HighMaterial* HighSurface::material(const RayHit& hit) const {
    const Entry& entry = entries_[hit.mesh];
    if (entry.detail == nullptr) return nullptr;
    const HighMaterial* otherwise = entry.detail->otherwise ? &*entry.detail->otherwise : nullptr;
    const std::vector<MaterialRange>& ranges = entry.mesh->material_ranges;
    if (ranges.empty()) {
        // Without ranges, one material applies to all triangles.
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

glm::dvec3 HighSurface::smooth_normal(const RayHit& hit, std::size_t sample, Report& report) const {
    const Entry& entry = entries_[hit.mesh];
    const glm::dvec3 unit = direction_or_zero(interpolated<glm::vec3>(
        entry.mesh->normals, entry.triangles[hit.triangle], hit, glm::dvec3(0.0)));
    if (unit != glm::dvec3(0.0)) return unit;
    report.add("high normal without direction", "texel", sample, "is its triangle's");
    return face_normal(hit);
}

glm::dvec3 HighSurface::normal(const RayHit& hit, std::size_t sample, Report& report) const {
    const HighMaterial* hit_material = material(hit);
    const Mesh& mesh = *entries_[hit.mesh].mesh;
    if (hit_material == nullptr || !hit_material->normal_map || mesh.tangents.empty() ||
        mesh.texcoords.empty())
        return smooth_normal(hit, sample, report);
    const glm::uvec3& corners = entries_[hit.mesh].triangles[hit.triangle];
    TexelFrame frame(mesh, corners, hit.weights);
    const GltfTextureTransform& transform = hit_material->normal_map->texture.transform;
    if (transform != GltfTextureTransform{}) frame = frame.transformed_by(transform);
    const glm::dvec2 texcoord =
        interpolated<glm::vec2>(mesh.texcoords, corners, hit, glm::dvec2(0.0));
    const glm::dvec3 unit =
        direction_or_zero(frame.to_object(normal_at(*hit_material->normal_map, texcoord)));
    if (frame.is_usable() && unit != glm::dvec3(0.0)) return unit;
    report.add("high normal map without a frame or a direction", "texel", sample, "is left out");
    return smooth_normal(hit, sample, report);
}

glm::dvec3 HighSurface::position(const RayHit& hit) const {
    const auto corners = scene_->corners(hit.mesh, hit.triangle);
    return hit.weights.x * corners[0] + hit.weights.y * corners[1] + hit.weights.z * corners[2];
}

double HighSurface::curvature(const RayHit& hit) const {
    const Entry& entry = entries_[hit.mesh];
    const glm::uvec3& corners = entry.triangles[hit.triangle];
    const double value = interpolated<float>(entry.curvature, corners, hit, 0.0);
    return hit.faces_origin ? value : -value;
}

glm::dvec3 HighSurface::color(const RayHit& hit) const {
    const Entry& entry = entries_[hit.mesh];
    const glm::uvec3& corners = entry.triangles[hit.triangle];
    glm::dvec3 color(1.0);
    if (!entry.mesh->colors.empty()) {
        color =
            glm::dvec3(interpolated<glm::vec4>(entry.mesh->colors, corners, hit, glm::dvec4(0.0)));
    }
    const HighMaterial* hit_material = material(hit);
    if (hit_material == nullptr) return color;
    return color * glm::dvec3(hit_material->color) * textured(hit_material->color_texture, hit);
}

glm::dvec3 HighSurface::textured(const std::optional<SurfaceTexture>& texture,
                                 const RayHit& hit) const {
    if (!texture || entries_[hit.mesh].color_texcoords.empty()) return glm::dvec3(1.0);
    return color_at(*texture, color_texcoord(hit));
}

glm::dvec3 HighSurface::surface(const RayHit& hit) const {
    const HighMaterial* hit_material = material(hit);
    if (hit_material == nullptr) return {1.0, 1.0, 0.0};
    const glm::dvec3 texel = textured(hit_material->surface_texture, hit);
    const double hidden = 1.0 - textured(hit_material->occlusion_texture, hit).r;
    return {1.0 - static_cast<double>(hit_material->occlusion_strength) * hidden,
            static_cast<double>(hit_material->roughness) * texel.g,
            static_cast<double>(hit_material->metallic) * texel.b};
}

glm::dvec3 HighSurface::emission(const RayHit& hit) const {
    const HighMaterial* hit_material = material(hit);
    if (hit_material == nullptr) return glm::dvec3(0.0);
    return glm::dvec3(hit_material->emission) * textured(hit_material->emission_texture, hit);
}

glm::dvec2 HighSurface::color_texcoord(const RayHit& hit) const {
    const Entry& entry = entries_[hit.mesh];
    return interpolated<glm::vec2>(entry.color_texcoords, entry.triangles[hit.triangle], hit,
                                   glm::dvec2(0.0));
}

double HighSurface::opacity(const RayHit& hit) const {
    const HighMaterial* hit_material = material(hit);
    if (hit_material == nullptr || !hit_material->opacity) return 1.0;
    const Entry& entry = entries_[hit.mesh];
    auto opacity = static_cast<double>(*hit_material->opacity);
    if (!entry.mesh->colors.empty()) {
        const glm::uvec3& corners = entry.triangles[hit.triangle];
        opacity *= interpolated<glm::vec4>(entry.mesh->colors, corners, hit, glm::dvec4(0.0)).w;
    }
    if (hit_material->color_texture && !entry.color_texcoords.empty())
        opacity *= alpha_at(*hit_material->color_texture, color_texcoord(hit));
    if (!hit_material->alpha_cutoff) return opacity;
    return opacity >= static_cast<double>(*hit_material->alpha_cutoff) ? 1.0 : 0.0;
}

void HighSurface::add_names(std::vector<std::string>& names) const {
    for (const Entry& entry : entries_) {
        for (const NamedTriangles& named : entry.names)
            names.push_back(named.name);
    }
}

void HighSurface::number_ids(const std::vector<SurfaceId>& ids) {
    for (Entry& entry : entries_) {
        for (const NamedTriangles& named : entry.names) {
            const auto id = std::ranges::lower_bound(ids, named.name, {}, &SurfaceId::name);
            entry.ids.push_back(static_cast<std::uint32_t>(id - ids.begin()));
        }
    }
}

std::uint32_t HighSurface::id_of(const Entry& entry, std::uint32_t triangle) const {
    const auto next =
        std::ranges::upper_bound(entry.names, triangle, {}, &NamedTriangles::first_triangle);
    return entry.ids[static_cast<std::size_t>(next - entry.names.begin()) - 1];
}

std::uint32_t HighSurface::id(const RayHit& hit) const {
    return id_of(entries_[hit.mesh], hit.triangle);
}

HighSurface::CurvatureRange HighSurface::curvature_range() const {
    CurvatureRange range;
    std::vector<std::pair<float, double>>
        curvatures;  // Absolute curvatures of corners, with their shares of the area.
    double area = 0.0;
    for (std::size_t i = 0; i < entries_.size(); ++i) {
        const Entry& entry = entries_[i];
        for (const float value : entry.curvature)
            range.max = std::max(range.max, static_cast<double>(std::abs(value)));
        // A large mesh is sampled with a stride.
        const std::size_t stride = entry.triangles.size() / max_area_samples + 1;
        for (std::size_t triangle = 0; triangle < entry.triangles.size(); triangle += stride) {
            const auto corners = scene_->corners(static_cast<std::uint32_t>(i),
                                                 static_cast<std::uint32_t>(triangle));
            const double share =
                glm::length(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
            if (entry.curvature.empty() || !std::isfinite(share)) continue;
            for (int corner = 0; corner < 3; ++corner) {
                const std::uint32_t vertex = entry.triangles[triangle][corner];
                curvatures.emplace_back(std::abs(entry.curvature[vertex]), share);
                area += share;
            }
        }
    }
    std::sort(curvatures.begin(), curvatures.end());
    double below = 0.0;
    for (const auto& [size, share] : curvatures) {
        range.usual = static_cast<double>(size);
        below += share;
        if (below >= usual_share * area) break;
    }
    return range;
}

double HighSurface::largest_emission() const {
    double largest = 0.0;
    for (const Entry& entry : entries_) {
        if (entry.detail == nullptr) continue;
        const auto add = [&](const HighMaterial& material) {
            const glm::dvec3 factor(material.emission);
            const double brightest = std::max({factor.r, factor.g, factor.b});
            if (brightest <= 0.0) return;
            const bool has_texture = material.emission_texture && !entry.color_texcoords.empty();
            largest = std::max(largest, has_texture
                                            ? brightest * largest_color(*material.emission_texture)
                                            : brightest);
        };
        std::ranges::for_each(entry.detail->materials, add);
        if (entry.detail->otherwise) add(*entry.detail->otherwise);
    }
    return largest;
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

}  // namespace relief::detail
