// SPDX-License-Identifier: Apache-2.0
// GGX-blurred surroundings by a walk down a tree of texels; see blur.h. Directions in the same tile
// of the result share one walk, and then go through the nodes it found side by side, in float, in
// a fixed order. Tests: tests/shade/environment/blur_test.cpp.
#include "environment/blur.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "environment/cube_faces.h"
#include "environment/ggx.h"
#include "parallel.h"
#include "relief/mesh/error.h"

namespace relief {

namespace {

using Node = RadianceTree::Node;

/// A node stands for its texels where it is narrower than this share of the distance over which the
/// weight changes. Smaller for rougher surfaces, whose few directions cost little, and whose weight
/// also ends at the horizon.
float opening(double roughness) {
    return static_cast<float>(0.36 - 0.3 * roughness);
}

/// Directions along a side of a tile.
constexpr int tile_side = 8;
constexpr std::size_t tile_size = tile_side * tile_side;

/// Directions of a tile and sums over the nodes, in columns so that the compiler makes them wide.
struct Tile {
    std::array<float, tile_size> x{};
    std::array<float, tile_size> y{};
    std::array<float, tile_size> z{};
    std::array<float, tile_size> red{};
    std::array<float, tile_size> green{};
    std::array<float, tile_size> blue{};
    std::array<float, tile_size> weight{};
    glm::vec3 middle{0.0F};
    float radius = 0.0F;  ///< Farthest direction from the middle, as a chord.
};

/// The texels of a face from `corner` on, as far as there are any; the rest repeats the last.
Tile tile_of(std::size_t face, const glm::ivec2& corner, int size) {
    Tile tile;
    const auto direction = [&](double x, double y) {
        return glm::vec3(glm::normalize(
            face_direction(face, 2.0 * (x + 0.5) / size - 1.0, 2.0 * (y + 0.5) / size - 1.0)));
    };
    const glm::ivec2 end = glm::min(corner + tile_side, glm::ivec2(size)) - 1;
    tile.middle = direction(0.5 * (corner.x + end.x), 0.5 * (corner.y + end.y));
    for (int i = 0; i < tile_side * tile_side; ++i) {
        const glm::ivec2 texel = glm::min(corner + glm::ivec2(i % tile_side, i / tile_side), end);
        const glm::vec3 d = direction(texel.x, texel.y);
        const auto lane = static_cast<std::size_t>(i);
        tile.x.at(lane) = d.x;
        tile.y.at(lane) = d.y;
        tile.z.at(lane) = d.z;
        tile.radius = std::max(tile.radius, glm::distance(d, tile.middle));
    }
    return tile;
}

/// Finds the nodes that stand for all texels, each no wider than the weight allows.
class Walk {
  public:
    Walk(const RadianceTree& tree, float alpha, float opening)
        : tree_(tree), alpha_(alpha), opening_(opening) {}

    const std::vector<Node>& nodes_for(const Tile& tile) {
        found_.clear();
        for (std::size_t face = 0; face < 6; ++face)
            descend(tile, 0, face, 0, 0);
        return found_;
    }

  private:
    void descend(const Tile& tile, std::size_t level, std::size_t face, std::size_t x,
                 std::size_t y) {
        const Node& node = tree_.node(level, face, x, y);
        const float width = std::sqrt(node.solid_angle);
        // Wholly below the horizon of every direction in the tile.
        if (glm::dot(node.direction, tile.middle) < -(tile.radius + width)) return;
        const float distance =
            std::max(glm::distance(node.direction, tile.middle) - tile.radius, 0.0F);
        const float scale = std::sqrt(distance * distance + 4.0F * alpha_ * alpha_);
        if (width <= opening_ * scale || level + 1 == tree_.level_count()) {
            found_.push_back(node);
            return;
        }
        for (const std::size_t part : {0U, 1U, 2U, 3U})
            descend(tile, level + 1, face, 2 * x + part % 2, 2 * y + part / 2);
    }

    const RadianceTree& tree_;
    float alpha_;
    float opening_;
    std::vector<Node> found_;
};

/// D n.l for every direction of the tile, without the factors that all weights share: for a node's
/// light from where most of it comes, so that a small sun stands in its place; for the sum of
/// weights from the node's middle, so that even light stays even. As ggx_distribution(), with n.h^2
/// = (1 + n.l) / 2, since the normal is the eye.
///
/// \param node  a copy, so that the compiler sees that the sums do not change it
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
            fmt::format("faces of {} texels, {} channels and {} bits cannot be blurred: it takes a "
                        "power of two, three and 32",
                        size, faces[0].channels, faces[0].bits()));
    }
}

/// All nodes of a level, their light as set(node, face, x, y) says.
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
                const auto covered = static_cast<float>(solid_angle(from, from + side));
                const glm::dvec2 middle = from + 0.5 * side;
                for (std::size_t face = 0; face < 6; ++face) {
                    Node& node = nodes[(face * parts + y) * parts + x];
                    node.direction =
                        glm::vec3(glm::normalize(face_direction(face, middle.x, middle.y)));
                    node.solid_angle = covered;
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
                // Middles of what is covered and of where light comes from: the same for even
                // light.
                glm::vec3 middle(0.0F);
                glm::vec3 middle_of_light(0.0F);
                for (const std::size_t part : {0U, 1U, 2U, 3U}) {
                    const Node& child = node(level + 1, face, 2 * x + part % 2, 2 * y + part / 2);
                    const float light = child.radiance.x + child.radiance.y + child.radiance.z;
                    mean.radiance += child.solid_angle / mean.solid_angle * child.radiance;
                    middle += child.solid_angle * child.direction;
                    middle_of_light +=
                        std::max(light, 0.0F) * child.solid_angle * child.light_direction;
                }
                const float length = glm::length(middle_of_light);
                mean.direction = glm::normalize(middle);
                mean.light_direction = length > 0.0F ? middle_of_light / length : mean.direction;
            });
    }
}

std::vector<Image> blurred_faces(const RadianceTree& tree, int size, double roughness) {
    const auto alpha = static_cast<float>(roughness * roughness);
    std::vector<Image> faces(6, make_image(size, size, 3, 32, ColorSpace::linear));
    const auto tiles = static_cast<std::size_t>((size + tile_side - 1) / tile_side);
    parallel_for(6 * tiles * tiles, 1, [&](std::size_t begin, std::size_t end) {
        Walk walk(tree, alpha, opening(roughness));
        for (std::size_t i = begin; i < end; ++i) {
            const std::size_t face = i / (tiles * tiles);
            const glm::ivec2 corner(static_cast<int>(i % tiles) * tile_side,
                                    static_cast<int>(i / tiles % tiles) * tile_side);
            Tile tile = tile_of(face, corner, size);
            for (const Node& node : walk.nodes_for(tile))
                add(node, alpha, tile);
            store(tile, corner, faces[face]);
        }
    });
    return faces;
}

glm::dvec3 blurred_radiance(std::span<const Image> faces, const glm::dvec3& direction,
                            double roughness) {
    const glm::dvec3 normal = glm::normalize(direction);
    const int size = faces[0].width;
    const double side = 2.0 / size;
    glm::dvec3 sum(0.0);
    double weights = 0.0;
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const glm::dvec2 from(x * side - 1.0, y * side - 1.0);
            const double covered = solid_angle(from, from + side);
            const glm::dvec2 middle = from + 0.5 * side;
            for (std::size_t face = 0; face < 6; ++face) {
                const glm::dvec3 light = glm::normalize(face_direction(face, middle.x, middle.y));
                const double n_l = glm::dot(normal, light);
                if (n_l <= 0.0) continue;
                const double n_h = std::min(std::sqrt(0.5 * (1.0 + n_l)), 1.0);
                const double weight = covered * n_l * ggx_distribution(n_h, roughness * roughness);
                const float* sample =
                    faces[face].as<float>().data() + static_cast<std::size_t>(3 * (y * size + x));
                sum += weight * glm::dvec3(sample[0], sample[1], sample[2]);
                weights += weight;
            }
        }
    }
    return sum / weights;
}

}  // namespace relief
