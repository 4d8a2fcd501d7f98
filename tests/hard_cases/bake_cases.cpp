// SPDX-License-Identifier: Apache-2.0
// Hard cases of the baker: rays that miss or meet several surfaces, and the shapes of meshes and
// maps.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <string>
#include <vector>

#include "hard_cases/hard_cases.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"
#include "relief/mesh/statistics.h"
#include "relief/mesh/texel_coverage.h"
#include "support/peak_memory.h"

namespace relief::test {
namespace {

/// Texels along each side of a map, unless a case sets another size.
constexpr int bake_side = 16;
constexpr std::size_t bake_texels = std::size_t{bake_side} * bake_side;

const glm::dvec3 flat_normal(0, 0, 1);

struct HardBake {
    std::vector<float> normals, heights;
    std::vector<TexelState> states;
    BakeResult result;
    Report report;

    [[nodiscard]] double degrees(std::size_t texel, const glm::dvec3& expected) const {
        return degrees_between({normals[3 * texel], normals[3 * texel + 1], normals[3 * texel + 2]},
                               expected);
    }
};

/// \param options  the function sets their layers
HardBake baked(const std::vector<Mesh>& high, const Mesh& low, BakeOptions options) {
    HardBake map;
    options.map.layers.heights = true;
    map.result = bake_normals(
        high, low, options,
        [&](const BakedRows& rows) {
            map.normals.insert(map.normals.end(), rows.normals.begin(), rows.normals.end());
            map.heights.insert(map.heights.end(), rows.heights.begin(), rows.heights.end());
            map.states.insert(map.states.end(), rows.states.begin(), rows.states.end());
        },
        map.report);
    return map;
}

/// Bakes a map of 16 x 16 texels.
HardBake baked(const std::vector<Mesh>& high, const Mesh& low, int padding = 0) {
    BakeOptions options;
    options.map.width = bake_side;
    options.map.height = bake_side;
    options.map.padding = padding;
    return baked(high, low, options);
}

Mesh moved(Mesh mesh, const glm::vec3& by) {
    for (glm::vec3& position : mesh.positions)
        position += by;
    return mesh;
}

/// Returns a problem unless every texel is baked with this normal and height.
std::string not_all(const HardBake& map, const glm::dvec3& normal, double height) {
    for (std::size_t i = 0; i < map.states.size(); ++i) {
        if (map.states[i] != TexelState::baked) return fmt::format("texel {} is not baked", i);
        if (!(map.degrees(i, normal) < 0.001))
            return fmt::format("texel {} is {} degrees off", i, map.degrees(i, normal));
        if (!(std::abs(map.heights[i] - height) < 1e-5))
            return fmt::format("texel {} is {} high", i, map.heights[i]);
    }
    return "";
}

/// Returns the error message of a bake of this high mesh onto a square, or "taken" if it succeeds.
std::string refusal_of(const Mesh& high, BakeOptions options = {}) {
    options.map.width = options.map.height = bake_side;
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
    return {"mesh baked onto itself",
            "A cube, a sphere and a torus as both high and low mesh. Every ray hits "
            "its starting point, often on an edge or vertex.",
            "rays that miss the surface on which they start; bakers with a bias",
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
            "A square of 8 x 8 cells under a map whose texel centers lie on its diagonals.",
            "Embree#174, #181; tinybvh#168",
            {{"bake", "one hit for each ray, independent of the order of triangles", [] {
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

/// One rotated triangle whose edges cross texels.
HardCase border_case() {
    return {
        "rays on open borders",
        "A single triangle, baked onto itself. Texels that only touch it are "
        "sampled exactly on its edges.",
        "rays that miss because of rounding; dark borders",
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
            "A square, and above it vertical triangles of width 1e-7 between the rays.",
            "Embree#387",
            {{"bake", "only the square is hit", [] {
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
    return {"rays that hit nothing",
            "The high mesh covers only the left half of the low mesh.",
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
            "A square, and 0.3 above it a wall of thickness 0.01 whose far side "
            "faces the same direction.",
            "the wrong surface in tight folds",
            {{"bake", "the square is hit; of two open sheets, the outer one is hit", [] {
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
            "A torus with scaled positions, baked onto itself.",
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
            "Nothing; triangles without area; vertices that are not finite, beside a valid square.",
            "crashes of ray casters",
            {{"bake", "an empty mesh is refused; otherwise only the square is hit", [] {
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
    return {"high mesh at another position",
            "A square at 5 times its size from the low mesh, in front of it or beside it.",
            "bakers that silently write an empty map",
            {{"bake", "refused: apart, unless the ray length reaches it", [] {
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
            "A square with 100 times and with a hundredth of the size of the low mesh.",
            "bakers that write a wrong map",
            {{"bake", "refused (size), unless allowed", [] {
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
            "A square 0.5 above the low mesh, beside it a triangle that reaches down "
            "to the low mesh, and rays that start at a distance of 0.25.",
            "unexplained holes",
            {{"bake", "all texels are missed, and 0.5 is reported as the length that hits", [] {
                  Mesh high = moved(make_quad(), {0, 0, 0.5F});
                  high.positions.insert(high.positions.end(), {{2, 0, 0}, {2, 1, 0}, {2, 0, 0.5F}});
                  high.triangles.emplace_back(4, 5, 6);
                  high.normals.clear();
                  high.texcoords.clear();
                  high.tangents.clear();
                  BakeOptions options;
                  options.map.width = options.map.height = bake_side;
                  options.max_distance = 1.5;
                  options.offset = 0.25;
                  options.map.measures_missed = true;
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

namespace {

std::string says(bool is_so, const std::string& otherwise = "not so") {
    return is_so ? "" : otherwise;
}

Mesh with_texcoords(Mesh mesh, float scale, const glm::vec2& by) {
    for (glm::vec2& texcoord : mesh.texcoords)
        texcoord = scale * texcoord + by;
    return mesh;
}

HardCase upright_case() {
    return {"upright walls",
            "A cube with texture coordinates projected from above, so that its walls "
            "are lines in the map.",
            "jbake-tools#14",
            {{"bake", "the map of the top; reported: 8 x triangle without area in the image", [] {
                  Mesh low = make_cube();
                  const Bounds box = bounds_of(low);
                  for (std::size_t i = 0; i < low.positions.size(); ++i) {
                      const glm::vec3 place = (low.positions[i] - box.min) / (box.max - box.min);
                      low.texcoords[i] = {place.x, 1.0F - place.y};
                  }
                  const HardBake map = baked({low}, low);
                  const auto count = map.report.count("triangle without area in the image");
                  if (count != 8) return fmt::format("{} reported", count);
                  return not_all(map, flat_normal, 0.0);
              }}}};
}

HardCase mesh_hole_case() {
    return {"high mesh with a hole",
            "A square of 2 x 2 cells with one missing cell.",
            "bakers that leave black texels",
            {{"bake", "reported: 64 x texel missed by its rays", [] {
                  Mesh high = make_quad(2);
                  high.triangles.erase(high.triangles.begin(), high.triangles.begin() + 2);
                  const HardBake map = baked({high}, make_quad());
                  return says(map.report.count("texel missed by its rays") == bake_texels / 4 &&
                              map.result.texels_baked == bake_texels * 3 / 4);
              }}}};
}

HardCase crossing_case() {
    return {"self-intersecting high mesh",
            "Two inclined squares that intersect in the middle.",
            "wrong sheets",
            {{"bake", "the outer square is hit", [] {
                  Mesh right = make_quad(), left = make_quad();
                  for (std::size_t i = 0; i < 4; ++i) {
                      right.positions[i].z = 0.1F * right.positions[i].x;
                      left.positions[i].z = -0.1F * left.positions[i].x;
                  }
                  const HardBake map = baked({right, left}, make_quad());
                  for (std::size_t i = 0; i < bake_texels; ++i) {
                      const double x = (static_cast<double>(i % bake_side) + 0.5) / 8.0 - 1.0;
                      if (!(std::abs(map.heights[i] - 0.1 * std::abs(x)) < 1e-6))
                          return fmt::format("texel {} is {} high", i, map.heights[i]);
                  }
                  return std::string();
              }}}};
}

HardCase coplanar_case() {
    return {"coplanar high mesh",
            "Two copies of the square itself, and one of 8 x 8 cells.",
            "rays that start on the surface that they should hit",
            {{"bake", "flat within 0.001 degrees, no texel missed, height 0", [] {
                  return not_all(baked({make_quad(), make_quad(8), make_quad()}, make_quad()),
                                 flat_normal, 0.0);
              }}}};
}

HardCase model_size_case() {
    return {"high meshes far larger or smaller than the low mesh",
            "A square with 100000 times the size, and one with a thousandth of the "
            "size inside a texel.",
            "ray lengths derived from the high mesh",
            {{"bake",
              "if allowed: all texels are baked; one is, and 255 x texel missed by its rays", [] {
                  Mesh large = make_quad(), small = make_quad();
                  for (std::size_t i = 0; i < 4; ++i) {
                      large.positions[i] *= 1e5F;
                      small.positions[i] =
                          1e-3F * small.positions[i] + glm::vec3(0.0625F, 0.0625F, 0.01F);
                  }
                  BakeOptions options;
                  options.map.width = options.map.height = bake_side;
                  options.allow_size_mismatch = true;
                  const std::string problem =
                      not_all(baked({large}, make_quad(), options), flat_normal, 0.0);
                  if (!problem.empty()) return problem;
                  const HardBake map = baked({small}, make_quad(), options);
                  return says(map.result.texels_baked == 1 &&
                              map.report.count("texel missed by its rays") == bake_texels - 1);
              }}}};
}

HardCase fin_case() {
    return {"non-manifold high mesh",
            "A square with a fin at its diagonal edge, which has three triangles.",
            "bakers that need closed solids",
            {{"bake", "flat within 0.001 degrees, no texel missed", [] {
                  Mesh high = make_quad();
                  const glm::uvec3 first = high.triangles[0];
                  high.positions.push_back(high.positions[first.x] + glm::vec3(0, 0, 0.005F));
                  high.normals.emplace_back(0, 0, 1);
                  high.texcoords.emplace_back(0, 0);
                  for (const int corner : {1, 2})
                      high.triangles.emplace_back(first.x, first[corner], 4);
                  high.tangents.clear();
                  HardBake map = baked({high}, make_quad());
                  std::fill(map.heights.begin(), map.heights.end(), 0.0F);
                  return not_all(map, flat_normal, 0.0);
              }}}};
}

HardCase degenerate_case() {
    return {
        "low triangles without area",
        "A square covers the left half of the map, and two triangles whose "
        "corners coincide in space cover the right half.",
        "bakers that divide by the area",
        {{"bake", "all texels are baked at their position; reported: 2 x degenerate triangle", [] {
              Mesh low = make_quad();
              for (glm::vec2& texcoord : low.texcoords)
                  texcoord.x *= 0.5F;
              for (int i = 0; i < 4; ++i) {
                  low.positions.emplace_back(0, 0, 0);
                  low.texcoords.push_back(low.texcoords[static_cast<std::size_t>(i)] +
                                          glm::vec2(0.5F, 0));
              }
              low.normals.clear();
              low.tangents.clear();
              for (int i = 0; i < 2; ++i)
                  low.triangles.push_back(low.triangles[static_cast<std::size_t>(i)] + 4U);
              const HardBake map = baked({make_quad()}, low);
              return says(map.result.texels_baked == bake_texels &&
                              map.report.count("degenerate triangle") == 2,
                          fmt::format("{} baked, {} reported", map.result.texels_baked,
                                      map.report.count("degenerate triangle")));
          }}}};
}

HardCase nothing_low_case() {
    return {"low mesh without triangles",
            "Vertices with texture coordinates, without triangles.",
            "crashes",
            {{"bake", "an empty map", [] {
                  Mesh low = make_quad();
                  low.triangles.clear();
                  const HardBake map = baked({make_quad()}, low);
                  return says(map.result.coverage.empty == bake_texels &&
                              map.result.texels_missed == 0);
              }}}};
}

HardCase outside_case() {
    return {
        "texture coordinates outside of the unit square",
        "A square whose texture coordinates are offset by (1, 1).",
        "bakers that silently wrap or drop it",
        {{"bake", "not baked; with repetition: all texels; as its UDIM tile: all texels",
          [] {
              const Mesh low = with_texcoords(make_quad(), 1.0F, {1, 1});
              BakeOptions options;
              options.map.width = options.map.height = bake_side;
              const auto count = [&] {
                  return baked({make_quad()}, low, options).result.texels_baked;
              };
              const std::size_t left_out = count();
              options.map.placement.repeat = true;
              const std::size_t repeated = count();
              options.map.placement = {{1, 1}, false};
              return says(left_out == 0 && repeated == bake_texels && count() == bake_texels);
          }},
         {"tiles", "reported: 2 triangles outside of the map and of all UDIM tiles", [] {
              const Mesh low = with_texcoords(make_quad(), 1.0F, {1, 1});
              for (const TileRange& range : {TileRange{}, udim_tiles}) {
                  if (tiles_of(low.texcoords, low.triangles, std::nullopt, range).outside.size() !=
                      2)
                      return std::string("not so");
              }
              return std::string();
          }}}};
}

HardCase texture_overlap_case() {
    return {
        "bake of overlapping charts, one of them mirrored",
        "Two squares with the same texture coordinates; the second is mirrored "
        "and lower.",
        "maps that mix both charts",
        {{"bake", "the map of the first square; reported: 256 x texel of mirrored triangles", [] {
              Mesh low = moved(make_quad(), {0, 0, -1});
              for (glm::vec2& texcoord : low.texcoords)
                  texcoord.x = 1.0F - texcoord.x;
              const Mesh upper = make_quad();
              const auto first = static_cast<std::uint32_t>(low.positions.size());
              low.positions.insert(low.positions.end(), upper.positions.begin(),
                                   upper.positions.end());
              low.texcoords.insert(low.texcoords.end(), upper.texcoords.begin(),
                                   upper.texcoords.end());
              low.normals.clear();
              low.tangents.clear();
              for (const glm::uvec3& triangle : upper.triangles)
                  low.triangles.push_back(triangle + first);
              const HardBake map = baked({moved(make_quad(), {0, 0, 0.01F})}, low);
              if (map.report.count("texel of mirrored triangles") != bake_texels)
                  return std::string("not reported");
              return not_all(map, flat_normal, 0.01);
          }}}};
}

HardCase speck_case() {
    return {"bake of a chart smaller than a texel",
            "A square with a tenth of the size of a texel that covers no texel center.",
            "charts that disappear",
            {{"bake", "one texel is baked", [] {
                  const Mesh low = with_texcoords(make_quad(), 0.1F / bake_side,
                                                  glm::vec2(5.1F / bake_side, 3.1F / bake_side));
                  const HardBake map = baked({make_quad()}, low);
                  return says(map.result.texels_baked == 1 &&
                              map.states[3 * bake_side + 5] == TexelState::baked);
              }}}};
}

HardCase map_size_case() {
    return {"maps of 1 x 1, 3 x 17 and 16384 x 64 texels",
            "A square, baked onto itself.",
            "sizes that are not powers of two; bakers with a limit of 8192",
            {{"bake", "flat within 0.001 degrees, no texel missed", [] {
                  for (const auto& [width, height] : {std::pair(1, 1), {3, 17}, {16384, 64}}) {
                      BakeOptions options;
                      options.map.width = width;
                      options.map.height = height;
                      const HardBake map = baked({make_quad()}, make_quad(), options);
                      const std::string problem = not_all(map, flat_normal, 0.0);
                      if (!problem.empty()) return problem;
                  }
                  return std::string();
              }}}};
}

#ifdef __SANITIZE_THREAD__
constexpr double max_megabytes = 5 * 512;  // Up to 4 bytes for each byte that is accessed.
#else
constexpr double max_megabytes = 512;
#endif

HardCase memory_case() {
    return {"8192 texels across with 16 samples each",
            "A map of 8192 x 512 texels with a chart on a 64th of its area, baked in "
            "bands of rows.",
            "TexTools-Blender#35: buffers of 32K x 32K",
            {{"bake", "less than half of the gigabyte that all samples need, with two threads", [] {
                  set_thread_limit(2);
                  const double before = test::peak_megabytes();
                  const Mesh low = with_texcoords(make_quad(), 0.125F, glm::vec2(0.5F));
                  BakeOptions options;
                  options.map.width = 8192;
                  options.map.height = 512;
                  options.map.samples = 16;
                  Report report;
                  const std::vector<Mesh> high = {make_quad()};
                  const BakeResult result = bake_normals(
                      high, low, options, [](const BakedRows&) {}, report);
                  set_thread_limit(0);
                  if (result.texels_baked != 1024UL * 64)
                      return fmt::format("{} texels baked", result.texels_baked);
                  // Memory: 50 MB per thread for the owners of samples, 134 MB for a strip of them,
                  // and Embree.
                  const double more = test::peak_megabytes() - before;
                  return says(more < max_megabytes, fmt::format("{:.0f} MB more", more));
              }}}};
}

}  // namespace

std::vector<HardCase> bake_shape_cases() {
    return {upright_case(),         mesh_hole_case(),   crossing_case(),
            coplanar_case(),        model_size_case(),  fin_case(),
            degenerate_case(),      nothing_low_case(), outside_case(),
            texture_overlap_case(), speck_case(),       map_size_case(),
            memory_case()};
}

}  // namespace relief::test
