// SPDX-License-Identifier: Apache-2.0
// Shapes of high and low meshes, and of maps.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hard_cases/baked_map.h"
#include "hard_cases/map_cases.h"
#include "relief/mesh/map_tiles.h"
#include "relief/mesh/shapes.h"
#include "relief/mesh/threads.h"
#include "support/peak_memory.h"

namespace relief::test {
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
            "A cube whose texture lies on it from above, so that its walls are lines in the map.",
            "jbake-tools#14",
            {{"bake", "the top's own; reported: 8 x triangle without area in the image", [] {
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
            "A square of 2 x 2 cells without one of them.",
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
    return {"high mesh that passes through itself",
            "Two squares that lean to either side and cross in the middle.",
            "wrong sheets",
            {{"bake", "the outer one of the two", [] {
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
    return {"high mesh in the low one's plane",
            "The square itself, twice, and once more in 8 x 8 cells.",
            "rays that start on what they should hit",
            {{"bake", "flat within 0.001 degrees, no texel missed, height 0", [] {
                  return not_all(baked({make_quad(), make_quad(8), make_quad()}, make_quad()),
                                 flat_normal, 0.0);
              }}}};
}

HardCase model_size_case() {
    return {"high meshes far larger or smaller than the low one",
            "A square 100000 times as large; one a thousandth as large, in the middle of a texel.",
            "distances guessed from the high mesh",
            {{"bake", "if allowed: all texels; one, and 255 x texel missed by its rays", [] {
                  Mesh large = make_quad(), small = make_quad();
                  for (std::size_t i = 0; i < 4; ++i) {
                      large.positions[i] *= 1e5F;
                      small.positions[i] =
                          1e-3F * small.positions[i] + glm::vec3(0.0625F, 0.0625F, 0.01F);
                  }
                  BakeOptions options;
                  options.width = options.height = bake_side;
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
    return {"high mesh that is no manifold",
            "A square with a fin on its diagonal edge, so that three triangles meet there.",
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
    return {"low triangles without area",
            "The left half of the map is a square's, the right half two triangles' that are a "
            "point.",
            "bakers that divide by the area",
            {{"bake", "every texel from where it is; reported: 2 x degenerate triangle", [] {
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
            "Vertices with texture coordinates, and nothing else.",
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
        "A square whose texture lies one to the right, and one down.",
        "bakers that wrap or drop it without a word",
        {{"bake", "left out; repeating: all of it; its tile: all of it",
          [] {
              const Mesh low = with_texcoords(make_quad(), 1.0F, {1, 1});
              BakeOptions options;
              options.width = options.height = bake_side;
              const auto count = [&] {
                  return baked({make_quad()}, low, options).result.texels_baked;
              };
              const std::size_t left_out = count();
              options.placement.repeat = true;
              const std::size_t repeated = count();
              options.placement = {{1, 1}, false};
              return says(left_out == 0 && repeated == bake_texels && count() == bake_texels);
          }},
         {"tiles", "2 triangles outside of the map, and of all UDIM tiles", [] {
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
    return {"bake of charts that overlap, one of them mirrored",
            "Two squares with the same texture; the second one's is mirrored, and it is lower.",
            "two charts mixed texel by texel",
            {{"bake", "the first one's; reported: 256 x texel of mirrored triangles", [] {
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
            "A square on a tenth of a texel, between the centres of all.",
            "charts that vanish",
            {{"bake", "one texel", [] {
                  const Mesh low = with_texcoords(make_quad(), 0.1F / bake_side,
                                                  glm::vec2(5.1F / bake_side, 3.1F / bake_side));
                  const HardBake map = baked({make_quad()}, low);
                  return says(map.result.texels_baked == 1 &&
                              map.states[3 * bake_side + 5] == TexelState::baked);
              }}}};
}

HardCase map_size_case() {
    return {"maps of 1 x 1, 3 x 17 and 16384 x 64 texels",
            "A square onto itself.",
            "sizes that are no power of two; bakers that stop at 8192",
            {{"bake", "flat within 0.001 degrees, no texel missed", [] {
                  for (const auto& [width, height] : {std::pair(1, 1), {3, 17}, {16384, 64}}) {
                      BakeOptions options;
                      options.width = width;
                      options.height = height;
                      const HardBake map = baked({make_quad()}, make_quad(), options);
                      const std::string problem = not_all(map, flat_normal, 0.0);
                      if (!problem.empty()) return problem;
                  }
                  return std::string();
              }}}};
}

HardCase memory_case() {
    return {"8192 texels across with 16 samples each",
            "A map of 8192 x 512 whose chart is a 64th of it; baked in strips from the top.",
            "TexTools-Blender#35: buffers of 32K x 32K",
            {{"bake", "under half of the GB that its samples would take, on two threads", [] {
                  set_thread_limit(2);
                  const double before = test::peak_megabytes();
                  const Mesh low = with_texcoords(make_quad(), 0.125F, glm::vec2(0.5F));
                  BakeOptions options;
                  options.width = 8192;
                  options.height = 512;
                  options.samples = 16;
                  Report report;
                  const std::vector<Mesh> high = {make_quad()};
                  const BakeResult result = bake_normals(
                      high, low, options, [](const BakedRows&) {}, report);
                  set_thread_limit(0);
                  if (result.texels_baked != 1024UL * 64)
                      return fmt::format("{} texels baked", result.texels_baked);
                  // 50 MB a thread for owners of samples, 134 for a strip of them, and Embree.
                  const double more = test::peak_megabytes() - before;
                  return says(more < 512, fmt::format("{:.0f} MB more", more));
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
