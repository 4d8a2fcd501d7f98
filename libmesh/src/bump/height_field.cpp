// SPDX-License-Identifier: Apache-2.0
// Height maps as surfaces, and their exact intersection with a ray: a walk through the bilinear
// patches along the ray, as in a grid of voxels [Amanatides and Woo 1987].
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "bump/height_field_data.h"
#include "image/height_holes.h"
#include "image/texel_loops.h"
#include "portable_math.h"
#include "relief/mesh/height_map.h"
#include "relief/mesh/height_march.h"

namespace relief {
using namespace relief::detail;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

void clamp_heights(std::vector<float>& heights, Report& report) {
    for_each_texel(heights.size(), report, [&](std::size_t texel, Report& found) {
        float& height = heights[texel];
        if (height >= 0.0F && height <= 1.0F) return;
        found.add("height outside of 0 to 1", "texel", texel, "is clamped");
        height = std::clamp(height, 0.0F, 1.0F);
    });
}

BilinearHeights usable_heights(const Image& image, const Wraps& wraps, Report& report) {
    if (image.channels != 1)
        throw InvalidInput(
            fmt::format("the height map has {} channels, but must have 1", image.channels));
    Image field = height_field(image);
    std::vector<float> filled = filled_holes(field, wraps, report);
    if (!filled.empty()) field.samples = std::move(filled);
    auto& heights = std::get<std::vector<float>>(field.samples);
    clamp_heights(heights, report);
    return {heights, field.width, field.height, wraps};
}

std::shared_ptr<const HeightFieldData> field_data(BilinearHeights heights) {
    std::vector<MaximumLevel> levels = maximum_levels(heights);
    return std::make_shared<const HeightFieldData>(
        HeightFieldData{std::move(heights), std::move(levels)});
}

/// The patches along one axis.
class PatchSteps {
  public:
    PatchSteps(double start, double step)
        : start_(start), step_(step), patch_(static_cast<std::int64_t>(std::floor(start))) {}

    [[nodiscard]] std::int64_t patch() const { return patch_; }
    /// Returns where the ray leaves the patch.
    [[nodiscard]] double exit() const {
        if (step_ == 0.0) return infinity;
        return (static_cast<double>(step_ > 0.0 ? patch_ + 1 : patch_) - start_) / step_;
    }
    /// Returns the position in the patch.
    [[nodiscard]] double within(double t) const {
        return std::clamp(start_ + step_ * t - static_cast<double>(patch_), 0.0, 1.0);
    }
    void advance() { patch_ += step_ > 0.0 ? 1 : -1; }

  private:
    double start_;
    double step_;
    std::int64_t patch_;
};

}  // namespace

HeightField::HeightField(const Image& heights, const Wraps& wraps, Report& report)
    : data_(field_data(usable_heights(heights, wraps, report))) {}

glm::ivec2 HeightField::size() const {
    return {data_->heights.width(), data_->heights.height()};
}

const Wraps& HeightField::wraps() const {
    return data_->heights.wraps();
}

double HeightField::height(const glm::dvec2& texcoord) const {
    return data_->heights.at(texcoord);
}

glm::dvec2 HeightField::slope(const glm::dvec2& texcoord) const {
    const BilinearHeights& heights = data_->heights;
    const PatchSteps x(near_map(texcoord.x, heights.width(), heights.wraps().x), 0.0);
    const PatchSteps y(near_map(texcoord.y, heights.height(), heights.wraps().y), 0.0);
    return heights.patch(x.patch(), y.patch()).slope(x.within(0.0), y.within(0.0));
}

HeightHit HeightField::first_hit(const HeightRay& ray) const {
    const BilinearHeights& heights = data_->heights;
    HeightHit hit;
    hit.texcoord = ray.texcoord;
    hit.depth = ray.start_depth;
    const double longest =
        std::max({std::abs(ray.direction.x), std::abs(ray.direction.y), std::abs(ray.direction.z)});
    const bool enters = longest > 0.0 && is_finite(ray.direction) && is_finite(ray.texcoord) &&
                        std::isfinite(ray.black_depth) && std::isfinite(ray.start_depth) &&
                        std::isfinite(ray.bend) && (ray.direction.z > 0.0 || ray.start_depth > 0.0);
    if (!enters) return hit;
    const glm::dvec3 direction = ray.direction / longest;
    double end = infinity;
    HeightRayEnd end_kind = HeightRayEnd::left;
    double bend = 0.0;  // For each square of a texel of the longest component.
    if (direction.z > 0.0) {
        bend = ray.bend * direction.z * direction.z;
        const BentDepth depths{ray.start_depth, ray.bend};
        end = std::max(0.0, depths.way_to(ray.black_depth));
        if (end < infinity)  // Below black is no room: only rounding hides this hit.
            end_kind = HeightRayEnd::hit;
        else
            end = depths.way_out();
        end /= direction.z;
    } else if (direction.z < 0.0) {
        end = ray.start_depth / -direction.z;
    }
    const auto depth_at = [&](double t) { return ray.start_depth + (direction.z - bend * t) * t; };

    PatchSteps x(near_map(ray.texcoord.x, heights.width(), heights.wraps().x), direction.x);
    PatchSteps y(near_map(ray.texcoord.y, heights.height(), heights.wraps().y), direction.y);
    double t = 0.0;  // Along the ray, in texels of the longest component.
    const auto end_at = [&](double where, const BilinearPatch& patch, HeightRayEnd kind) {
        hit.texcoord += glm::dvec2(direction) * where / heights.size();
        hit.depth = std::clamp(depth_at(where), 0.0, ray.black_depth);
        hit.way = direction.z * where;
        hit.slope = ray.black_depth * patch.slope(x.within(where), y.within(where));
        hit.end = kind;
        return hit;
    };
    while (true) {
        const BilinearPatch patch = heights.patch(x.patch(), y.patch());
        ++hit.lookups;
        const double exit = std::max(t, std::min({x.exit(), y.exit(), end}));
        const glm::dvec3 here(direction.x, direction.y, direction.z - 2.0 * bend * t);
        const double root = t + patch_hit(patch, {x.within(t), y.within(t)}, here, depth_at(t),
                                          ray.black_depth, bend);
        if (root <= exit) return end_at(root, patch, HeightRayEnd::hit);
        if (exit >= end) return end_at(end, patch, end_kind);
        if (hit.lookups == max_patches) return end_at(exit, patch, HeightRayEnd::exceeded);
        t = exit;
        if (x.exit() <= exit)
            x.advance();
        else
            y.advance();
    }
}

bool HeightField::is_shadowed(const HeightRay& ray) const {
    // The bound is that of march().
    constexpr double max_slant_squared = 1e12;
    const glm::dvec2 slant = glm::dvec2(ray.direction) / ray.direction.z;
    const bool rises = ray.direction.z < 0.0 && is_finite(ray.texcoord) &&
                       std::isfinite(ray.black_depth) && glm::dot(slant, slant) < max_slant_squared;
    if (!rises) return true;
    HeightRay lifted = ray;
    const double below_white = 1.0 - height(ray.texcoord);
    lifted.start_depth = ray.black_depth * std::max(0.0, below_white - shadow_lift);
    return first_hit(lifted).end == HeightRayEnd::hit;
}

}  // namespace relief
