// SPDX-License-Identifier: Apache-2.0
// Hard cases of height maps: constant, tiny, stepped and steep heights, holes, and damaged files.
// The test writes the files byte by byte if relief has no writer for their kind.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <span>

#include "hard_cases/hard_cases.h"
#include "io/png/png_format.h"
#include "relief/accuracy/ground_truth.h"
#include "relief/mesh/bump_file.h"
#include "relief/mesh/height_map.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/report.h"
#include "support/images.h"
#include "support/shared_data.h"

namespace relief::test {
using namespace relief::accuracy;
using namespace relief::detail;

namespace {

constexpr std::array all_kernels = {
    Kernel::forward, Kernel::central3, Kernel::prewitt3, Kernel::sobel3,   Kernel::scharr3,
    Kernel::sobel5,  Kernel::scharr5,  Kernel::central5, Kernel::central7, Kernel::gaussian};
constexpr std::array both = {Arithmetic::float32, Arithmetic::float64};

/// Returns the first problem over every kernel, border and arithmetic.
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
            "All heights are 0.3, which is not a float.",
            "flat maps that rounding makes uneven",
            {{"bump", "exactly (0,0,1) with every kernel, border mode and precision",
              [=] { return in_every_way(heights(), 16.0, not_flat); }},
             {"bump, 8 bit", "the flat code, which decodes to exactly (0,0,1)",
              [=] {
                  Report report;
                  const Image codes = normal_map_from_height(heights(), {}, {.bits = 8}, report);
                  return not_flat(decode_normal_map(codes, Green::up, FlatCode::half, report,
                                                    FlatTexels::exact));
              }},
             {"choice of kernel", "the fastest, because all are exact",
              [=]() -> std::string {
                  return choose_kernel(heights(), {}).kernel == Kernel::central3 ? "" : "another";
              }},
             {"de-staircasing", "unchanged bit for bit", [=]() -> std::string {
                  return destaircase(heights()).heights.samples == heights().samples ? "" : "moved";
              }}}};
}

HardCase size_case() {
    return {"tiny and odd sizes",
            "Maps of 1 x 1, 1 x 9, 9 x 1, 2 x 3 and 7 x 5 texels, which are smaller "
            "than the kernels.",
            "reads outside of the image",
            {{"bump", "unit with every kernel, border mode and precision; a single texel is flat",
              []() -> std::string {
                  for (const auto& [width, height] : {std::pair(1, 9), {9, 1}, {2, 3}, {7, 5}}) {
                      const std::string found = in_every_way(rough(width, height), 16.0, not_unit);
                      if (!found.empty()) return fmt::format("{} x {}: {}", width, height, found);
                  }
                  return in_every_way(rough(1, 1), 16.0, not_flat);
              }},
             {"choice of kernel, de-staircasing", "completes", []() -> std::string {
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

/// Compares the largest errors of the texels on the border and inside.
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
    return {
        "height map that tiles",
        "Waves whose periods divide the size of the map.",
        "maketx has errors of 11 to 20 degrees at the edges",
        {{"bump, repeat", "the error at the seam is not larger than inside", worse_at_the_seam}}};
}

HardCase staircase_case() {
    return {
        "8-bit staircase",
        "A gentle slope that is quantized to 25 codes of 8 bits: wide steps.",
        "Sobel's kernel has an error of 20 degrees there, measured",
        {{"choice of kernel",
          "a Gaussian over 21 texels or more, with a tenth of the error of Sobel's kernel",
          []() -> std::string {
              const BumpField field = make_bump_field(
                  {"", FieldShape::waves, 120.0, 0.3, FieldCoding::bits8_dim, 0.0, 10}, 256, 256);
              BumpOptions options = field.options;
              options.kernel = Kernel::sobel3;
              Report report;
              const double sobel =
                  normal_error(normals_from_height(field.heights, options, report), field).rms;
              const KernelChoice choice = choose_kernel(field.heights, options);
              options.kernel = choice.kernel;
              options.gaussian_radius = choice.gaussian_radius;
              const double chosen =
                  normal_error(normals_from_height(field.heights, options, report), field).rms;
              if (choice.kernel != Kernel::gaussian || choice.gaussian_radius < 10)
                  return choice.reason;
              return chosen < 0.1 * sobel ? "" : fmt::format("{} and {}", chosen, sobel);
          }},
         {"de-staircasing", "no height changes by more than half a step", []() -> std::string {
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
    return {"heights that are not finite",
            "A plane with one NaN and one infinite texel.",
            "one texel that makes a whole map invalid",
            {{"bump",
              "unit with every kernel; the mean of the neighbors replaces them; "
              "reported: 2 x non-finite height",
              [] {
                  Image plane =
                      heights_of(16, 16, [](int x, int y) { return 0.01 * x + 0.02 * y; });
                  plane.as<float>()[7 * 16 + 7] = std::numeric_limits<float>::quiet_NaN();
                  plane.as<float>()[3 * 16 + 11] = std::numeric_limits<float>::infinity();
                  Report report;
                  normals_from_height(plane, {}, report);
                  if (report.findings().size() != 1 || report.findings()[0].count != 2)
                      return std::string("not counted twice");
                  return in_every_way(plane, 16.0, not_unit);
              }},
             {"de-staircasing", "unchanged; their neighbors stay finite", []() -> std::string {
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
            "A plane with slopes 1 (right) and 2 (up), in texels of 0.5 x 0.25.",
            "the same scale for x and y",
            {{"bump", "the slopes within 1e-6, each with the texel size of its axis", [] {
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
            "squares of slopes overflow",
            {{"bump", "unit with every kernel, border mode and precision; exactly flat at 0",
              [] {
                  for (const double strength : {1e30, -1e30, 1e-30}) {
                      const std::string found = in_every_way(rough(9, 8), strength, not_unit);
                      if (!found.empty()) return fmt::format("{}: {}", strength, found);
                  }
                  return in_every_way(rough(9, 8), 0.0, not_flat);
              }},
             {"choice of kernel", "completes", []() -> std::string {
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

namespace {

namespace fs = std::filesystem;

void write_bytes(const fs::path& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
}

/// Returns a text such as "height 0 is 0.2, not 0.4", or an empty string.
std::string unexpected_heights(const Image& heights, const std::vector<float>& expected) {
    for (std::size_t i = 0; i < expected.size(); ++i) {
        const float height = heights.as<float>()[i];
        if (!(std::abs(height - expected[i]) <= 1e-6F))
            return fmt::format("height {} is {}, not {}", i, height, expected[i]);
    }
    return "";
}

HardCase half_case() {
    return {"slopes beyond half floats",
            "Slopes of 1e5 and -1e5, which are outside the range of half floats; "
            "65519, which rounds to their largest value; and infinity.",
            "infinities in filtered slope maps",
            {{"write, half EXR",
              "+-65504; infinity is unchanged; reported: 2 x texel beyond half's range",
              []() -> std::string {
                  const TemporaryDirectory folder;
                  constexpr float infinity = std::numeric_limits<float>::infinity();
                  Image image = make_image(4, 1, 1, 32, ColorSpace::data);
                  image.samples = std::vector<float>{1e5F, -1e5F, 65519.0F, infinity};
                  Report report;
                  write_image(folder / "s.exr", image, {}, {.half = true}, report);
                  const Image read = read_image(folder / "s.exr", ImageUse::data);
                  const std::vector<float> expected = {65504.0F, -65504.0F, 65504.0F, infinity};
                  for (std::size_t i = 0; i < 4; ++i) {
                      if (read.as<float>()[i] != expected[i])
                          return fmt::format("{}: {}", i, read.as<float>()[i]);
                  }
                  const std::size_t count = report.count("texel beyond half's range");
                  return count == 2 ? "" : fmt::format("{} reported", count);
              }}}};
}

/// A PNG with two texels, and a palette of black, (51, 102, 153) and white.
std::string palette_png() {
    std::string header;
    append_big32(header, 2);
    append_big32(header, 1);
    header += std::string("\x08\x03\x00\x00\x00", 5);
    // The row has filter type 0 and the indices 1 and 2, in a stored block between zlib's header
    // and checksum.
    const std::string stored("\x78\x01\x01\x03\0\xfc\xff\0\x01\x02\0\x07\0\x04", 14);
    std::string file = "\x89PNG\r\n\x1a\n";
    append_chunk(file, "IHDR", header);
    append_chunk(file, "PLTE", std::string("\0\0\0\x33\x66\x99\xff\xff\xff", 9));
    append_chunk(file, "IDAT", stored);
    append_chunk(file, "IEND", "");
    return file;
}

/// A TIFF with uncompressed texels of 8-bit cyan, magenta, yellow and black.
std::string cmyk_tiff(const std::string& texels) {
    std::string file = std::string("II*\0\x08\0\0\0", 8);
    const auto put = [&](std::uint32_t value, int bytes) {
        for (int i = 0; i < bytes; ++i)
            file += static_cast<char>(value >> 8 * i & 0xFFU);
    };
    const auto width = static_cast<std::uint32_t>(texels.size() / 4);
    constexpr std::uint32_t entries = 9;
    const std::uint32_t bits_at = 8 + 2 + entries * 12 + 4;
    const std::uint32_t texels_at = bits_at + 8;
    put(entries, 2);
    const auto tag = [&](std::uint32_t id, std::uint32_t type, std::uint32_t count,
                         std::uint32_t value) {
        put(id, 2);
        put(type, 2);
        put(count, 4);
        put(value, 4);
    };
    tag(256, 4, 1, width);      // Image width.
    tag(257, 4, 1, 1);          // Image height.
    tag(258, 3, 4, bits_at);    // Bits per sample.
    tag(259, 3, 1, 1);          // No compression.
    tag(262, 3, 1, 5);          // Separated colors (CMYK).
    tag(273, 4, 1, texels_at);  // Strip offset.
    tag(277, 3, 1, 4);          // Samples per texel.
    tag(278, 4, 1, 1);          // Rows per strip.
    tag(279, 4, 1, static_cast<std::uint32_t>(texels.size()));
    put(0, 4);
    for (int i = 0; i < 4; ++i)
        put(8, 2);
    return file + texels;
}

HardCase kind_case() {
    return {"palette and CMYK colors",
            "A PNG file with a palette, and a TIFF file in CMYK.",
            "indices and ink amounts that are read as heights",
            {{"heights, palette", "the mean of the channels of the palette color",
              [] {
                  const TemporaryDirectory folder;
                  write_bytes(folder / "p.png", palette_png());
                  return unexpected_heights(
                      height_field(read_image(folder / "p.png", ImageUse::data)), {0.4F, 1.0F});
              }},
             {"heights, CMYK", "those of the colors in RGB: no ink is white", [] {
                  const TemporaryDirectory folder;
                  write_bytes(folder / "c.tif",
                              cmyk_tiff(std::string("\0\0\0\0\0\0\0\xff\xff\0\0\0", 12)));
                  return unexpected_heights(
                      height_field(read_image(folder / "c.tif", ImageUse::data)),
                      {1.0F, 0.0F, 2.0F / 3.0F});
              }}}};
}

HardCase transparent_case() {
    return {"transparent texels",
            "A gray plane with alpha; the right half is black and transparent.",
            "steps at the border of the visible area",
            {{"bump",
              "flat where transparent; the slope at the border does not exceed the "
              "plane's (black would give 8)",
              []() -> std::string {
                  const TemporaryDirectory folder;
                  Image image = make_image(12, 5, 2, 32, ColorSpace::data);
                  for (std::size_t i = 0; i < 60; ++i) {
                      const bool shown = i % 12 < 9;
                      image.as<float>()[2 * i] = shown ? static_cast<float>(i % 12) : 0.0F;
                      image.as<float>()[2 * i + 1] = shown ? 1.0F : 0.0F;
                  }
                  write_image(folder / "h.exr", image);
                  BumpFileFormat format;
                  format.normals.bits = 32;
                  Report report;
                  write_bump_file(HeightMapFile(folder / "h.exr"),
                                  {Kernel::central3, Wrap::clamp, 1.0}, folder / "n.exr", format,
                                  report);
                  const Image map = read_image(folder / "n.exr", ImageUse::data);
                  for (std::size_t i = 0; i < 60; ++i) {
                      const float* const n = &map.as<float>()[3 * i];
                      const float slope = -(2 * n[0] - 1) / (2 * n[2] - 1);
                      const bool shown = i % 12 < 9;
                      if (shown ? !(slope >= 0.0F && slope <= 1.00001F) : slope != 0.0F)
                          return fmt::format("slope {} in column {}", slope, i % 12);
                  }
                  return report.empty() ? "" : "something was reported";
              }}}};
}

HardCase damaged_case() {
    return {"truncated image files",
            "Noise as PNG, TIFF and EXR, truncated at 40 positions.",
            "partial images that are read as complete ones",
            {{"bump", "an error with the name of the file, and no output", []() -> std::string {
                  const TemporaryDirectory folder;
                  for (const std::string name : {"h.png", "h.tif", "h.exr"}) {
                      Image noise = rough(40, 30);
                      if (name == "h.png") {
                          std::vector<std::uint16_t> codes;
                          for (const float height : noise.as<float>())
                              codes.push_back(static_cast<std::uint16_t>(height * 65535.0F));
                          noise.samples = std::move(codes);
                      }
                      write_image(folder / name, noise);
                      const std::string whole = read_bytes(folder / name);
                      for (std::size_t i = 0; i < 40; ++i) {
                          const std::size_t length = whole.size() * i / 40;
                          write_bytes(folder / name, whole.substr(0, length));
                          try {
                              Report report;
                              write_bump_file(HeightMapFile(folder / name), {}, folder / "n.png",
                                              {}, report);
                              return fmt::format("{} of {} bytes: read as whole", name, length);
                          } catch (const FileError& error) {
                              if (std::string(error.what()).find(name) == std::string::npos)
                                  return fmt::format("{}: {}", name, error.what());
                          }
                          if (fs::exists(folder / "n.png")) return name + ": left an output";
                      }
                  }
                  return "";
              }}}};
}

}  // namespace

std::vector<HardCase> image_file_cases() {
    return {half_case(), kind_case(), transparent_case(), damaged_case()};
}

}  // namespace relief::test
