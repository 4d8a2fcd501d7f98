// SPDX-License-Identifier: Apache-2.0
// The methods by which shaders find where a ray meets a height map, in double precision and with
// the same steps as shaders/height_march.glsl. All are in texel space: the ray is at p + k s
// after the way s, at the depth s - bend s^2, and the depth of the surface is D (1 - h).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "bump/height_field_data.h"
#include "image/texel_loops.h"
#include "portable_math.h"
#include "relief/mesh/height_march.h"

namespace relief {
using namespace relief::detail;

namespace {

constexpr double no_exit = std::numeric_limits<double>::infinity();

void check_range(const char* name, int value, int min, int max) {
    if (value < min || value > max)
        throw InvalidInput(
            fmt::format("{} is {}, but must be from {} to {}", name, value, min, max));
}

/// A ray that goes down, with its lookups.
class Marching {
  public:
    Marching(const HeightFieldData& field, const HeightRay& ray)
        : field_(field),
          origin_(ray.texcoord),
          k_(glm::dvec2(ray.direction) / ray.direction.z),
          black_depth_(ray.black_depth),
          depths_{0.0, ray.bend},
          end_(depths_.way_to(black_depth_)),
          leaves_(std::isinf(end_)) {
        if (leaves_) end_ = depths_.way_out();
    }

    /// Returns how far the point after a way is below the surface; negative above it.
    double below_surface(double way) {
        ++lookups_;
        return depths_.at(way) - black_depth_ * (1.0 - field_.heights.at(texcoord(way)));
    }

    [[nodiscard]] glm::dvec2 texcoord(double way) const {
        return origin_ + k_ * way / field_.heights.size();
    }
    [[nodiscard]] double depth(double way) const { return depths_.at(way); }

    // The methods return the way to the hit: its depth, if the ray is straight.
    double parallax();
    double parallax_occlusion(int layers);
    double relief_mapping(int layers, int bisections);
    double relaxed_cones(int steps, int bisections, const HeightField& cones);
    double maximum_mipmaps(int max_steps);

    [[nodiscard]] int lookups() const { return lookups_; }
    [[nodiscard]] bool is_exceeded() const { return is_exceeded_; }
    /// Tells whether the ray leaves before a way.
    [[nodiscard]] bool has_left(double way) const { return leaves_ && way >= end_; }

  private:
    /// Two ways, and how far their points are below the surface.
    struct Interval {
        double above = 0.0, below = 0.0;
        double below_at_above = 0.0, below_at_below = 0.0;
    };
    Interval first_layer_below(int layers);
    double bisected(double above, double below, int bisections);

    const HeightFieldData& field_;
    glm::dvec2 origin_;
    glm::dvec2 k_;
    double black_depth_;
    BentDepth depths_;
    double end_;   ///< The way to black, or out of the relief.
    bool leaves_;  ///< The ray does not reach black.
    int lookups_ = 0;
    bool is_exceeded_ = false;
};

/// The offset for the depth at the point on the surface of white [Kaneko 2001].
double Marching::parallax() {
    return std::min(depths_.way_to(-below_surface(0.0)), end_);
}

/// Returns the last of the layers at the ways i / N to the end that is above the surface, and the
/// next one.
Marching::Interval Marching::first_layer_below(int layers) {
    Interval result;
    result.below_at_below = below_surface(0.0);
    for (int i = 1; i <= layers && result.below_at_below < 0.0; ++i) {
        result.above = result.below;
        result.below_at_above = result.below_at_below;
        result.below = end_ * i / layers;
        result.below_at_below = below_surface(result.below);
    }
    return result;
}

/// The heights are taken to be linear between two layers [Tatarchuk 2006]: the line through both
/// points, from a above to b below the surface, meets it at a / (a + b).
double Marching::parallax_occlusion(int layers) {
    const Interval around = first_layer_below(layers);
    if (around.below_at_below < 0.0) return around.below;  // The ray leaves.
    const double both = around.below_at_below - around.below_at_above;
    const double weight = both > 0.0 ? std::clamp(-around.below_at_above / both, 0.0, 1.0) : 0.0;
    return around.above + (around.below - around.above) * weight;
}

double Marching::bisected(double above, double below, int bisections) {
    for (int i = 0; i < bisections; ++i) {
        const double middle = 0.5 * (above + below);
        (below_surface(middle) < 0.0 ? above : below) = middle;
    }
    return below;
}

/// A linear search, then a binary one [Policarpo et al. 2005].
double Marching::relief_mapping(int layers, int bisections) {
    const Interval around = first_layer_below(layers);
    return bisected(around.above, around.below, bisections);
}

/// A point at g above the surface is on the axis of a cone with the ratio c of radius to height.
/// The ray leaves the cone after the depth d where |k| d = c (g - d), so d = c g / (|k| + c)
/// [Policarpo and Oliveira 2007]. It is then below the surface if it has crossed it. Bent rays take
/// the largest rate at which they go down from there on, so that they stay within the cone.
double Marching::relaxed_cones(int steps, int bisections, const HeightField& cones) {
    const glm::dvec2 size = field_.heights.size();
    const double slant = std::sqrt(k_.x * k_.x + k_.y * k_.y);
    // Cone maps have the ratio for a map of size 1 and a depth of 1, as its square root.
    const double scale = std::max(size.x, size.y) / std::max(black_depth_, 1e-9);
    double above = 0.0;
    double below = 0.0;
    for (int i = 0; i < steps; ++i) {
        const double gap = -below_surface(below);
        if (gap <= 0.0) break;
        const double root = cones.height(texcoord(below));
        const double cone = root * root * scale;
        above = below;
        // A cone of no width stops the ray; straight down, every other cone ends at the surface.
        if (cone > 0.0) {
            const double rate = std::max({depths_.rate(below), depths_.rate(end_), 0.0});
            below = std::min(below + cone * gap / (slant + cone * rate), end_);
        }
    }
    return bisected(above, below, bisections);
}

/// A node of a level along one axis, and the patches that it covers.
struct NodeSpan {
    int node = 0;
    std::int64_t first = 0;
    std::int64_t last = 0;  ///< Exclusive.
};

NodeSpan span_within(std::int64_t patch, int count, int level) {
    const int last_node = std::max(count >> level, 1) - 1;
    const int node = std::min(static_cast<int>(patch >> level), last_node);
    const std::int64_t first = std::int64_t{node} << level;
    return {node, first, node == last_node ? count : (std::int64_t{node} + 1) << level};
}

NodeSpan node_span(std::int64_t patch, int count, Wrap wrap, int level) {
    constexpr std::int64_t endless = std::int64_t{1} << 50;
    const auto floor_of = [](std::int64_t a, std::int64_t b) {
        return a / b - (a % b != 0 && a < 0 ? 1 : 0);
    };
    if (wrap == Wrap::clamp) {
        // Outside, the border texels continue, whose maximum the last node has.
        if (patch < 0) return {span_within(0, count, level).node, -endless, 0};
        if (patch >= count) return {span_within(count - 1, count, level).node, count, endless};
        return span_within(patch, count, level);
    }
    const std::int64_t period = wrap == Wrap::mirror ? 2 * std::int64_t{count} : count;
    const std::int64_t before = floor_of(patch, period) * period;
    const std::int64_t within = patch - before;
    NodeSpan span;
    if (within < count) {
        span = span_within(within, count, level);
    } else {
        const std::int64_t mirrored = 2 * std::int64_t{count} - 2 - within;
        // The patch between both images of the first texel.
        if (mirrored < 0) return {0, patch, patch + 1};
        const NodeSpan original = span_within(mirrored, count, level);
        span.node = original.node;
        span.first = 2 * std::int64_t{count} - 1 - std::min<std::int64_t>(original.last, count - 1);
        span.last = 2 * std::int64_t{count} - 1 - original.first;
    }
    span.first += before;
    span.last += before;
    return span;
}

/// Skips nodes whose maximum the ray does not reach within them, and descends into the others; it
/// ascends if the ray leaves the parent of a node [Tevs et al. 2008]. At level 0, the ray is
/// intersected with the bilinear patch exactly.
double Marching::maximum_mipmaps(int max_steps) {
    const BilinearHeights& heights = field_.heights;
    const int last_level = static_cast<int>(field_.levels.size()) - 1;
    const glm::dvec2 from(near_map(origin_.x, heights.width(), heights.wraps().x),
                          near_map(origin_.y, heights.height(), heights.wraps().y));
    const auto patch_at = [](double position, std::int64_t first, std::int64_t last) {
        const double inside = std::clamp(std::floor(position), static_cast<double>(first),
                                         static_cast<double>(last - 1));
        return static_cast<std::int64_t>(inside);
    };
    const auto exit_depth = [](double start, double rate, const NodeSpan& span) {
        if (rate == 0.0) return no_exit;
        return (static_cast<double>(rate > 0.0 ? span.last : span.first) - start) / rate;
    };
    auto column = static_cast<std::int64_t>(std::floor(from.x));
    auto row = static_cast<std::int64_t>(std::floor(from.y));
    // The nodes of the first level are as large as the ray is long, but have at most 8 x 8 patches:
    // larger ones are rarely skipped at once.
    constexpr int max_first_level = 3;
    const double reach = end_ * std::max(std::abs(k_.x), std::abs(k_.y)) + 1.0;
    int level = 0;
    while (level < std::min(last_level, max_first_level) &&
           static_cast<double>(std::int64_t{1} << level) < reach)
        ++level;
    double way = 0.0;
    for (int i = 0; i < max_steps; ++i) {
        const NodeSpan x = level > 0 ? node_span(column, heights.width(), heights.wraps().x, level)
                                     : NodeSpan{0, column, column + 1};
        const NodeSpan y = level > 0 ? node_span(row, heights.height(), heights.wraps().y, level)
                                     : NodeSpan{0, row, row + 1};
        const double leaves_x = exit_depth(from.x, k_.x, x);
        const double leaves_y = exit_depth(from.y, k_.y, y);
        const double end = std::min(std::min(leaves_x, leaves_y), end_);
        if (level > 0) {
            ++lookups_;
            const MaximumLevel& maxima = field_.levels[static_cast<std::size_t>(level)];
            const double top = black_depth_ * (1.0 - maxima.at(x.node, y.node));
            if (depths_.deepest(way, std::max(way, end)) >= top) {
                --level;
                if (top <= depths_.at(way)) continue;  // Rounding must not lead back to a patch.
                way = std::max(way, std::min(depths_.way_to(top), end));
                column = patch_at(from.x + k_.x * way, x.first, x.last);
                row = patch_at(from.y + k_.y * way, y.first, y.last);
                continue;
            }
        } else {
            lookups_ += 4;
            const auto within = [&](double start, double rate, std::int64_t patch) {
                return std::clamp(start + rate * way - static_cast<double>(patch), 0.0, 1.0);
            };
            const glm::dvec2 at(within(from.x, k_.x, column), within(from.y, k_.y, row));
            const double hit =
                way + patch_hit(heights.patch(column, row), at, glm::dvec3(k_, depths_.rate(way)),
                                depths_.at(way), black_depth_, depths_.bend);
            if (hit <= end) return hit;
        }
        if (end >= end_) return end_;
        way = std::max(way, end);
        const std::int64_t left_column = column;
        const std::int64_t left_row = row;
        column = patch_at(from.x + k_.x * way, x.first, x.last);
        row = patch_at(from.y + k_.y * way, y.first, y.last);
        if (leaves_x <= leaves_y) column = k_.x > 0.0 ? x.last : x.first - 1;
        if (leaves_y <= leaves_x) row = k_.y > 0.0 ? y.last : y.first - 1;
        const bool leaves_parent =
            (((column ^ left_column) | (row ^ left_row)) >> (level + 1)) != 0;
        if (leaves_parent) level = std::min(level + 1, last_level);
    }
    is_exceeded_ = true;
    return way;
}

MaximumLevel patch_maxima(const BilinearHeights& heights) {
    MaximumLevel level{heights.width(), heights.height(), {}};
    const auto width = static_cast<std::size_t>(level.width);
    level.maxima.resize(width * static_cast<std::size_t>(level.height));
    parallel_for(level.maxima.size(), texels_per_piece, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const BilinearPatch patch = heights.patch(static_cast<std::int64_t>(i % width),
                                                      static_cast<std::int64_t>(i / width));
            level.maxima[i] = static_cast<float>(patch.max());
        }
    });
    return level;
}

MaximumLevel next_level(const MaximumLevel& finer) {
    MaximumLevel level{std::max(finer.width / 2, 1), std::max(finer.height / 2, 1), {}};
    level.maxima.reserve(static_cast<std::size_t>(level.width) *
                         static_cast<std::size_t>(level.height));
    for (int row = 0; row < level.height; ++row) {
        const int last_row = row + 1 == level.height ? finer.height : 2 * row + 2;
        for (int column = 0; column < level.width; ++column) {
            const int last_column = column + 1 == level.width ? finer.width : 2 * column + 2;
            float max = 0.0F;
            for (int y = 2 * row; y < last_row; ++y) {
                for (int x = 2 * column; x < last_column; ++x)
                    max = std::max(max, finer.at(x, y));
            }
            level.maxima.push_back(max);
        }
    }
    return level;
}

}  // namespace

std::vector<MaximumLevel> detail::maximum_levels(const BilinearHeights& heights) {
    std::vector<MaximumLevel> levels{patch_maxima(heights)};
    while (levels.back().maxima.size() > 1)
        levels.push_back(next_level(levels.back()));
    return levels;
}

HeightHit HeightField::march(const HeightRay& ray, const HeightMarch& method,
                             const HeightField* cones) const {
    check_range("the number of layers", method.layers, 1, 512);
    check_range("the number of bisections", method.bisections, 0, 16);
    check_range("the maximum number of steps", method.max_steps, 1, 1024);
    if (method.method == HeightMethod::relaxed_cones &&
        (cones == nullptr || cones->size() != size()))
        throw InvalidInput("relaxed cones need a cone map of the size of the height map");
    HeightHit hit;
    hit.texcoord = ray.texcoord;
    // The bound is that of the shader, where squares of longer vectors overflow.
    constexpr double max_slant_squared = 1e12;
    const glm::dvec2 k = glm::dvec2(ray.direction) / ray.direction.z;
    const bool enters = ray.direction.z > 0.0 && is_finite(ray.texcoord) &&
                        std::isfinite(ray.black_depth) && std::isfinite(ray.bend) &&
                        glm::dot(k, k) < max_slant_squared;
    if (!enters) return hit;
    Marching marching(*data_, ray);
    switch (method.method) {
        case HeightMethod::parallax:
            hit.way = marching.parallax();
            break;
        case HeightMethod::parallax_occlusion:
            hit.way = marching.parallax_occlusion(method.layers);
            break;
        case HeightMethod::relief_mapping:
            hit.way = marching.relief_mapping(method.layers, method.bisections);
            break;
        case HeightMethod::relaxed_cones:
            hit.way = marching.relaxed_cones(method.layers, method.bisections, *cones);
            break;
        case HeightMethod::maximum_mipmaps:
            hit.way = marching.maximum_mipmaps(method.max_steps);
            break;
    }
    hit.depth = marching.depth(hit.way);
    hit.texcoord = marching.texcoord(hit.way);
    hit.slope = ray.black_depth * slope(hit.texcoord);
    hit.lookups = marching.lookups();
    hit.end = marching.is_exceeded()       ? HeightRayEnd::exceeded
              : marching.has_left(hit.way) ? HeightRayEnd::left
                                           : HeightRayEnd::hit;
    return hit;
}

}  // namespace relief
