// SPDX-License-Identifier: Apache-2.0
// Hard cases of normal maps: normals without direction, length or z, and maps with an unknown
// convention.
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "hard_cases/hard_cases.h"
#include "relief/accuracy/ground_truth.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/height_map.h"
#include "relief/mesh/map_convention.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/normal_map_check.h"
#include "support/images.h"

namespace relief::test {
using namespace relief::accuracy;

namespace {

std::string not_these(const Image& image, const std::vector<float>& expected) {
    const auto samples = image.as<float>();
    for (std::size_t i = 0; i < expected.size(); ++i) {
        if (!(std::abs(samples[i] - expected[i]) <= 1e-6F))
            return fmt::format("sample {} is {}, not {}", i, samples[i], expected[i]);
    }
    return "";
}

std::string not_counted(const Report& report, const std::string& kind, std::size_t count) {
    if (report.count(kind) == count) return "";
    return fmt::format("{} x {}, not {}", report.count(kind), kind, count);
}

std::string first_of(const std::string& problem, const std::string& other) {
    return problem.empty() ? other : problem;
}

/// Texels with vertical surfaces, and one texel that faces outwards.
Image steep_normals() {
    return image_of<float>(3, {1, 0, 0, 0, -1, 0, 0.6F, 0, -0.8F, 0, 0, 1});
}

HardCase steep_case() {
    return {"normals with z = 0 or below",
            "A normal map with texels at 90 degrees, whose slopes are infinite, and "
            "one that faces backwards and has no slope.",
            "OpenImageIO's maketx divides by z without a check",
            {{"slopes",
              "of length 1024 (89.94 degrees) in the direction of the normal; "
              "reported: 3 x normal too steep for a slope",
              [] {
                  Report report;
                  const Image slopes = slopes_from_normals(steep_normals(), report);
                  return first_of(not_these(slopes, {-1024, 0, 0, 1024, -1024, 0, 0, 0}),
                                  not_counted(report, "normal too steep for a slope", 3));
              }},
             {"strength 2",
              "finite; normals at 90 degrees are unchanged; reported: 3 x normal that "
              "does not face outwards",
              [] {
                  Image normals = steep_normals();
                  Report report;
                  scale_slopes(normals, 2.0, report);
                  const float length = std::sqrt(1.44F + 0.64F);
                  return first_of(
                      not_these(normals, {1, 0, 0, 0, -1, 0, 1.2F / length, 0, -0.8F / length}),
                      not_counted(report, "normal that does not face outwards", 3));
              }},
             {"blend, reoriented",
              "finite; a base that faces backwards is unchanged; reported: 1 x blend "
              "without direction",
              [] {
                  Image base = image_of<float>(3, {0, 0, -1});
                  Report report;
                  blend_normals(base, image_of<float>(3, {0.6F, 0, 0.8F}), NormalBlend::reoriented,
                                report);
                  return first_of(not_these(base, {0, 0, -1}),
                                  not_counted(report, "blend without direction", 1));
              }}}};
}

HardCase zero_case() {
    return {
        "texels without direction",
        "A texel (128,128,128), the codes next to zero, and normals whose mean is zero.",
        "Unity Graphics PR#5356",
        {{"decode", "flat; reported: 1 x normal without direction",
          [] {
              Report report;
              const Image gray = image_of<std::uint8_t>(3, {128, 128, 128});
              const Image normals = decode_normal_map(gray, Green::up, FlatCode::middle, report);
              Report of_half;
              const Image half = decode_normal_map(gray, Green::up, FlatCode::half, of_half);
              return first_of(first_of(not_these(normals, {0, 0, 1}), not_these(half, {0, 0, 1})),
                              first_of(not_counted(report, "normal without direction", 1),
                                       not_counted(of_half, "normal without direction", 1)));
          }},
         {"resize, mips", "flat; reported: 1 x normals that cancel", [] {
              const Image opposite = image_of<float>(3, {1, 0, 0, -1, 0, 0});
              ResizeOptions options;
              options.domain = ResizeDomain::vectors;
              options.filter = ResizeFilter::box;
              Report report;
              const Image small = resize_normals(opposite, 1, 1, options, report);
              Report of_mips;
              Image level = normal_mip_levels(opposite)[0];
              const Image length = split_lengths(level, of_mips);
              return first_of(first_of(not_these(small, {0, 0, 1}), not_these(level, {0, 0, 1})),
                              first_of(not_counted(report, "normals that cancel", 1),
                                       not_counted(of_mips, "normals that cancel", 1)));
          }}}};
}

HardCase two_channel_case() {
    return {"x and y longer than 1",
            "Two channels without z; compression has made (x, y) longer than 1.",
            "Daemon PR#260, Falcor#478 (NaN)",
            {{"rebuild z", "z = 0 and (x, y) normalized; reported: 1 x x and y longer than 1", [] {
                  Report report;
                  const Image normals = decode_xy_map(image_of<std::uint8_t>(2, {255, 1}), {0, 1},
                                                      Green::up, FlatCode::middle, report);
                  const float half = std::sqrt(0.5F);
                  return first_of(not_these(normals, {half, -half, 0}),
                                  not_counted(report, "x and y longer than 1", 1));
              }}}};
}

/// A map whose slopes alternate between 1 and -1.
Image checker() {
    std::vector<float> slopes;
    for (int i = 0; i < 16; ++i)
        slopes.insert(slopes.end(), {(i + i / 4) % 2 == 0 ? 1.0F : -1.0F, 0.0F});
    Report report;
    return normals_from_slopes(image_of(4, 4, 2, ColorSpace::data, std::move(slopes)), report);
}

HardCase checker_case() {
    return {
        "checkerboard of slopes",
        "Alternating slopes of 1 and -1. Every mip level is flat and would look "
        "like a mirror.",
        "renormalized mip levels",
        {{"mips",
          "flat with length 0.7071 on each level; roughness 0 becomes 1; the slope "
          "variance of 0.5 along each axis is preserved",
          [] {
              for (Image& level : normal_mip_levels(checker())) {
                  Report report;
                  const Image length = split_lengths(level, report);
                  const Image roughness = roughness_from_lengths(length, 0.0);
                  const std::string problem = first_of(
                      first_of(not_these(level, {0, 0, 1}), not_these(length, {std::sqrt(0.5F)})),
                      not_these(roughness, {1.0F}));
                  if (!problem.empty()) return problem;
                  if (!report.empty()) return to_string(report.findings().front());
              }
              return std::string();
          }}}};
}

HardCase code_zero_case() {
    return {"code 0 of a signed component",
            "If 128 is zero, then both 1 and 0 stand for -1, and code 0 has no opposite.",
            "signed 8-bit maps",
            {{"flip", "255, as for code 1; reported: 1 x code 0 without an opposite", [] {
                  Image map = image_of<std::uint8_t>(3, {0, 128, 128, 1, 128, 128});
                  Report report;
                  map_axes(map, {{{0, true}, {1, false}, {2, false}}}, FlatCode::middle, report);
                  const bool is_right =
                      map.as<std::uint8_t>()[0] == 255 && map.as<std::uint8_t>()[3] == 255;
                  return first_of(is_right ? "" : "another code",
                                  not_counted(report, "code 0 without an opposite", 1));
              }}}};
}

}  // namespace

std::vector<HardCase> normal_map_cases() {
    return {steep_case(), zero_case(), two_channel_case(), checker_case(), code_zero_case()};
}

namespace {

/// A green-up map of hills in 8 bits.
Image hills() {
    Report report;
    return normal_map_from_height(
        wave_heights(64, 64, tiling_waves(64, 64, 8, 8.0, 0.5, 3)).heights,
        {Kernel::central3, Wrap::repeat, 1.0}, {.bits = 8}, report);
}

/// Applies `change` to every sample of `channels`, in the range 0 to 1.
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

/// Returns a problem unless the check reports exactly these conditions.
std::string not_found(const Image& map, const std::vector<MapCondition>& expected,
                      const std::map<std::string, std::string>& metadata = {}) {
    std::vector<MapCondition> conditions;
    std::string words;
    for (const MapConditionCount& found : check_normal_map(map, metadata).conditions) {
        conditions.push_back(found.condition);
        words += std::string(condition_info(found.condition).word) + "; ";
    }
    return conditions == expected ? "" : "it finds: " + words;
}

HardCase color_case() {
    return {"normal map stored as a color",
            "The sRGB curve was applied when it was saved, or removed when it was "
            "read: the flat code is 188 or 55 of 255.",
            "paintsystem#132",
            {{"check map", "problem: stored through the sRGB curve",
              [] {
                  return not_found(with_channel(hills(), every_channel, srgb_from_linear),
                                   {MapCondition::stored_through_srgb});
              }},
             {"check map", "problem: darkened by the sRGB curve", [] {
                  return not_found(with_channel(hills(), every_channel, linear_from_srgb),
                                   {MapCondition::decoded_from_srgb});
              }}}};
}

HardCase green_case() {
    const auto flipped = [](float sample) { return std::min(1.0F, 256.0F / 255.0F - sample); };
    return {"green of unknown direction",
            "A normal map of hills, with green up or down and no metadata; and one of ripples "
            "along an axis, which fits both directions.",
            "OpenGL's and DirectX's conventions",
            {{"check map",
              "up and down are recognized; a file whose metadata says the opposite: problem, green "
              "is not as stated",
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
             {"check map",
              "ripples: not determined; note: the direction of green cannot be determined", [] {
                  const HeightWave wave{1.0, {2.0 * 3.14159265358979 / 16.0, 0.0}, 0.0};
                  Report report;
                  return not_found(normal_map_from_height(
                                       wave_heights(64, 64, std::span(&wave, 1)).heights,
                                       {Kernel::central3, Wrap::repeat, 1.0}, {.bits = 8}, report),
                                   {MapCondition::green_unknown, MapCondition::y_constant});
              }}}};
}

HardCase whirl_case() {
    return {"normals without a height field",
            "A circular slope field of magnitude 0.1.",
            "painted and blended normal maps",
            {{"heights", "flat; the report has the remaining slope: 0.1 (RMS)", [] {
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

/// Returns the owners of the texels of a map by rows: "0", "1", ..., and "." for none.
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
    return {"texel centers on a shared edge",
            "A square of two triangles on 4 x 4 texels. The diagonal passes through "
            "four texel centers.",
            "rasterizers without a fill rule",
            {{"cover texels",
              "each of the 16 texels has one owner, for both orders of the triangles", [] {
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
            "A triangle with a tenth of the size of a texel that covers no texel center.",
            "bakers that drop such charts",
            {{"cover texels", "it owns the texel; the nearest point of the triangle is used", [] {
                  Report report;
                  return not_owned(
                      owners({{1.1F, 1.1F}, {1.2F, 1.1F}, {1.1F, 1.2F}}, {{0, 2, 1}}, 3, report),
                      "....0....", report);
              }}}};
}

HardCase overlap_case() {
    return {"overlapping charts",
            "Two squares with the same texels; the first is mirrored.",
            "bakers in which the last chart wins",
            {{"cover texels",
              "the unmirrored square owns all texels; reported: 4 x texel of mirrored "
              "triangles",
              [] {
                  Report report;
                  const std::vector<glm::vec2> corners = {{-1, -1}, {5, -1}, {-1, 5}};
                  return not_owned(owners(corners, {{0, 1, 2}, {0, 2, 1}}, 2, report), "1111",
                                   report, "texel of mirrored triangles", 4);
              }}}};
}

HardCase nothing_case() {
    return {"texture triangles that cover nothing",
            "A collinear triangle, one whose corners coincide, and one with a "
            "non-finite coordinate.",
            "incompletely unwrapped models",
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
            "A square whose stored tangents are parallel to its normals, so there is "
            "no tangent frame.",
            "models with invalid tangents",
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
