// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "hard_cases/baked_map.h"
#include "hard_cases/map_cases.h"
#include "relief/mesh/error.h"
#include "relief/mesh/shapes.h"

namespace relief::test {
namespace {

HardCase self_case() {
    return {
        "mesh baked onto itself",
        "A cube, a sphere and a torus as high and low mesh: every ray hits where it is, many on "
        "edges and vertices.",
        "rays that miss what they start on; bakers with a bias",
        {{"bake", "flat within 0.001 degrees, no texel missed, height 0", [] {
              for (const Mesh& mesh : {make_cube(), make_sphere(), make_torus()}) {
                  const std::string problem = not_all(baked({mesh}, mesh), flat_normal, 0.0);
                  if (!problem.empty()) return problem;
              }
              return std::string();
          }}}};
}

HardCase edges_case() {
    return {"rays on edges and vertices",
            "A square of 8 x 8 cells under a map whose texel centres lie on its diagonals.",
            "Embree#174, #181; tinybvh#168",
            {{"bake", "one hit each, the same whatever the order of triangles", [] {
                  Mesh high = moved(make_quad(8), {0, 0, 0.125F});
                  const HardBake map = baked({high}, make_quad());
                  std::reverse(high.triangles.begin(), high.triangles.end());
                  const std::string problem = not_all(map, flat_normal, 0.125);
                  if (!problem.empty()) return problem;
                  return std::string(baked({high}, make_quad()).normals == map.normals
                                         ? ""
                                         : "another order bakes another map");
              }}}};
}

/// One triangle askew, whose edges run across texels.
HardCase border_case() {
    return {
        "rays on open borders",
        "A triangle that nothing joins onto itself: texels that only touch it have their place "
        "exactly on its edges.",
        "rays that slip past by the rounding of floats; dark rims",
        {{"bake", "flat, height 0, no texel missed", [] {
              Mesh low;
              low.positions = {{0.31F, 0.12F, 2.03F}, {1.37F, 0.45F, 2.71F}, {0.58F, 1.19F, 1.6F}};
              low.texcoords = {{0.02F, 0.11F}, {0.97F, 0.29F}, {0.23F, 0.94F}};
              low.triangles = {{0, 1, 2}};
              const HardBake map = baked({low}, low);
              if (map.result.coverage.touched < bake_side)
                  return std::string("few texels touch it");
              for (std::size_t i = 0; i < bake_texels; ++i) {
                  if (!(map.degrees(i, flat_normal) < 0.001))
                      return fmt::format("texel {} is off", i);
              }
              if (map.result.texels_missed > 0)
                  return fmt::format("{} missed", map.result.texels_missed);
              const bool is_flat =
                  map.result.greatest_height < 1e-6 && map.result.least_height > -1e-6;
              return std::string(is_flat ? "" : "the heights are not 0");
          }}}};
}

HardCase needle_case() {
    return {"needles seen edge-on",
            "A square, and above it upright triangles 1e-7 wide, between the rays.",
            "Embree#387",
            {{"bake", "the square alone is hit", [] {
                  Mesh needles;
                  for (int i = 0; i < bake_side; ++i) {
                      const float x = static_cast<float>(i) / 8.0F - 1.0F;
                      needles.positions.insert(needles.positions.end(),
                                               {{x, -1, 0}, {x, 1, 0}, {x + 1e-7F, 1, 0.005F}});
                      const auto first = static_cast<std::uint32_t>(3 * i);
                      needles.triangles.emplace_back(first, first + 1, first + 2);
                  }
                  return not_all(baked({make_quad(), needles}, make_quad()), flat_normal, 0.0);
              }}}};
}

HardCase missed_case() {
    return {"rays that meet nothing",
            "The high mesh is over the left half of the low one alone.",
            "bakers that leave black texels",
            {{"bake", "flat; reported: 128 x texel missed by its rays",
              [] {
                  Mesh half = make_quad();
                  for (glm::vec3& position : half.positions)
                      position.x = (position.x - 1.0F) / 2.0F;
                  const HardBake map = baked({half}, make_quad());
                  return map.report.count("texel missed by its rays") == bake_texels / 2 &&
                                 map.degrees(bake_side - 1, flat_normal) == 0.0
                             ? ""
                             : std::string("not so");
              }},
             {"padding", "filled from the nearest baked texel", [] {
                  Mesh half = make_quad();
                  half.normals.assign(4, glm::normalize(glm::vec3(0.6F, 0, 0.8F)));
                  for (glm::vec3& position : half.positions)
                      position.x = (position.x - 1.0F) / 2.0F;
                  const HardBake map = baked({half}, make_quad(), bake_side);
                  for (std::size_t i = 0; i < bake_texels; ++i) {
                      if (!(map.degrees(i, {0.6, 0, 0.8}) < 0.001))
                          return fmt::format("texel {} is not", i);
                  }
                  return std::string();
              }}}};
}

HardCase wall_case() {
    return {"far side of a thin wall",
            "A square, and 0.3 above it a wall 0.01 thick, whose far side faces the same way.",
            "wrong sheets in tight folds",
            {{"bake", "the square; of two open sheets, the outer one", [] {
                  const Mesh own = moved(make_quad(), {0, 0, 0.05F});
                  Mesh near = moved(make_quad(), {0, 0, 0.3F});
                  for (glm::uvec3& triangle : near.triangles)
                      std::swap(triangle.y, triangle.z);
                  const Mesh far = moved(make_quad(), {0, 0, 0.31F});
                  const std::string problem =
                      not_all(baked({own, near, far}, make_quad()), flat_normal, 0.05);
                  return problem.empty()
                             ? not_all(baked({own, far}, make_quad()), flat_normal, 0.31)
                             : problem;
              }}}};
}

HardCase scale_case() {
    return {"bakes of size 1e-18 and 1e18",
            "A torus onto itself, all its positions multiplied.",
            "Embree's floats, whose squares overflow",
            {{"bake", "flat within 0.001 degrees, no texel missed", [] {
                  for (const float size : {1e-18F, 1e18F}) {
                      Mesh mesh = make_torus();
                      for (glm::vec3& position : mesh.positions)
                          position *= size;
                      HardBake map = baked({mesh}, mesh);
                      std::fill(map.heights.begin(), map.heights.end(), 0.0F);
                      const std::string problem = not_all(map, flat_normal, 0.0);
                      if (!problem.empty()) return problem;
                  }
                  return std::string();
              }}}};
}

HardCase broken_case() {
    return {"broken high meshes",
            "Nothing; triangles without area; vertices that are not finite, beside a sound square.",
            "crashes of ray casters",
            {{"bake", "of nothing all missed; else the square", [] {
                  if (baked({Mesh{}}, make_quad()).result.texels_missed != bake_texels)
                      return std::string("hit nothing");
                  Mesh high = make_quad();
                  const float nan = std::numeric_limits<float>::quiet_NaN();
                  high.positions.insert(
                      high.positions.end(),
                      {{nan, 0, 0}, {0, std::numeric_limits<float>::infinity(), 0}});
                  high.normals.insert(high.normals.end(), 2, {0, 0, 1});
                  high.texcoords.clear();
                  high.triangles.insert(high.triangles.end(), {{0, 1, 4}, {1, 2, 5}, {0, 0, 1}});
                  return not_all(baked({high}, make_quad()), flat_normal, 0.0);
              }}}};
}

HardCase bare_case() {
    return {"bake without texture coordinates",
            "The low mesh has none.",
            "bakers that write an empty map",
            {{"bake", "refused: the low mesh has no texture coordinates", [] {
                  Mesh bare = make_quad();
                  bare.texcoords.clear();
                  try {
                      baked({make_quad()}, bare);
                  } catch (const InvalidInput& error) {
                      return std::string(error.what() == std::string("the low mesh has no texture "
                                                                     "coordinates")
                                             ? ""
                                             : error.what());
                  }
                  return std::string("taken");
              }}}};
}

}  // namespace

std::vector<HardCase> bake_cases() {
    return {self_case(), edges_case(), border_case(), needle_case(), missed_case(),
            wall_case(), scale_case(), broken_case(), bare_case()};
}

}  // namespace relief::test
