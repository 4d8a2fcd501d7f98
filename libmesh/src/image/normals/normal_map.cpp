// SPDX-License-Identifier: Apache-2.0
// Unit normals in tangent space (y up) to stored codes and back, under either meaning of zero; see
// normal_map.h. Directions of any length are normalised in double before they are rounded, halves
// away from zero, which keeps n and -n mirrored. What is no direction is flat, and counted.
// Tests: tests/mesh/image/normals/normal_map_test.cpp.
#include "relief/mesh/normal_map.h"

#include <fmt/format.h>

#include <limits>

#include "image/normals/dither_tile.h"
#include "image/normals/normal_coding.h"
#include "image/texel_loops.h"
#include "relief/mesh/error.h"

namespace relief {
namespace {

/// Unit normals as codes: to_codes(column, direction, samples) for each texel of a row.
template <typename Sample, typename ToCodes>
void encode_row(const float* normals, int width, std::size_t first_texel, double green,
                Sample* samples, Report& found, const ToCodes& to_codes) {
    for (std::size_t x = 0; x < static_cast<std::size_t>(width); ++x) {
        const float* normal = normals + 3 * x;
        Direction direction{normal[0], normal[1] * green, normal[2]};
        if (!make_unit(direction))
            found.add("normal without direction", "texel", first_texel + x, "stored as flat");
        to_codes(x, direction, samples + 3 * x);
    }
}

/// The same for a row in its place, which decides how it is dithered.
template <typename Sample>
void encode_row(const float* normals, int width, int row, const NormalMapFormat& format,
                Sample* samples, Report& found) {
    const NormalCoding<Sample> coding{format.flat};
    const double green = format.green == Green::up ? 1.0 : -1.0;
    const std::size_t first_texel = static_cast<std::size_t>(row) * static_cast<std::size_t>(width);
    if (format.dither == Dither::none) {
        encode_row(normals, width, first_texel, green, samples, found,
                   [&](std::size_t, const Direction& direction, Sample* codes) {
                       codes[0] = coding.encoded(direction.x);
                       codes[1] = coding.encoded(direction.y);
                       codes[2] = coding.encoded(direction.z);
                   });
    } else {
        const DitherRow thresholds(format.dither, row);
        encode_row(normals, width, first_texel, green, samples, found,
                   [&](std::size_t x, const Direction& direction, Sample* codes) {
                       codes[0] = coding.dithered(direction.x, thresholds.at(x, 0));
                       codes[1] = coding.dithered(direction.y, thresholds.at(x, 1));
                       codes[2] = coding.dithered(direction.z, thresholds.at(x, 2));
                   });
    }
}

template <typename Sample>
void encode(const Image& normals, const NormalMapFormat& format, Image& result, Report& report) {
    const float* const from = normals.as<float>().data();
    Sample* const to = result.as<Sample>().data();
    const auto row_size = static_cast<std::size_t>(normals.width) * 3;
    for_each_row(normals.width, normals.height, report, [&](std::size_t row, Report& found) {
        encode_row(from + row * row_size, normals.width, static_cast<int>(row), format,
                   to + row * row_size, found);
    });
}

template <typename Sample>
void decode(const Image& map, Green green, FlatCode flat, std::span<float> normals,
            Report& report) {
    const std::span<const Sample> samples = map.as<Sample>();
    const auto channels = static_cast<std::size_t>(map.channels);
    const NormalCoding<Sample> coding{flat};
    const double up = green == Green::up ? 1.0 : -1.0;
    for_each_texel(normals.size() / 3, report, [&](std::size_t texel, Report& found) {
        const Sample* sample = &samples[texel * channels];
        Direction direction{coding.decoded(sample[0]), coding.decoded(sample[1]) * up,
                            coding.decoded(sample[2])};
        if (!make_unit(direction))
            found.add("normal without direction", "texel", texel, "read as flat");
        store(direction, &normals[texel * 3]);
    });
}

/// Whether the lower of the two codes around zero is the commoner among texels that are flat in
/// both x and y, to within those two codes.
template <typename Code>
FlatCode commoner_zero(const Image& map) {
    constexpr Code upper = std::numeric_limits<Code>::max() / 2 + 1;
    constexpr Code lower = upper - 1;
    const std::span<const Code> samples = map.as<Code>();
    const auto channels = static_cast<std::size_t>(map.channels);
    const auto flat = [](Code code) { return code == lower || code == upper; };
    std::size_t lower_count = 0;
    std::size_t upper_count = 0;
    for (std::size_t first = 0; first + 2 < samples.size(); first += channels) {
        if (!flat(samples[first]) || !flat(samples[first + 1])) continue;
        for (std::size_t channel = 0; channel < 2; ++channel)
            ++(samples[first + channel] == lower ? lower_count : upper_count);
    }
    return lower_count > upper_count ? FlatCode::half : FlatCode::middle;
}

std::string zero_code(const NormalMapFormat& format) {
    if (format.bits == 32) return "0.5";
    const double largest = format.bits == 8 ? 255.0 : 65535.0;
    return fmt::format("{}",
                       format.flat == FlatCode::middle ? (largest + 1.0) / 2.0 : largest / 2.0);
}

void check_map(const Image& map) {
    if (map.empty()) throw InvalidInput("an empty image holds no normals");
    if (map.channels < 3) {
        throw InvalidInput(fmt::format("a normal map has 3 or 4 channels, not {}", map.channels));
    }
}

}  // namespace

Image encode_normal_map(const Image& normals, const NormalMapFormat& format, Report& report) {
    check_floats(normals, 3, "normals");
    Image result = make_image(normals.width, normals.height, 3, format.bits, ColorSpace::data);
    switch (format.bits) {
        case 8:
            encode<std::uint8_t>(normals, format, result, report);
            break;
        case 16:
            encode<std::uint16_t>(normals, format, result, report);
            break;
        default:
            encode<float>(normals, format, result, report);
            break;
    }
    return result;
}

Image decode_normal_map(const Image& map, Green green, FlatCode flat, Report& report) {
    check_map(map);
    Image result = make_image(map.width, map.height, 3, 32, ColorSpace::data);
    const std::span<float> normals = result.as<float>();
    switch (map.bits()) {
        case 8:
            decode<std::uint8_t>(map, green, flat, normals, report);
            break;
        case 16:
            decode<std::uint16_t>(map, green, flat, normals, report);
            break;
        default:
            decode<float>(map, green, flat, normals, report);
            break;
    }
    return result;
}

FlatCode detect_flat_code(const Image& map, const std::map<std::string, std::string>& metadata) {
    check_map(map);
    if (const auto said = metadata.find("relief:flat"); said != metadata.end()) {
        if (said->second == "127.5" || said->second == "32767.5") return FlatCode::half;
        if (said->second == "128" || said->second == "32768") return FlatCode::middle;
    }
    if (map.bits() == 8) return commoner_zero<std::uint8_t>(map);
    if (map.bits() == 16) return commoner_zero<std::uint16_t>(map);
    return FlatCode::middle;
}

std::map<std::string, std::string> normal_map_metadata(const NormalMapFormat& format) {
    return {{"relief:content", "normal map, tangent space"},
            {"relief:green", format.green == Green::up ? "up" : "down"},
            {"relief:flat", zero_code(format)}};
}

}  // namespace relief
