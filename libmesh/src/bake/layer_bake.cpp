// SPDX-License-Identifier: Apache-2.0
// Tests: tests/mesh/bake/bake_layers_test.cpp.
#include "bake/layer_bake.h"

#include "geometry/direction.h"

namespace relief {
namespace {

void store_mean(const glm::dvec3& sum, std::uint32_t hits, std::span<float> values,
                std::size_t at) {
    const glm::vec3 mean = hits > 0 ? rounded(sum / static_cast<double>(hits)) : glm::vec3(0.0F);
    for (int axis = 0; axis < 3; ++axis)
        values[3 * at + static_cast<std::size_t>(axis)] = mean[axis];
}

}  // namespace

LayerBake::LayerBake(const BakeLayers& layers, std::size_t first_texel, std::size_t texels,
                     std::uint32_t first_samples)
    : layers_(layers), first_texel_(first_texel), hits_(texels, 0) {
    if (layers.occlusion) {
        occlusion_.emplace(*layers.occlusion, first_samples);
        open_.resize(texels);
    }
    if (layers.curvature) curvature_.resize(texels);
    if (layers.positions) positions_.resize(texels);
    if (layers.colors) colors_.resize(texels);
}

std::size_t LayerBake::add(const HighSurface& high, std::span<const LayerHit> hits, Report& found) {
    for (const LayerHit& here : hits) {
        ++hits_[here.texel];
        if (layers_.curvature) curvature_[here.texel] += high.curvature(here.hit);
        if (layers_.colors) colors_[here.texel] += high.color(here.hit);
        if (layers_.positions) {
            positions_[here.texel] +=
                glm::dvec3(layers_.position_from_mesh * glm::dvec4(high.position(here.hit), 1.0));
        }
    }
    return occlusion_ ? add_occlusion(high, hits, found) : 0;
}

std::size_t LayerBake::add_occlusion(const HighSurface& high, std::span<const LayerHit> hits,
                                     Report& found) {
    std::vector<OcclusionPlace> places;
    Report said;  // Of normals, where those are wanted too.
    Report& of_normals = layers_.normals ? said : found;
    for (const LayerHit& here : hits) {
        const double side = here.hit.faces_origin ? 1.0 : -1.0;
        const std::size_t texel = first_texel_ + here.texel;
        places.push_back({high.position(here.hit),
                          side * high.smooth_normal(here.hit, texel, of_normals),
                          side * high.face_normal(here.hit), texel, here.sample});
    }
    const std::vector<double> shares = occlusion_->open_shares(high.scene(), places, found);
    for (std::size_t i = 0; i < hits.size(); ++i)
        open_[hits[i].texel] += shares[i];
    return places.size() * occlusion_->rays_of_sample();
}

void LayerBake::store(std::size_t texel, const BakedRows& rows, std::size_t at) const {
    const std::uint32_t hits = hits_[texel];
    if (layers_.occlusion)
        rows.occlusion[at] = hits > 0 ? static_cast<float>(open_[texel] / hits) : 1.0F;
    if (layers_.curvature)
        rows.curvature[at] = hits > 0 ? static_cast<float>(curvature_[texel] / hits) : 0.0F;
    if (layers_.positions) store_mean(positions_[texel], hits, rows.positions, at);
    if (layers_.colors) store_mean(colors_[texel], hits, rows.colors, at);
}

}  // namespace relief
