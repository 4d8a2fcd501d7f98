// SPDX-License-Identifier: Apache-2.0
// Image files that are damaged, or whose numbers are not plain heights. The files are made here,
// byte by byte where no writer of ours makes their kind.
#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "hard_cases/map_cases.h"
#include "io/png/png_format.h"
#include "relief/mesh/bump_file.h"
#include "relief/mesh/error.h"
#include "relief/mesh/height_map.h"
#include "support/height_fields.h"
#include "support/shared_data.h"

namespace relief::test {
namespace {

namespace fs = std::filesystem;

std::string contents(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

void write_bytes(const fs::path& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
}

/// "height 0 is 0.2, not 0.4", or nothing.
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
            "Slopes of 1e5 and -1e5, which half floats have no number for, one of 65519, which "
            "rounds to their largest, and an infinite one.",
            "infinities in filtered slope maps",
            {{"write, half EXR",
              "65504 with its sign, counted; infinity stays; reported: 2 x "
              "texel beyond half's range",
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

/// Two texels by their places in a palette of black, (51, 102, 153) and white.
std::string palette_png() {
    std::string header;
    append_big32(header, 2);
    append_big32(header, 1);
    header += std::string("\x08\x03\x00\x00\x00", 5);
    // No filter, then the places 1 and 2, stored as they are between zlib's header and checksum.
    const std::string stored("\x78\x01\x01\x03\0\xfc\xff\0\x01\x02\0\x07\0\x04", 14);
    std::string file = "\x89PNG\r\n\x1a\n";
    append_chunk(file, "IHDR", header);
    append_chunk(file, "PLTE", std::string("\0\0\0\x33\x66\x99\xff\xff\xff", 9));
    append_chunk(file, "IDAT", stored);
    append_chunk(file, "IEND", "");
    return file;
}

/// Texels of 8-bit cyan, magenta, yellow and black, uncompressed.
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
    tag(256, 4, 1, width);      // Width
    tag(257, 4, 1, 1);          // and height.
    tag(258, 3, 4, bits_at);    // Bits of the samples.
    tag(259, 3, 1, 1);          // Uncompressed,
    tag(262, 3, 1, 5);          // separated: CMYK.
    tag(273, 4, 1, texels_at);  // The one strip:
    tag(277, 3, 1, 4);          // samples a texel,
    tag(278, 4, 1, 1);          // rows,
    tag(279, 4, 1, static_cast<std::uint32_t>(texels.size()));
    put(0, 4);
    for (int i = 0; i < 4; ++i)
        put(8, 2);
    return file + texels;
}

HardCase kind_case() {
    return {"colours by palette and in CMYK",
            "A PNG with a palette, and a TIFF of cyan, magenta, yellow and black.",
            "indices and inks taken for heights",
            {{"heights, palette", "the mean of the colour that is meant",
              [] {
                  const TemporaryDirectory folder;
                  write_bytes(folder / "p.png", palette_png());
                  return unexpected_heights(
                      height_field(read_image(folder / "p.png", ImageUse::data)), {0.4F, 1.0F});
              }},
             {"heights, CMYK", "of the colours as RGB: no ink is white, black is black", [] {
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
            "A grey plane with alpha, black and transparent on the right.",
            "cliffs at the border of what is shown",
            {{"bump",
              "flat where it is transparent; beside it no slope above the plane's, where "
              "black would be a cliff of 8",
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
    return {"image files cut short",
            "Noise as PNG, TIFF and EXR, cut at each of 40 places.",
            "half pictures read as whole ones",
            {{"bump", "an error that names the file, and no output", []() -> std::string {
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
                      const std::string whole = contents(folder / name);
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
