// SPDX-License-Identifier: Apache-2.0
// Height maps that are constant, tiny, stepped, with holes, or far too steep.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <span>

#include "hard_cases/map_cases.h"
#include "relief/mesh/bump_fields.h"
#include "relief/mesh/destaircase.h"
#include "relief/mesh/kernel_choice.h"
#include "relief/mesh/normal_map.h"
#include "support/height_fields.h"

namespace relief::test {
namespace {

constexpr std::array all_kernels = {
    Kernel::forward, Kernel::central3, Kernel::prewitt3, Kernel::sobel3,   Kernel::scharr3,
    Kernel::sobel5,  Kernel::scharr5,  Kernel::central5, Kernel::central7, Kernel::gaussian};
constexpr std::array all_wraps = {Wrap::repeat, Wrap::clamp, Wrap::mirror};
constexpr std::array both = {Arithmetic::float32, Arithmetic::float64};

/// Tries a map under every kernel, border and arithmetic until something is wrong.
std::string in_every_way(const Image& heights, double strength,
                         const std::function<std::string(const Image& normals)>& problem) {
    for (const Kernel kernel : all_kernels) {
        for (const Wrap wrap : all_wraps) {
            for (const Arithmetic arithmetic : both) {
                BumpOptions options;
                options.kernel = kernel;
                options.wrap = wrap;
                options.strength = strength;
                options.arithmetic = arithmetic;
                Report report;
                const std::string found = problem(normals_from_height(heights, options, report));
                if (!found.empty())
                    return fmt::format("kernel {}: {}", static_cast<int>(kernel), found);
            }
        }
    }
    return "";
}

std::string not_flat(const Image& normals) {
    const std::span<const float> n = normals.as<float>();
    for (std::size_t i = 0; i < n.size(); i += 3) {
        if (n[i] != 0.0F || n[i + 1] != 0.0F || n[i + 2] != 1.0F)
            return fmt::format("texel {} is ({}, {}, {})", i / 3, n[i], n[i + 1], n[i + 2]);
    }
    return "";
}

std::string not_unit(const Image& normals) {
    const std::span<const float> n = normals.as<float>();
    for (std::size_t i = 0; i < n.size(); i += 3) {
        const double length = std::hypot(static_cast<double>(n[i]), static_cast<double>(n[i + 1]),
                                         static_cast<double>(n[i + 2]));
        if (!(std::abs(length - 1.0) <= 1e-6))
            return fmt::format("texel {} has length {}", i / 3, length);
    }
    return "";
}

HardCase constant_case() {
    const auto heights = [] { return heights_of(9, 7, [](int, int) { return 0.3; }); };
    return {"constant height map",
            "All heights are 0.3, which no float is exactly.",
            "flat maps that are not flat after rounding",
            {{"bump", "exactly (0,0,1) under every kernel, border and arithmetic",
              [=] { return in_every_way(heights(), 16.0, not_flat); }},
             {"bump, 8 bit", "the code of flat, which decodes to exactly (0,0,1)",
              [=] {
                  Report report;
                  const Image codes = normal_map_from_height(heights(), {}, {.bits = 8}, report);
                  return not_flat(decode_normal_map(codes, Green::up, FlatCode::half, report,
                                                    FlatTexels::exact));
              }},
             {"choice of kernel", "the cheapest: every one is exact",
              [=]() -> std::string {
                  return choose_kernel(heights(), {}).kernel == Kernel::central3 ? "" : "another";
              }},
             {"de-staircasing", "stays to the bit", [=]() -> std::string {
                  return destaircase(heights()).heights.samples == heights().samples ? "" : "moved";
              }}}};
}

HardCase size_case() {
    return {"tiny and odd sizes",
            "Maps of 1 x 1, 1 x 9, 9 x 1, 2 x 3 and 7 x 5 texels, smaller than the kernels.",
            "reads beyond the border",
            {{"bump", "unit under every kernel, border and arithmetic; a single texel is flat",
              []() -> std::string {
                  for (const auto& [width, height] : {std::pair(1, 9), {9, 1}, {2, 3}, {7, 5}}) {
                      const std::string found = in_every_way(rough(width, height), 16.0, not_unit);
                      if (!found.empty()) return fmt::format("{} x {}: {}", width, height, found);
                  }
                  return in_every_way(rough(1, 1), 16.0, not_flat);
              }},
             {"choice of kernel, de-staircasing", "done all the same", []() -> std::string {
                  for (const auto& [width, height] :
                       {std::pair(1, 1), {1, 9}, {9, 1}, {2, 3}, {7, 5}}) {
                      const Image map = rough(width, height);
                      if (choose_kernel(map, {}).reason.empty()) return "no reason";
                      if (destaircase(map, {.wrap = {}, .step = 0.01}).heights.sample_count() !=
                          map.sample_count())
                          return "of another size";
                  }
                  return "";
              }}}};
}

/// The greatest error of any texel: on the border, and inside.
std::string worse_at_the_seam() {
    const BumpField field =
        make_bump_field({"", FieldShape::waves, 24.0, 0.5, FieldCoding::float32, 0.0, 3}, 96, 64);
    BumpOptions options = field.options;
    options.kernel = Kernel::central5;
    options.arithmetic = Arithmetic::float64;
    Report report;
    const Image normals = normals_from_height(field.heights, options, report);
    const std::span<const float> n = normals.as<float>();
    double seam = 0.0;
    double inside = 0.0;
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 96; ++x) {
            const auto i = static_cast<std::size_t>(y * 96 + x);
            const double error =
                degrees_between(glm::dvec3(n[3 * i], n[3 * i + 1], n[3 * i + 2]), field.normals[i]);
            const bool is_seam = x == 0 || y == 0 || x == 95 || y == 63;
            (is_seam ? seam : inside) = std::max(is_seam ? seam : inside, error);
        }
    }
    return seam <= inside ? "" : fmt::format("{} degrees at the seam, {} inside", seam, inside);
}

HardCase tiling_case() {
    return {"height map that tiles",
            "Waves that go a whole number of times into the map.",
            "maketx is 11 to 20 degrees wrong at the edges",
            {{"bump, repeat", "no worse at the seam than inside", worse_at_the_seam}}};
}

HardCase staircase_case() {
    return {
        "8-bit staircase",
        "A gentle slope in 25 codes of 8 bits: treads of many texels, and risers.",
        "Sobel's kernel is 20 degrees wrong there, measured",
        {{"choice of kernel",
          "a Gaussian over 21 texels or more, 10 times truer than Sobel's kernel",
          []() -> std::string {
              const BumpField field = make_bump_field(
                  {"", FieldShape::waves, 120.0, 0.3, FieldCoding::bits8_dim, 0.0, 10}, 256, 256);
              BumpOptions options = field.options;
              options.kernel = Kernel::sobel3;
              Report report;
              const double sobel =
                  field_error(normals_from_height(field.heights, options, report), field).rms;
              const KernelChoice choice = choose_kernel(field.heights, options);
              options.kernel = choice.kernel;
              options.gaussian_radius = choice.gaussian_radius;
              const double chosen =
                  field_error(normals_from_height(field.heights, options, report), field).rms;
              if (choice.kernel != Kernel::gaussian || choice.gaussian_radius < 10)
                  return choice.reason;
              return chosen < 0.1 * sobel ? "" : fmt::format("{} and {}", chosen, sobel);
          }},
         {"de-staircasing", "no height moves by more than half a step", []() -> std::string {
              const BumpField field = make_bump_field(
                  {"", FieldShape::waves, 120.0, 0.3, FieldCoding::bits8_dim, 0.0, 10}, 128, 128);
              const Image stored = to_float(field.heights);
              const Destaircased smooth = destaircase(field.heights);
              for (std::size_t i = 0; i < stored.sample_count(); ++i) {
                  if (std::abs(stored.as<float>()[i] - smooth.heights.as<float>()[i]) >
                      0.5F / 255.0F)
                      return fmt::format("texel {}", i);
              }
              return "";
          }}}};
}

HardCase hole_case() {
    return {
        "heights that are not finite",
        "A plane with one NaN and one infinite texel.",
        "one texel that spoils a whole map",
        {{"bump",
          "unit under every kernel; read as the mean around them; reported: 2 x non-finite "
          "height",
          [] {
              Image plane = heights_of(16, 16, [](int x, int y) { return 0.01 * x + 0.02 * y; });
              plane.as<float>()[7 * 16 + 7] = std::numeric_limits<float>::quiet_NaN();
              plane.as<float>()[3 * 16 + 11] = std::numeric_limits<float>::infinity();
              Report report;
              normals_from_height(plane, {}, report);
              if (report.findings().size() != 1 || report.findings()[0].count != 2)
                  return std::string("not counted twice");
              return in_every_way(plane, 16.0, not_unit);
          }},
         {"de-staircasing", "stay as they are; their neighbours stay finite", []() -> std::string {
              Image steps = heights_of(
                  16, 16, [](int x, int y) { return std::round(0.2 * x + 0.1 * y) / 255.0; });
              steps.as<float>()[50] = std::numeric_limits<float>::quiet_NaN();
              const Image smooth = destaircase(steps).heights;
              for (std::size_t i = 0; i < 256; ++i) {
                  if (std::isfinite(smooth.as<float>()[i]) == (i == 50))
                      return fmt::format("texel {}", i);
              }
              return "";
          }}}};
}

HardCase texel_case() {
    return {"texels that are not square",
            "A plane of slope 1 to the right and 2 upwards, in texels of 0.5 x 0.25.",
            "slopes scaled alike in x and y",
            {{"bump", "its slopes, each by its own axis, within 1e-6", [] {
                  const Image plane =
                      heights_of(12, 12, [](int x, int y) { return 0.5 * x - 0.5 * y; });
                  BumpOptions options{.wrap = Wrap::clamp, .strength = 1.0};
                  options.texel = {0.5, 0.25};
                  Report report;
                  const Image slopes = slopes_from_height(plane, options, report);
                  for (std::size_t i = 0; i < 144; ++i) {
                      if (!(std::abs(slopes.as<float>()[2 * i] - 1.0F) <= 1e-6F &&
                            std::abs(slopes.as<float>()[2 * i + 1] - 2.0F) <= 1e-6F))
                          return fmt::format("texel {}", i);
                  }
                  return std::string();
              }}}};
}

HardCase strength_case() {
    return {"huge and tiny strength",
            "Noise at strengths of 1e30, -1e30, 1e-30 and 0.",
            "slopes whose squares overflow",
            {{"bump", "unit under every kernel, border and arithmetic; at 0 exactly flat",
              [] {
                  for (const double strength : {1e30, -1e30, 1e-30}) {
                      const std::string found = in_every_way(rough(9, 8), strength, not_unit);
                      if (!found.empty()) return fmt::format("{}: {}", strength, found);
                  }
                  return in_every_way(rough(9, 8), 0.0, not_flat);
              }},
             {"choice of kernel", "done all the same", []() -> std::string {
                  for (const double strength : {1e30, -1e30, 1e-30, 0.0}) {
                      BumpOptions options;
                      options.strength = strength;
                      if (!std::isfinite(choose_kernel(rough(32, 32), options).rms_degrees))
                          return fmt::format("{}", strength);
                  }
                  return "";
              }}}};
}

}  // namespace

std::vector<HardCase> image_cases() {
    return {constant_case(), size_case(),  tiling_case(),  staircase_case(),
            hole_case(),     texel_case(), strength_case()};
}

}  // namespace relief::test
