// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "hard_cases/baked_map.h"
#include "hard_cases/map_cases.h"
#include "relief/mesh/error.h"
#include "relief/mesh/shapes.h"

namespace relief::test {
namespace {

/// What a bake of this high mesh onto a square throws; nothing: "taken".
std::string refusal_of(const Mesh& high, BakeOptions options = {}) {
    options.width = options.height = bake_side;
    try {
        baked({high}, make_quad(), options);
    } catch (const BakeMismatch& mismatch) {
        return mismatch.kind() == BakeMismatch::Kind::apart  ? "apart"
               : mismatch.kind() == BakeMismatch::Kind::size ? "size"
                                                             : "no surface";
    }
    return "taken";
}

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
              const bool is_flat = map.result.max_height < 1e-6 && map.result.min_height > -1e-6;
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
            {{"bake", "of nothing refused; else the square", [] {
                  if (refusal_of(Mesh{}) != "no surface") return std::string("nothing is taken");
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

HardCase apart_case() {
    return {"high mesh in another place",
            "A square, moved by 5 times its size away from the low one, or beside it.",
            "bakers that write an empty map without a word",
            {{"bake", "refused: apart, unless rays are told to reach it", [] {
                  for (const glm::vec3& by : {glm::vec3(0, 0, 10), glm::vec3(10, 0, 0)}) {
                      const std::string refusal = refusal_of(moved(make_quad(), by));
                      if (refusal != "apart") return refusal;
                  }
                  BakeOptions longer;
                  longer.offset = 10.5;
                  const std::string refusal = refusal_of(moved(make_quad(), {0, 0, 10}), longer);
                  return refusal == "taken" ? std::string() : refusal;
              }}}};
}

HardCase unit_case() {
    return {"high mesh in another unit",
            "A square 100 times, and a hundredth, as large as the low one.",
            "bakers that write a map of something else",
            {{"bake", "refused: size, unless that is allowed", [] {
                  for (const float scale : {100.0F, 0.01F}) {
                      Mesh high = make_quad();
                      for (glm::vec3& position : high.positions)
                          position *= scale;
                      const std::string refusal = refusal_of(high);
                      if (refusal != "size") return refusal;
                      BakeOptions allowed;
                      allowed.allow_size_mismatch = true;
                      if (refusal_of(high, allowed) != "taken") return std::string("not allowed");
                  }
                  return std::string();
              }}}};
}

HardCase short_rays_case() {
    return {"rays too short for the high mesh",
            "A square 0.5 above the low one, a triangle down to the low one's height beside it, "
            "and rays that begin 0.25 outside.",
            "holes without a reason",
            {{"bake", "all missed, and 0.5 measured as the length that hits", [] {
                  Mesh high = moved(make_quad(), {0, 0, 0.5F});
                  high.positions.insert(high.positions.end(), {{2, 0, 0}, {2, 1, 0}, {2, 0, 0.5F}});
                  high.triangles.emplace_back(4, 5, 6);
                  high.normals.clear();
                  high.texcoords.clear();
                  high.tangents.clear();
                  BakeOptions options;
                  options.width = options.height = bake_side;
                  options.max_distance = 1.5;
                  options.offset = 0.25;
                  options.measures_missed = true;
                  const HardBake map = baked({high}, make_quad(), options);
                  const ClippedRays& clipped = map.result.clipped_outside;
                  if (clipped.texels != bake_texels || std::abs(clipped.longest - 0.5) > 1e-6)
                      return fmt::format("{} texels, {}", clipped.texels, clipped.longest);
                  options.offset = 1.001 * clipped.longest;
                  const auto missed = baked({high}, make_quad(), options).result.texels_missed;
                  return missed == 0 ? std::string() : fmt::format("{} missed", missed);
              }}}};
}

}  // namespace

std::vector<HardCase> bake_cases() {
    return {self_case(),   edges_case(), border_case(), needle_case(),
            missed_case(), wall_case(),  scale_case(),  broken_case(),
            bare_case(),   apart_case(), unit_case(),   short_rays_case()};
}

}  // namespace relief::test
