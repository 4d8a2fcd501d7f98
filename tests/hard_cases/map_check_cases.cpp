// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "hard_cases/map_cases.h"
#include "relief/mesh/analytic_heights.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/heights_from_normals.h"
#include "relief/mesh/normal_map_check.h"
#include "relief/mesh/normal_space.h"
#include "relief/mesh/shapes.h"

namespace relief::test {
namespace {

/// Hills of 8 bits, green up.
Image hills() {
    Report report;
    return normal_map_from_height(
        wave_heights(64, 64, tiling_waves(64, 64, 8, 8.0, 0.5, 3)).heights,
        {Kernel::central3, Wrap::repeat, 1.0}, {.bits = 8}, report);
}

/// Every sample of `channels` changed by `change`, in the range 0 to 1.
template <typename Change>
Image with_channel(Image map, std::size_t channel, const Change& change) {
    for (std::size_t i = 0; i < map.sample_count(); ++i) {
        if (channel < 3 && i % 3 != channel) continue;
        std::uint8_t& sample = map.as<std::uint8_t>()[i];
        sample = static_cast<std::uint8_t>(
            std::lround(255.0F * change(static_cast<float>(sample) / 255.0F)));
    }
    return map;
}
constexpr std::size_t every_channel = 3;

/// That a check finds these conditions and no other.
std::string not_found(const Image& map, const std::vector<MapCondition>& expected,
                      const std::map<std::string, std::string>& metadata = {}) {
    std::vector<MapCondition> conditions;
    std::string words;
    for (const MapConditionCount& found : check_normal_map(map, metadata).found) {
        conditions.push_back(found.condition);
        words += std::string(condition_info(found.condition).word) + "; ";
    }
    return conditions == expected ? "" : "it finds: " + words;
}

HardCase color_case() {
    return {"normal map stored as a colour",
            "The sRGB curve was applied when it was saved, or undone when it was read: flat is 188 "
            "or 55 of 255.",
            "paintsystem#132",
            {{"check map", "trouble: stored through the sRGB curve",
              [] {
                  return not_found(with_channel(hills(), every_channel, srgb_from_linear),
                                   {MapCondition::stored_through_srgb});
              }},
             {"check map", "trouble: darkened by the sRGB curve", [] {
                  return not_found(with_channel(hills(), every_channel, linear_from_srgb),
                                   {MapCondition::decoded_from_srgb});
              }}}};
}

HardCase green_case() {
    const auto flipped = [](float sample) { return std::min(1.0F, 256.0F / 255.0F - sample); };
    return {"green of unknown direction",
            "A normal map of hills, with green up or down and nothing that says which; and one of "
            "ripples along an axis, which both directions suit.",
            "OpenGL's and DirectX's conventions",
            {{"check map",
              "up is told, and down; of a file that says the opposite, trouble: green "
              "is not as said",
              [flipped] {
                  const std::string up = not_found(hills(), {});
                  if (!up.empty()) return up;
                  const Image down = with_channel(hills(), 1, flipped);
                  const std::string told = not_found(down, {MapCondition::green_down});
                  if (!told.empty()) return told;
                  return not_found(down,
                                   {MapCondition::green_contradicted, MapCondition::green_down},
                                   {{"relief:green", "up"}});
              }},
             {"check map", "ripples: no guess; remarked: green cannot be told", [] {
                  const HeightWave wave{1.0, {2.0 * 3.14159265358979 / 16.0, 0.0}, 0.0};
                  Report report;
                  return not_found(normal_map_from_height(
                                       wave_heights(64, 64, std::span(&wave, 1)).heights,
                                       {Kernel::central3, Wrap::repeat, 1.0}, {.bits = 8}, report),
                                   {MapCondition::green_unknown, MapCondition::y_constant});
              }}}};
}

HardCase whirl_case() {
    return {"normals that no heights have",
            "Slopes that run in circles, 0.1 each way.",
            "painted and blended normal maps",
            {{"heights", "flat; the whole slope is left over, and said: 0.1 (RMS)", [] {
                  Image normals = make_image(32, 32, 3, 32, ColorSpace::data);
                  for (int row = 0; row < 32; ++row) {
                      for (int column = 0; column < 32; ++column) {
                          float* n =
                              &normals.as<float>()[static_cast<std::size_t>(row * 32 + column) * 3];
                          const double turn = 2.0 * 3.14159265358979 / 8.0;
                          n[0] = 0.1F * static_cast<float>(std::sin(turn * row));
                          n[1] = 0.1F * static_cast<float>(std::sin(turn * column));
                          n[2] = 1.0F;
                      }
                  }
                  Report report;
                  const IntegratedHeights result = heights_from_normals(normals, {}, report);
                  const bool is_right =
                      result.highest < 1e-6 && std::abs(result.residual_slope - 0.1) < 1e-6;
                  return is_right ? std::string()
                                  : fmt::format("heights of {}, {} left over", result.highest,
                                                result.residual_slope);
              }}}};
}

/// Who owns the texels of a map, by rows: "0", "1", ..., "." for nobody.
std::string owners(const std::vector<glm::vec2>& texels, const std::vector<glm::uvec3>& triangles,
                   int side, Report& report) {
    std::vector<glm::vec2> texcoords;
    for (const glm::vec2& texel : texels)
        texcoords.push_back(texel / static_cast<float>(side));
    CoverageOptions options;
    options.width = options.height = side;
    std::string rows;
    cover_texels(
        texcoords, triangles, options,
        [&](int, std::span<const CoveredTexel> covered) {
            for (const CoveredTexel& texel : covered)
                rows += texel.is_covered() ? std::to_string(texel.triangle) : ".";
        },
        report);
    return rows;
}

std::string not_owned(const std::string& rows, const std::string& expected, const Report& report,
                      const std::string& kind = "", std::size_t count = 0) {
    if (rows != expected) return "owners are " + rows;
    if (!kind.empty() && report.count(kind) != count)
        return fmt::format("{} x {}, not {}", report.count(kind), kind, count);
    return kind.empty() && !report.empty() ? to_string(report.findings().front()) : "";
}

HardCase shared_edge_case() {
    return {"texel centres on a shared edge",
            "A square of two triangles on 4 x 4 texels: their diagonal runs through four centres.",
            "rasterisers without a fill rule",
            {{"cover texels", "each of the 16 has one owner, in either order of the triangles", [] {
                  const std::vector<glm::vec2> corners = {{0, 0}, {4, 0}, {4, 4}, {0, 4}};
                  Report report;
                  const std::string problem =
                      not_owned(owners(corners, {{0, 2, 1}, {0, 3, 2}}, 4, report),
                                "0000100011001110", report);
                  if (!problem.empty()) return problem;
                  return not_owned(owners(corners, {{0, 3, 2}, {0, 2, 1}}, 4, report),
                                   "1111011100110001", report);
              }}}};
}

HardCase small_chart_case() {
    return {"chart smaller than a texel",
            "A triangle of a tenth of a texel, away from the centre of any.",
            "bakers that lose such charts",
            {{"cover texels", "owns the texel, with the nearest point on it", [] {
                  Report report;
                  return not_owned(
                      owners({{1.1F, 1.1F}, {1.2F, 1.1F}, {1.1F, 1.2F}}, {{0, 2, 1}}, 3, report),
                      "....0....", report);
              }}}};
}

HardCase overlap_case() {
    return {"charts on top of each other",
            "Two squares with the same texels, the first of them mirrored.",
            "bakers whose winner is whoever comes last",
            {{"cover texels",
              "the one that is not mirrored owns all; reported: 4 x texel of "
              "mirrored triangles",
              [] {
                  Report report;
                  const std::vector<glm::vec2> corners = {{-1, -1}, {5, -1}, {-1, 5}};
                  return not_owned(owners(corners, {{0, 1, 2}, {0, 2, 1}}, 2, report), "1111",
                                   report, "texel of mirrored triangles", 4);
              }}}};
}

HardCase nothing_case() {
    return {"texture triangles that cover nothing",
            "One on a line, one at a point, one with a coordinate that is not finite.",
            "models without a full unwrap",
            {{"cover texels",
              "no texel; reported: 2 x triangle without area in the image, 1 x "
              "texture not finite",
              [] {
                  Report report;
                  const float nan = std::numeric_limits<float>::quiet_NaN();
                  const std::string problem =
                      not_owned(owners({{0, 0}, {1, 1}, {2, 2}, {nan, 0}},
                                       {{0, 1, 2}, {0, 0, 0}, {0, 1, 3}}, 2, report),
                                "....", report, "triangle without area in the image", 2);
                  return problem.empty() && report.count("texture not finite") != 1
                             ? "texture not finite is not reported"
                             : problem;
              }}}};
}

HardCase no_frame_case() {
    return {"tangent along the normal, under a map",
            "A square whose stored tangents point along its normals: no plane to express a normal "
            "in.",
            "models with broken tangents",
            {{"to tangent space", "(0, 0, 1); reported: 16 x texel without a frame", [] {
                  Mesh quad = make_quad();
                  quad.tangents.assign(quad.positions.size(), glm::vec4(0, 0, 1, 1));
                  Image normals = make_image(4, 4, 3, 32, ColorSpace::data);
                  for (std::size_t i = 0; i < normals.sample_count(); ++i)
                      normals.as<float>()[i] = i % 3 == 0 ? 1.0F : 0.0F;
                  Report report;
                  const Image result = tangent_from_object(normals, quad, {}, report).normals;
                  for (std::size_t i = 0; i < result.sample_count(); ++i) {
                      if (result.as<float>()[i] != (i % 3 == 2 ? 1.0F : 0.0F))
                          return fmt::format("sample {} is {}", i, result.as<float>()[i]);
                  }
                  return report.count("texel without a frame") == 16
                             ? std::string()
                             : std::string("not all are reported");
              }}}};
}

}  // namespace

std::vector<HardCase> map_check_cases() {
    return {color_case(),       green_case(),   whirl_case(),   shared_edge_case(),
            small_chart_case(), overlap_case(), nothing_case(), no_frame_case()};
}

}  // namespace relief::test
