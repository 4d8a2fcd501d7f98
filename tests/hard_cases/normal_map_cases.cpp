// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "hard_cases/map_cases.h"
#include "relief/mesh/normal_blend.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/normal_map_operations.h"
#include "relief/mesh/normal_mips.h"
#include "relief/mesh/normal_resize.h"

namespace relief::test {
namespace {

template <typename Sample>
Image image_of(int width, int channels, std::vector<Sample> samples) {
    Image image = make_image(width, static_cast<int>(samples.size()) / width / channels, channels,
                             sizeof(Sample) * 8, ColorSpace::data);
    image.samples = std::move(samples);
    return image;
}

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

/// Texels that stand upright, and one that faces outwards.
Image steep_normals() {
    return image_of<float>(4, 3, {1, 0, 0, 0, -1, 0, 0.6F, 0, -0.8F, 0, 0, 1});
}

HardCase steep_case() {
    return {"normals with z = 0 or below",
            "A normal map with texels that stand upright, and one that faces back: their slopes "
            "are infinite, or none.",
            "OpenImageIO's maketx divides by z unguarded",
            {{"slopes",
              "1024 long (89.94 degrees), each in its own direction; reported: 3 x normal "
              "too steep for a slope",
              [] {
                  Report report;
                  const Image slopes = slopes_from_normals(steep_normals(), report);
                  return first_of(not_these(slopes, {-1024, 0, 0, 1024, -1024, 0, 0, 0}),
                                  not_counted(report, "normal too steep for a slope", 3));
              }},
             {"strength 2",
              "finite; upright ones stay upright; reported: 3 x normal that does not "
              "face outwards",
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
              "finite; onto a base that faces straight back, the base; "
              "reported: 1 x blend without direction",
              [] {
                  Image base = image_of<float>(1, 3, {0, 0, -1});
                  Report report;
                  blend_normals(base, image_of<float>(1, 3, {0.6F, 0, 0.8F}),
                                NormalBlend::reoriented, report);
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
              const Image gray = image_of<std::uint8_t>(1, 3, {128, 128, 128});
              const Image normals = decode_normal_map(gray, Green::up, FlatCode::middle, report);
              Report of_half;
              const Image half = decode_normal_map(gray, Green::up, FlatCode::half, of_half);
              return first_of(first_of(not_these(normals, {0, 0, 1}), not_these(half, {0, 0, 1})),
                              first_of(not_counted(report, "normal without direction", 1),
                                       not_counted(of_half, "normal without direction", 1)));
          }},
         {"resize, mips", "flat; reported: 1 x normals that cancel", [] {
              const Image opposite = image_of<float>(2, 3, {1, 0, 0, -1, 0, 0});
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
            "Two channels, from which z is to be computed, that compression left longer than 1.",
            "Daemon PR#260, Falcor#478 (NaN)",
            {{"rebuild z", "z = 0, x and y of length 1; reported: 1 x x and y longer than 1", [] {
                  Report report;
                  const Image normals = decode_xy_map(image_of<std::uint8_t>(1, 2, {255, 1}),
                                                      {0, 1}, Green::up, FlatCode::middle, report);
                  const float half = std::sqrt(0.5F);
                  return first_of(not_these(normals, {half, -half, 0}),
                                  not_counted(report, "x and y longer than 1", 1));
              }}}};
}

/// Slopes of 1 to the left and to the right in turns.
Image checker() {
    std::vector<float> slopes;
    for (int i = 0; i < 16; ++i)
        slopes.insert(slopes.end(), {(i + i / 4) % 2 == 0 ? 1.0F : -1.0F, 0.0F});
    Report report;
    return normals_from_slopes(image_of<float>(4, 2, std::move(slopes)), report);
}

HardCase checker_case() {
    return {
        "chequerboard of slopes",
        "Slopes of 1 and -1 in turns: every mip level is flat, and would shine like a mirror.",
        "renormalised mip levels",
        {{"mips",
          "flat, of length 0.7071 on each level; roughness 0 becomes 1, the slopes' "
          "variance of 0.5 along each axis being kept",
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
            "In the convention where 128 is zero, 1 stands for -1, and so does 0, which has no "
            "opposite.",
            "signed 8-bit maps",
            {{"flip", "255, as of code 1; reported: 1 x code 0 without an opposite", [] {
                  Image map = image_of<std::uint8_t>(2, 3, {0, 128, 128, 1, 128, 128});
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

}  // namespace relief::test
