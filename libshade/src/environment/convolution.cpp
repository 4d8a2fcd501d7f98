// SPDX-License-Identifier: Apache-2.0
// GGX with its directional albedo, and convolutions of an environment.
//
// The albedo is the mean over the facets that the eye sees [Heitz 2018]: the only weight is then
// the share of light that is not shadowed, which is at most 1, and an even grid of points converges
// fast. Nothing divides by zero for alpha above 0 and cosines above 0.
//
// Convolutions of an environment. Blurred radiance is a walk down a tree of texels: directions in
// the same tile of the result share one walk, and then go through its nodes side by side, in float,
// in a fixed order. Irradiance is a sum of spherical harmonics: the convolution with the cosine
// turns the radiance's coefficients L of order l into A_l L, A = pi, 2 pi / 3, pi / 4
// [Ramamoorthi and Hanrahan 2001]; both normalization constants of each harmonic, one from L and
// one from the sum that gives the irradiance, and the division by pi are multiplied in.
#include "environment/convolution.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "environment/environment_images.h"
#include "parallel.h"
#include "portable_math.h"
#include "relief/mesh/report.h"

namespace relief::shade::detail {
using namespace relief::detail;

// The distribution

double ggx_distribution(double n_h, double alpha) {
    const double squared = alpha * alpha;
    // 1 + n.h^2 (alpha^2 - 1), as a sum of positive terms.
    const double spread = (1.0 - n_h) * (1.0 + n_h) + n_h * n_h * squared;
    return squared / (std::numbers::pi * spread * spread);
}

double ggx_visibility(double n_l, double n_v, double alpha) {
    const double squared = alpha * alpha;
    const double towards_l = n_v * std::sqrt(n_l * n_l * (1.0 - squared) + squared);
    const double towards_v = n_l * std::sqrt(n_v * n_v * (1.0 - squared) + squared);
    return 0.5 / (towards_l + towards_v);
}

glm::dvec2 hammersley(unsigned i, unsigned n) {
    std::uint32_t bits = i;
    bits = (bits << 16U) | (bits >> 16U);
    bits = ((bits & 0x00ff00ffU) << 8U) | ((bits & 0xff00ff00U) >> 8U);
    bits = ((bits & 0x0f0f0f0fU) << 4U) | ((bits & 0xf0f0f0f0U) >> 4U);
    bits = ((bits & 0x33333333U) << 2U) | ((bits & 0xccccccccU) >> 2U);
    bits = ((bits & 0x55555555U) << 1U) | ((bits & 0xaaaaaaaaU) >> 1U);
    return {(i + 0.5) / n, bits * 0x1p-32 + 0.5 / n};
}

FacetSample facet_sample(const glm::dvec2& point) {
    const double angle = 2.0 * std::numbers::pi * point.y;
    return {point.x, {portable::cos(angle), portable::sin(angle)}};
}

glm::dvec3 ggx_facet(const FacetSample& sample, double alpha) {
    // tan^2 of the angle to the normal within which this share of facets lies.
    const double tan_squared = alpha * alpha * sample.share / (1.0 - sample.share);
    const double cosine = 1.0 / std::sqrt(1.0 + tan_squared);
    const double sine = std::sqrt(tan_squared) * cosine;
    return {sine * sample.azimuth.x, sine * sample.azimuth.y, cosine};
}

// Directional albedo

namespace {

/// The grid on the half disk of visible facets: points along a radius and points along an arc.
constexpr int radial_points = 32;
constexpr int arc_points = 6;

/// Returns Smith's Lambda, the ratio of masked to visible facets.
double masked(double cosine, double alpha) {
    const double tan_squared = (1.0 - cosine * cosine) / (cosine * cosine);
    return 0.5 * (std::sqrt(1.0 + alpha * alpha * tan_squared) - 1.0);
}

/// A point of the half disk of visible facets; the other half is its mirror image.
struct DiscPoint {
    double across;     ///< Along the axis that is perpendicular to the view and the
                       ///< normal.
    double along;      ///< Along the other axis of the disk.
    double half_edge;  ///< Half the width of the disk at `across`.
    double weight;     ///< The share of the disk that the point represents.
};

const std::array<DiscPoint, radial_points * arc_points>& disc_points() {
    static const auto points = [] {
        std::array<DiscPoint, radial_points * arc_points> all{};
        for (int i = 0; i < radial_points; ++i) {
            // Near the rim, facets change with the square root of the distance to it, so the steps
            // are even in the root.
            const double root = (i + 0.5) / radial_points;
            const double radius = std::sqrt(1.0 - root * root);
            for (int j = 0; j < arc_points; ++j) {
                const double angle = std::numbers::pi * ((j + 0.5) / arc_points - 0.5);
                const double across = radius * portable::cos(angle);
                all.at(static_cast<std::size_t>(i * arc_points + j)) = {
                    across, radius * portable::sin(angle), std::sqrt(1.0 - across * across),
                    2.0 * root / (radial_points * arc_points)};
            }
        }
        return all;
    }();
    return points;
}

/// Facet normals that are visible from a direction in the xz plane.
class VisibleFacets {
  public:
    VisibleFacets(const glm::dvec3& view, double alpha)
        : alpha_(alpha),
          // The surface stretched so that its facets become a hemisphere.
          stretched_(glm::normalize(glm::dvec3(alpha * view.x, 0.0, view.z))),
          visible_(0.5 * (1.0 + stretched_.z)) {}

    [[nodiscard]] glm::dvec3 at(const DiscPoint& point) const {
        const double along = (1.0 - visible_) * point.half_edge + visible_ * point.along;
        const double towards =
            std::sqrt(std::max(0.0, point.half_edge * point.half_edge - along * along));
        const glm::dvec3 facet(towards * stretched_.x - along * stretched_.z, point.across,
                               towards * stretched_.z + along * stretched_.x);
        return glm::normalize(
            glm::dvec3(alpha_ * facet.x, alpha_ * facet.y, std::max(0.0, facet.z)));
    }

  private:
    double alpha_;
    glm::dvec3 stretched_;
    double visible_;  ///< The share of the disk above the horizon, at its center.
};

double power_5(double x) {
    return x * x * x * x * x;
}

}  // namespace

glm::dvec2 environment_brdf(double n_v, double roughness) {
    const glm::dvec3 view(std::sqrt(1.0 - n_v * n_v), 0.0, n_v);
    const double alpha = roughness * roughness;
    const double masked_view = masked(n_v, alpha);
    const VisibleFacets facets(view, alpha);
    glm::dvec2 sum(0.0);
    for (const DiscPoint& point : disc_points()) {
        const glm::dvec3 half = facets.at(point);
        const double v_h = glm::dot(view, half);
        const double n_l = 2.0 * v_h * half.z - view.z;
        if (n_l <= 0.0) continue;
        const double lit_share =
            (1.0 + masked_view) / (1.0 + masked_view + masked(std::min(n_l, 1.0), alpha));
        const double fresnel = power_5(1.0 - std::min(v_h, 1.0));
        sum += point.weight * lit_share * glm::dvec2(1.0 - fresnel, fresnel);
    }
    return sum;
}

Image environment_brdf_table(int size) {
    if (size < 2)
        throw InvalidInput(fmt::format("a table of {} values per side was requested", size));
    // At n.v = 0 the albedo is undefined; this angle gives its limit.
    constexpr double grazing = 1e-6;
    const auto count = static_cast<std::size_t>(size);
    Image table = make_image(size, size, 2, 32, ColorSpace::data);
    const auto samples = table.as<float>();
    parallel_for(count, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t y = begin; y < end; ++y) {
            for (std::size_t x = 0; x < count; ++x) {
                const double root = static_cast<double>(x) / (size - 1);
                const double roughness = static_cast<double>(y) / (size - 1);
                const glm::dvec2 albedo =
                    environment_brdf(std::max(root * root, grazing), roughness);
                samples[2 * (y * count + x)] = static_cast<float>(albedo.x);
                samples[2 * (y * count + x) + 1] = static_cast<float>(albedo.y);
            }
        }
    });
    return table;
}

// Sheen

double sheen_alpha(double roughness) {
    constexpr double min_roughness = 0.045;
    const double used = std::max(roughness, min_roughness);
    return used * used;
}

double sheen_distribution(double n_h, double alpha) {
    const double sine_squared = (1.0 - n_h) * (1.0 + n_h);
    return (2.0 + 1.0 / alpha) * portable::pow(sine_squared, 0.5 / alpha) /
           (2.0 * std::numbers::pi);
}

namespace {

/// Returns L, the logarithm of Lambda for cosines below 1/2: [Estevez and Kulla 2017], table 1.
double log_lambda(double cosine, double alpha) {
    const double smooth = (1.0 - alpha) * (1.0 - alpha);
    const double a = glm::mix(21.5473, 25.3245, smooth);
    const double b = glm::mix(3.82987, 3.32435, smooth);
    const double c = glm::mix(0.19823, 0.16801, smooth);
    const double d = glm::mix(-1.97760, -1.27393, smooth);
    const double e = glm::mix(-4.32054, -4.85967, smooth);
    return a / (1.0 + b * portable::pow(cosine, c)) + d * cosine + e;
}

double sheen_lambda(double cosine, double alpha) {
    if (cosine < 0.5) return portable::exp(log_lambda(cosine, alpha));
    return portable::exp(2.0 * log_lambda(0.5, alpha) - log_lambda(1.0 - cosine, alpha));
}

}  // namespace

double sheen_visibility(double n_l, double n_v, double alpha) {
    const double seen = std::max(n_v, 1e-4);
    return 1.0 / (4.0 * seen * (1.0 + sheen_lambda(seen, alpha) + sheen_lambda(n_l, alpha)));
}

namespace {

/// Returns the integrals, which are not limited to 1.
SheenAlbedo sheen_integrals(double roughness) {
    // Midpoints over the light's angle phi and the root of n.l, since Lambda changes fastest at
    // grazing angles.
    constexpr int steps = 32;
    const double alpha = sheen_alpha(roughness);
    std::array<glm::dvec2, steps> azimuths{};  // Cosine and sine of phi.
    for (std::size_t k = 0; k < azimuths.size(); ++k) {
        const double phi = std::numbers::pi * (static_cast<double>(k) + 0.5) / steps;
        azimuths[k] = {portable::cos(phi), portable::sin(phi)};
    }
    SheenAlbedo table{};
    for (std::size_t i = 0; i < table.size(); ++i) {
        const double root = static_cast<double>(i) / static_cast<double>(table.size() - 1);
        const double n_v = std::max(root * root, 1e-4);
        const double across_v = std::sqrt((1.0 - n_v) * (1.0 + n_v));
        double sum = 0.0;
        for (int j = 0; j < steps; ++j) {
            const double root_l = (j + 0.5) / steps;
            const double n_l = root_l * root_l;
            const double across_l = std::sqrt((1.0 - n_l) * (1.0 + n_l));
            double distribution = 0.0;
            for (const glm::dvec2& azimuth : azimuths) {
                const glm::dvec3 half(across_v + across_l * azimuth.x, across_l * azimuth.y,
                                      n_v + n_l);
                distribution += sheen_distribution(half.z / glm::length(half), alpha);
            }
            // d n.l = 2 root d root, and both halves of the circle are alike.
            sum += distribution * sheen_visibility(n_l, n_v, alpha) * root_l;
        }
        table[i] = sum * 4.0 * std::numbers::pi / (steps * steps);
    }
    return table;
}

}  // namespace

SheenAlbedo sheen_albedo_table(double roughness) {
    SheenAlbedo table = sheen_integrals(roughness);
    for (double& albedo : table)
        albedo = std::min(albedo, 1.0);
    return table;
}

double sheen_albedo(const SheenAlbedo& table, double n_v) {
    const double place =
        std::sqrt(std::clamp(n_v, 0.0, 1.0)) * static_cast<double>(table.size() - 1);
    const std::size_t first = std::min(static_cast<std::size_t>(place), table.size() - 2);
    return glm::mix(table[first], table[first + 1], place - static_cast<double>(first));
}

SheenAlbedos sheen_albedo_tables(double roughness) {
    SheenAlbedos tables{};
    tables.back() = sheen_albedo_table(roughness);
    parallel_for(tables.size() - 1, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t j = begin; j < end; ++j) {
            const double root = static_cast<double>(j) / static_cast<double>(tables.size() - 1);
            tables[j] = sheen_integrals(roughness * root * root);
        }
    });
    return tables;
}

double sheen_albedo(const SheenAlbedos& tables, double n_v, double texel) {
    const double place =
        std::sqrt(std::clamp(texel, 0.0, 1.0)) * static_cast<double>(tables.size() - 1);
    const std::size_t first = std::min(static_cast<std::size_t>(place), tables.size() - 2);
    const double share = place - static_cast<double>(first);
    SheenAlbedo between{};
    for (std::size_t i = 0; i < between.size(); ++i)
        between[i] = std::min(glm::mix(tables[first][i], tables[first + 1][i], share), 1.0);
    return sheen_albedo(between, n_v);
}

// Blurred radiance

namespace {

using Node = RadianceTree::Node;

/// A node replaces its texels if it is narrower than this share of the distance over which the
/// weight changes. The share is smaller for rougher surfaces, whose few directions cost little, and
/// whose weight also ends at the horizon.
float opening(double roughness) {
    return static_cast<float>(0.36 - 0.3 * roughness);
}

/// Directions along a side of a tile.
constexpr int tile_side = 8;
constexpr std::size_t tile_size = tile_side * tile_side;

/// Directions of a tile and sums over the nodes, as arrays by component for vector instructions.
struct Tile {
    std::array<float, tile_size> x{};
    std::array<float, tile_size> y{};
    std::array<float, tile_size> z{};
    std::array<float, tile_size> red{};
    std::array<float, tile_size> green{};
    std::array<float, tile_size> blue{};
    std::array<float, tile_size> weight{};
    glm::vec3 center{0.0F};
    float radius = 0.0F;  ///< The largest chord from the center to a direction.
};

/// Returns the texels of a face from `corner` on. Beyond the border the last texel repeats.
Tile tile_of(std::size_t face, const glm::ivec2& corner, int size) {
    Tile tile;
    const auto direction = [&](double x, double y) {
        return glm::vec3(glm::normalize(
            face_direction(face, 2.0 * (x + 0.5) / size - 1.0, 2.0 * (y + 0.5) / size - 1.0)));
    };
    const glm::ivec2 end = glm::min(corner + tile_side, glm::ivec2(size)) - 1;
    tile.center = direction(0.5 * (corner.x + end.x), 0.5 * (corner.y + end.y));
    for (int i = 0; i < tile_side * tile_side; ++i) {
        const glm::ivec2 texel = glm::min(corner + glm::ivec2(i % tile_side, i / tile_side), end);
        const glm::vec3 d = direction(texel.x, texel.y);
        const auto lane = static_cast<std::size_t>(i);
        tile.x.at(lane) = d.x;
        tile.y.at(lane) = d.y;
        tile.z.at(lane) = d.z;
        tile.radius = std::max(tile.radius, glm::distance(d, tile.center));
    }
    return tile;
}

/// Selects the nodes that represent all texels, each as wide as the weight allows.
class NodeSelection {
  public:
    NodeSelection(const RadianceTree& tree, float alpha, float opening)
        : tree_(tree), alpha_(alpha), opening_(opening) {}

    const std::vector<Node>& nodes_for(const Tile& tile) {
        selected_.clear();
        for (std::size_t face = 0; face < 6; ++face)
            descend(tile, 0, face, 0, 0);
        return selected_;
    }

  private:
    void descend(const Tile& tile, std::size_t level, std::size_t face, std::size_t x,
                 std::size_t y) {
        const Node& node = tree_.node(level, face, x, y);
        const float width = std::sqrt(node.solid_angle);
        // The node is below the horizon of every direction in the tile.
        if (glm::dot(node.direction, tile.center) < -(tile.radius + width)) return;
        const float distance =
            std::max(glm::distance(node.direction, tile.center) - tile.radius, 0.0F);
        const float scale = std::sqrt(distance * distance + 4.0F * alpha_ * alpha_);
        if (width <= opening_ * scale || level + 1 == tree_.level_count()) {
            selected_.push_back(node);
            return;
        }
        for (const std::size_t part : {0U, 1U, 2U, 3U})
            descend(tile, level + 1, face, 2 * x + part % 2, 2 * y + part / 2);
    }

    const RadianceTree& tree_;
    float alpha_;
    float opening_;
    std::vector<Node> selected_;
};

/// Adds a node with the weight D n.l for every direction of the tile, without the factors that all
/// weights share. The light is weighted by its average direction, so that a small sun stays in its
/// place; the sum of weights uses the node's center, so that even light stays even. D is that of
/// ggx_distribution(), with n.h^2 = (1 + n.l) / 2, since the normal is the eye.
///
/// \param node  a copy, so that the compiler knows that the sums do not alias it
void add(const Node node, float alpha, Tile& tile) {
    const float half_rest = 0.5F * (alpha * alpha - 1.0F);
    const float half_all = 0.5F * (alpha * alpha + 1.0F);
    const auto weight_of = [&](float cosine) {
        const float spread = half_all + half_rest * cosine;
        return (cosine > 0.0F ? cosine : 0.0F) * node.solid_angle / (spread * spread);
    };
    for (std::size_t i = 0; i < tile_size; ++i) {
        const float light =
            weight_of(tile.x[i] * node.light_direction.x + tile.y[i] * node.light_direction.y +
                      tile.z[i] * node.light_direction.z);
        tile.red[i] += light * node.radiance.x;
        tile.green[i] += light * node.radiance.y;
        tile.blue[i] += light * node.radiance.z;
        tile.weight[i] += weight_of(tile.x[i] * node.direction.x + tile.y[i] * node.direction.y +
                                    tile.z[i] * node.direction.z);
    }
}

void store(const Tile& tile, const glm::ivec2& corner, Image& face) {
    const auto samples = face.as<float>();
    for (int y = 0; y < tile_side && corner.y + y < face.height; ++y) {
        for (int x = 0; x < tile_side && corner.x + x < face.width; ++x) {
            const auto lane = static_cast<std::size_t>(y * tile_side + x);
            float* texel = &samples[static_cast<std::size_t>(
                3 * ((corner.y + y) * face.width + corner.x + x))];
            texel[0] = tile.red.at(lane) / tile.weight.at(lane);
            texel[1] = tile.green.at(lane) / tile.weight.at(lane);
            texel[2] = tile.blue.at(lane) / tile.weight.at(lane);
        }
    }
}

void check_tree_faces(std::span<const Image> faces) {
    check_faces(faces, "blurred");
    const auto size = static_cast<unsigned>(faces[0].width);
    if (!std::has_single_bit(size) || faces[0].bits() != 32 || faces[0].channels != 3) {
        throw InvalidInput(
            fmt::format("faces of {} texels, {} channels and {} "
                        "bits cannot be blurred: it takes a "
                        "power of two, three and 32",
                        size, faces[0].channels, faces[0].bits()));
    }
}

/// Returns all nodes of a level; set(node, face, x, y) sets their light.
template <typename Set>
std::vector<Node> level_of(std::size_t level, Set set) {
    const std::size_t parts = std::size_t{1} << level;
    const double side = 2.0 / static_cast<double>(parts);
    std::vector<Node> nodes(6 * parts * parts);
    parallel_for(parts, 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t y = begin; y < end; ++y) {
            for (std::size_t x = 0; x < parts; ++x) {
                const glm::dvec2 from(static_cast<double>(x) * side - 1.0,
                                      static_cast<double>(y) * side - 1.0);
                const auto area = static_cast<float>(solid_angle(from, from + side));
                const glm::dvec2 center = from + 0.5 * side;
                for (std::size_t face = 0; face < 6; ++face) {
                    Node& node = nodes[(face * parts + y) * parts + x];
                    node.direction =
                        glm::vec3(glm::normalize(face_direction(face, center.x, center.y)));
                    node.solid_angle = area;
                    set(node, face, x, y);
                }
            }
        }
    });
    return nodes;
}

}  // namespace

RadianceTree::RadianceTree(std::span<const Image> faces) {
    check_tree_faces(faces);
    const auto size = static_cast<std::size_t>(faces[0].width);
    const auto deepest = static_cast<std::size_t>(std::countr_zero(size));
    levels_.resize(deepest + 1);
    levels_[deepest] =
        level_of(deepest, [&](Node& node, std::size_t face, std::size_t x, std::size_t y) {
            const float* sample = faces[face].as<float>().data() + 3 * (y * size + x);
            node.radiance = {sample[0], sample[1], sample[2]};
            node.light_direction = node.direction;
        });
    for (std::size_t level = deepest; level-- > 0;) {
        levels_[level] =
            level_of(level, [&](Node& mean, std::size_t face, std::size_t x, std::size_t y) {
                // The centers of the area and of the light coincide for even light.
                glm::vec3 center(0.0F);
                glm::vec3 light_center(0.0F);
                for (const std::size_t part : {0U, 1U, 2U, 3U}) {
                    const Node& child = node(level + 1, face, 2 * x + part % 2, 2 * y + part / 2);
                    const float light = child.radiance.x + child.radiance.y + child.radiance.z;
                    mean.radiance += child.solid_angle / mean.solid_angle * child.radiance;
                    center += child.solid_angle * child.direction;
                    light_center +=
                        std::max(light, 0.0F) * child.solid_angle * child.light_direction;
                }
                const float length = glm::length(light_center);
                mean.direction = glm::normalize(center);
                mean.light_direction = length > 0.0F ? light_center / length : mean.direction;
            });
    }
}

std::vector<Image> blurred_faces(const RadianceTree& tree, int size, double roughness) {
    const auto alpha = static_cast<float>(roughness * roughness);
    std::vector<Image> faces(6, make_image(size, size, 3, 32, ColorSpace::linear));
    const auto tiles = static_cast<std::size_t>((size + tile_side - 1) / tile_side);
    parallel_for(6 * tiles * tiles, 1, [&](std::size_t begin, std::size_t end) {
        NodeSelection selection(tree, alpha, opening(roughness));
        for (std::size_t i = begin; i < end; ++i) {
            const std::size_t face = i / (tiles * tiles);
            const glm::ivec2 corner(static_cast<int>(i % tiles) * tile_side,
                                    static_cast<int>(i / tiles % tiles) * tile_side);
            Tile tile = tile_of(face, corner, size);
            for (const Node& node : selection.nodes_for(tile))
                add(node, alpha, tile);
            store(tile, corner, faces[face]);
        }
    });
    return faces;
}

namespace {

/// Calls visit(face, x, y, direction, solid angle) for every cell of a cube with size x size cells
/// per face. Directions are unit, towards the centers of the cells.
template <typename Visit>
void for_each_cell(int size, const Visit& visit) {
    const double side = 2.0 / size;
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const glm::dvec2 from(x * side - 1.0, y * side - 1.0);
            const double area = solid_angle(from, from + side);
            const glm::dvec2 center = from + 0.5 * side;
            for (std::size_t face = 0; face < 6; ++face)
                visit(face, x, y, glm::normalize(face_direction(face, center.x, center.y)), area);
        }
    }
}

glm::dvec3 radiance(const Image& face, int x, int y) {
    const auto texel = static_cast<std::size_t>(y) * static_cast<std::size_t>(face.width) +
                       static_cast<std::size_t>(x);
    const float* sample = face.as<float>().data() + texel * static_cast<std::size_t>(face.channels);
    return {sample[0], sample[1], sample[2]};
}

}  // namespace

glm::dvec3 blurred_radiance(std::span<const Image> faces, const glm::dvec3& direction,
                            double roughness) {
    const glm::dvec3 normal = glm::normalize(direction);
    glm::dvec3 sum(0.0);
    double weights = 0.0;
    for_each_cell(
        faces[0].width, [&](std::size_t face, int x, int y, const glm::dvec3& light, double area) {
            const double n_l = glm::dot(normal, light);
            if (n_l <= 0.0) return;
            const double n_h = std::min(std::sqrt(0.5 * (1.0 + n_l)), 1.0);
            const double weight = area * n_l * ggx_distribution(n_h, roughness * roughness);
            sum += weight * radiance(faces[face], x, y);
            weights += weight;
        });
    return sum / weights;
}

// Irradiance

namespace {

using std::numbers::pi;

/// The minimum number of cells along a side. Larger texels are divided, so that the harmonics
/// hardly change within a cell.
constexpr int min_cells = 64;

/// Returns the polynomials of the harmonics, in the order of IrradianceSh.
std::array<double, 9> polynomials(const glm::dvec3& n) {
    return {1.0,
            n.y,
            n.z,
            n.x,
            n.x * n.y,
            n.y * n.z,
            3.0 * n.z * n.z - 1.0,
            n.x * n.z,
            n.x * n.x - n.y * n.y};
}

/// A_l / pi times the square of the normalization constant of the harmonic.
constexpr std::array<double, 9> factors{1.0 / (4 * pi),
                                        2.0 / 3.0 * 3.0 / (4 * pi),
                                        2.0 / 3.0 * 3.0 / (4 * pi),
                                        2.0 / 3.0 * 3.0 / (4 * pi),
                                        1.0 / 4.0 * 15.0 / (4 * pi),
                                        1.0 / 4.0 * 15.0 / (4 * pi),
                                        1.0 / 4.0 * 5.0 / (16 * pi),
                                        1.0 / 4.0 * 15.0 / (4 * pi),
                                        1.0 / 4.0 * 15.0 / (16 * pi)};

void check(std::span<const Image> faces) {
    check_faces(faces, "irradiance");
    if (faces[0].bits() != 32 || faces[0].channels < 3)
        throw InvalidInput("irradiance is computed from three float channels of linear light");
    for (std::size_t face = 0; face < 6; ++face) {
        const auto samples = faces[face].as<float>();
        for (std::size_t i = 0; i < samples.size(); ++i) {
            if (std::isfinite(samples[i])) continue;
            const std::size_t texel = i / static_cast<std::size_t>(faces[0].channels);
            const auto side = static_cast<std::size_t>(faces[0].width);
            throw InvalidInput(fmt::format(
                "irradiance: face {} holds {} in column {}, row {}, which is not finite",
                cube_face_names.at(face), samples[i], texel % side, texel / side));
        }
    }
}

}  // namespace

IrradianceSh irradiance_sh(std::span<const Image> faces) {
    check(faces);
    const int size = faces[0].width;
    const int parts = (min_cells + size - 1) / size;
    std::array<glm::dvec3, 9> sums{};
    for_each_cell(size * parts,
                  [&](std::size_t face, int x, int y, const glm::dvec3& normal, double weight) {
                      const glm::dvec3 light = weight * radiance(faces[face], x / parts, y / parts);
                      const std::array<double, 9> values = polynomials(normal);
                      for (std::size_t i = 0; i < values.size(); ++i)
                          sums.at(i) += light * values.at(i);
                  });
    IrradianceSh coefficients{};
    for (std::size_t i = 0; i < sums.size(); ++i)
        coefficients.at(i) = glm::vec3(sums.at(i) * factors.at(i));
    return coefficients;
}

glm::dvec3 irradiance_over_pi(const IrradianceSh& coefficients, const glm::dvec3& normal) {
    const std::array<double, 9> values = polynomials(normal);
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i < values.size(); ++i)
        sum += glm::dvec3(coefficients.at(i)) * values.at(i);
    return sum;
}

// With c and s for the cosine and the sine, a normal (x, y, z) has the irradiance that
// (c x - s z, y, s x + c z) had before. The polynomials of that are sums of the polynomials of the
// same degree, because x^2 + y^2 + z^2 = 1.
IrradianceSh rotated(const IrradianceSh& coefficients, double radians) {
    const double c = portable::cos(radians), s = portable::sin(radians);
    std::array<glm::dvec3, 9> a{};
    std::copy(coefficients.begin(), coefficients.end(), a.begin());
    const std::array<glm::dvec3, 9> result = {
        a[0],
        a[1],
        c * a[2] - s * a[3],
        s * a[2] + c * a[3],
        c * a[4] + s * a[5],
        c * a[5] - s * a[4],
        (c * c - 0.5 * s * s) * a[6] - 0.5 * c * s * a[7] + 0.5 * s * s * a[8],
        6.0 * c * s * a[6] + (c * c - s * s) * a[7] - 2.0 * c * s * a[8],
        1.5 * s * s * a[6] + 0.5 * c * s * a[7] + 0.5 * (c * c + 1.0) * a[8],
    };
    IrradianceSh turned{};
    std::copy(result.begin(), result.end(), turned.begin());
    return turned;
}

}  // namespace relief::shade::detail
