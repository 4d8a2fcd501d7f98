// SPDX-License-Identifier: Apache-2.0
// Texel means of layers. Tests: tests/mesh/bake/bake_layers_test.cpp, bent_normals_test.cpp,
// bake_ids_test.cpp.
#include "bake/layers.h"

#include <algorithm>
#include <cmath>

#include "bake/bake_work.h"
#include "geometry/direction.h"
#include "portable_math.h"

namespace relief::detail {
namespace {

void store_vector(const glm::dvec3& vector, std::span<float> values, std::size_t at) {
    const glm::vec3 value = rounded(vector);
    for (int axis = 0; axis < 3; ++axis)
        values[3 * at + static_cast<std::size_t>(axis)] = value[axis];
}

void store_mean(const glm::dvec3& sum, std::uint32_t hits, std::span<float> values,
                std::size_t at) {
    store_vector(hits > 0 ? sum / static_cast<double>(hits) : glm::dvec3(0.0), values, at);
}

}  // namespace

void TexelIds::add(std::size_t texel, std::uint32_t id) {
    Votes& first = first_[texel];
    if (first.count == 0) first.id = id;
    if (first.id == id)
        ++first.count;
    else
        ++others_[{texel, id}];
}

std::optional<std::uint32_t> TexelIds::most_frequent(std::size_t texel) const {
    Votes best = first_[texel];
    if (best.count == 0) return std::nullopt;
    for (auto other = others_.lower_bound({texel, 0});
         other != others_.end() && other->first.first == texel; ++other) {
        const Votes votes{other->first.second, other->second};
        if (votes.count > best.count || (votes.count == best.count && votes.id < best.id))
            best = votes;
    }
    return best.id;
}

LayerBake::LayerBake(const BakeWork& work, std::size_t first_texel, std::size_t texels,
                     std::uint32_t min_samples)
    : work_(work), layers_(work.map.layers), first_texel_(first_texel), hits_(texels, 0) {
    if (layers_.occlusion || layers_.bent_normals) {
        const auto& options = layers_.occlusion ? layers_.occlusion : layers_.bent_normals;
        occlusion_.emplace(*options, min_samples);
    }
    if (layers_.thickness) {
        thickness_.emplace(*layers_.thickness, min_samples);
        distances_.resize(texels);
        has_surface_behind_.resize(texels);
        const double limit = work.parts.bounds({.thickness = layers_.thickness}).thickness;
        max_thickness_ = static_cast<float>(limit);
        if (static_cast<double>(max_thickness_) > limit)
            max_thickness_ = std::nextafter(max_thickness_, 0.0F);
    }
    if (layers_.occlusion) open_.resize(texels);
    if (layers_.bent_normals) bent_.resize(texels);
    if (layers_.ids) ids_.emplace(texels);
    if (layers_.curvature) curvature_.resize(texels);
    if (layers_.positions) positions_.resize(texels);
    if (layers_.colors) colors_.resize(texels);
    if (layers_.opacity) opacity_.resize(texels);
    if (layers_.surface) surfaces_.resize(texels);
    if (layers_.emission) emission_.resize(texels);
}

LayerRays LayerBake::add(const HighSurface& high, const RayScene& occluders,
                         std::span<const LayerHit> hits, Report& report) {
    for (const LayerHit& here : hits) {
        ++hits_[here.texel];
        if (layers_.ids) ids_->add(here.texel, high.id(here.hit));
        if (layers_.curvature) curvature_[here.texel] += high.curvature(here.hit);
        if (layers_.colors) colors_[here.texel] += high.color(here.hit);
        if (layers_.opacity) opacity_[here.texel] += high.opacity(here.hit);
        if (layers_.surface) surfaces_[here.texel] += high.surface(here.hit);
        if (layers_.emission) emission_[here.texel] += high.emission(here.hit);
        if (layers_.positions) {
            positions_[here.texel] +=
                glm::dvec3(layers_.position_from_mesh * glm::dvec4(high.position(here.hit), 1.0));
        }
    }
    LayerRays rays;
    if (!occlusion_ && !thickness_) return rays;
    Report ignored;  // The normal layer reports the same findings.
    const std::vector<OcclusionPlace> points =
        points_of(high, hits, layers_.normals ? ignored : report);
    if (occlusion_) rays.occlusion = add_occlusion(occluders, hits, points, report);
    if (thickness_) {
        const std::size_t open =
            add_thickness(high.scene(), hits, points, occlusion_ ? ignored : report);
        rays.thickness = points.size() * thickness_->rays_of_sample();
        rays.open_thickness = open;
    }
    return rays;
}

std::vector<OcclusionPlace> LayerBake::points_of(const HighSurface& high,
                                                 std::span<const LayerHit> hits,
                                                 Report& report) const {
    std::vector<OcclusionPlace> points;
    points.reserve(hits.size());
    for (const LayerHit& here : hits) {
        const double side = here.hit.faces_origin ? 1.0 : -1.0;
        const std::size_t texel = first_texel_ + here.texel;
        points.push_back({high.position(here.hit),
                          side * high.smooth_normal(here.hit, texel, report),
                          side * high.face_normal(here.hit), texel, here.sample});
    }
    return points;
}

std::size_t LayerBake::add_occlusion(const RayScene& scene, std::span<const LayerHit> hits,
                                     std::span<const OcclusionPlace> points, Report& report) {
    std::vector<glm::dvec3> bent(layers_.bent_normals ? hits.size() : 0);
    const std::vector<double> shares = occlusion_->open_shares(scene, points, report, bent);
    for (std::size_t i = 0; i < hits.size(); ++i) {
        if (layers_.occlusion) open_[hits[i].texel] += shares[i];
        if (layers_.bent_normals) add_bent(hits[i], points[i].normal, bent[i]);
    }
    return points.size() * occlusion_->rays_of_sample();
}

void LayerBake::add_bent(const LayerHit& here, const glm::dvec3& normal,
                         const glm::dvec3& direction) {
    BentSum& sum = bent_[here.texel];
    // Samples count with the length of their mean direction, not with that of the frame's axes.
    const auto in_map = [&](const glm::dvec3& vector) {
        const std::optional<glm::dvec3> unit = in_output_space(work_, here.owner, vector);
        sum.lacks_frame |= !unit;
        return glm::length(vector) * unit.value_or(glm::dvec3(0.0, 0.0, 1.0));
    };
    sum.normal += in_map(normal);
    if (direction != glm::dvec3(0.0)) sum.direction += in_map(direction);
}

std::size_t LayerBake::add_thickness(const RayScene& scene, std::span<const LayerHit> hits,
                                     std::span<const OcclusionPlace> points, Report& report) {
    std::size_t open = 0;
    const std::vector<PointThickness> thickness = thickness_->measure(scene, points, report);
    for (std::size_t i = 0; i < hits.size(); ++i) {
        const PointThickness& here = thickness[i];
        distances_[hits[i].texel] +=
            here.rays > 0 ? here.distance / static_cast<double>(here.rays) : 0.0;
        if (here.hits > 0) has_surface_behind_[hits[i].texel] = true;
        open += here.rays - here.hits;
    }
    return open;
}

void LayerBake::store(std::size_t texel, const BakedRows& rows, std::size_t at,
                      Report& report) const {
    const std::uint32_t hits = hits_[texel];
    const auto mean = [&](double sum) { return hits > 0 ? static_cast<float>(sum / hits) : 0.0F; };
    if (layers_.occlusion) rows.occlusion[at] = hits > 0 ? mean(open_[texel]) : 1.0F;
    if (layers_.curvature) rows.curvature[at] = mean(curvature_[texel]);
    if (layers_.positions) store_mean(positions_[texel], hits, rows.positions, at);
    if (layers_.colors) store_mean(colors_[texel], hits, rows.colors, at);
    if (layers_.surface) store_mean(surfaces_[texel], hits, rows.surface, at);
    if (layers_.emission) store_mean(emission_[texel], hits, rows.emission, at);
    if (layers_.opacity) rows.opacity[at] = mean(opacity_[texel]);
    if (layers_.bent_normals) store_bent(texel, rows, at, report);
    if (layers_.thickness) {
        // The mean of rays that hit nothing is the limit but for rounding.
        rows.thickness[at] = std::min(mean(distances_[texel]), max_thickness_);
        if (hits > 0 && !has_surface_behind_[texel]) {
            report.add("texel without a surface behind it", "texel", first_texel_ + texel,
                       "has the length of its rays as thickness");
        }
    }
    if (layers_.ids) {
        const std::optional<std::uint32_t> id = ids_->most_frequent(texel);
        rows.ids[at] = id ? static_cast<float>(*id) : -1.0F;
    }
}

void LayerBake::store_bent(std::size_t texel, const BakedRows& rows, std::size_t at,
                           Report& report) const {
    const BentSum& sum = bent_[texel];
    const std::size_t index = first_texel_ + texel;
    const glm::dvec3 flat(0.0, 0.0, 1.0);
    if (hits_[texel] == 0) return store_vector(flat, rows.bent_normals, at);
    if (sum.lacks_frame && !layers_.normals)
        report.add("texel without a frame", "texel", index, "is (0, 0, 1)");
    glm::dvec3 direction = direction_or_zero(sum.direction);
    if (direction == glm::dvec3(0.0)) {
        report.add("texel without an open ray", "texel", index,
                   "has the normal as its bent normal");
        direction = direction_or_zero(sum.normal);
    } else if (work_.options.space == VectorSpace::tangent && direction.z < 0.0) {
        report.add("bent normal behind the surface", "texel", index, "kept");
    }
    store_vector(direction == glm::dvec3(0.0) ? flat : direction, rows.bent_normals, at);
}

}  // namespace relief::detail
