// SPDX-License-Identifier: Apache-2.0
// Codes of whole numbers are read back as the library reads them; those that it does not have (10
// bits, half, octahedral maps) are here. Tests: tests/accuracy/normal_codes_test.cpp.
#include "storage/normal_codes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>

#include "octahedral_code.h"
#include "parallel.h"
#include "relief/mesh/analytic_heights.h"
#include "relief/mesh/direction_error.h"
#include "relief/mesh/error.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/normal_map_operations.h"

namespace relief {
namespace {

constexpr std::size_t grain = 4096;  ///< Texels that are worth a thread's while.

std::size_t texels_of(const Image& image) {
    return static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
}

glm::dvec3 normal_at(std::span<const float> samples, std::size_t texel) {
    return {samples[3 * texel], samples[3 * texel + 1], samples[3 * texel + 2]};
}

/// A map of codes made texel by texel: code(normal, where to write `channels` samples).
template <typename Sample, typename Code>
Image coded(const Image& normals, int channels, Code code) {
    Image codes =
        make_image(normals.width, normals.height, channels, 8 * sizeof(Sample), ColorSpace::data);
    const std::span<const float> from = normals.as<float>();
    const std::span<Sample> to = codes.as<Sample>();
    parallel_for(texels_of(normals), grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            code(normal_at(from, i), &to[i * static_cast<std::size_t>(channels)]);
    });
    return codes;
}

/// Normals read texel by texel: direction(samples) of any length.
template <typename Sample, typename Direction>
Image decoded(const Image& codes, Direction direction) {
    Image normals = make_image(codes.width, codes.height, 3, 32, ColorSpace::data);
    const std::span<const Sample> from = codes.as<Sample>();
    const std::span<float> to = normals.as<float>();
    const auto channels = static_cast<std::size_t>(codes.channels);
    parallel_for(texels_of(codes), grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const glm::dvec3 unit = glm::normalize(direction(&from[i * channels]));
            for (int axis = 0; axis < 3; ++axis)
                to[3 * i + static_cast<std::size_t>(axis)] = static_cast<float>(unit[axis]);
        }
    });
    return normals;
}

std::string word_of(Dither dither) {
    switch (dither) {
        case Dither::ordered:
            return "ordered";
        case Dither::blue_noise:
            return "blue-noise";
        default:
            return "none";
    }
}

/// \param zero  the code of zero in maps of whole numbers; "exact" in layouts that hold 0 exactly
NormalCode named(const std::string& layout, const std::string& bits, const std::string& rounding,
                 double bytes, const std::string& zero = "exact") {
    NormalCode code;
    code.name = layout + " " + bits;
    if (rounding != "nearest") code.name += ", " + rounding;
    code.choices = {{"layout", layout}, {"bits", bits}, {"rounding", rounding}, {"zero", zero}};
    code.bytes = bytes;
    return code;
}

std::string rounding_of(const NormalMapFormat& format) {
    return format.dither == Dither::none ? "nearest" : word_of(format.dither);
}

std::string zero_of(FlatCode flat, int bits) {
    const double largest = bits == 8 ? 255.0 : 65535.0;
    return fmt::format("{}", flat == FlatCode::middle ? (largest + 1.0) / 2.0 : largest / 2.0);
}

/// As normal maps hold them, read by a decoder that takes this code for zero. glTF and engines take
/// FlatCode::half.
NormalCode as_map(const NormalMapFormat& format, FlatCode decoder) {
    const bool is_float = format.bits == 32;
    NormalCode code =
        named("xyz", is_float ? "float" : fmt::format("{} bit", format.bits), rounding_of(format),
              3.0 * format.bits / 8.0, is_float ? "exact" : zero_of(format.flat, format.bits));
    if (format.flat == FlatCode::middle && !is_float) {
        code.name += ", zero at " + zero_of(format.flat, format.bits);
        if (decoder == FlatCode::half) code.name += ", read as glTF does";
    } else if (decoder == FlatCode::middle) {
        code.name += ", read with zero at " + zero_of(decoder, format.bits);
    }
    if (decoder != format.flat)
        code.choices.back().second += ", read as " + zero_of(decoder, format.bits);
    code.encode = [format](const Image& normals) {
        Report report;
        return encode_normal_map(normals, format, report);
    };
    code.decode = [format, decoder](const Image& codes) {
        Report report;
        return decode_normal_map(codes, format.green, decoder, report);
    };
    return code;
}

/// Written and read as glTF and engines do.
NormalCode as_map(const NormalMapFormat& format) {
    return as_map(format, FlatCode::half);
}

template <typename Sample>
Image without_z(const Image& map) {
    Image two = make_image(map.width, map.height, 2, map.bits(), ColorSpace::data);
    for (std::size_t i = 0; i < texels_of(map); ++i) {
        two.as<Sample>()[2 * i] = map.as<Sample>()[3 * i];
        two.as<Sample>()[2 * i + 1] = map.as<Sample>()[3 * i + 1];
    }
    return two;
}

/// x and y of such maps; z is what makes them unit.
NormalCode as_xy_map(const NormalMapFormat& format) {
    NormalCode code = named("xy", fmt::format("{} bit", format.bits), rounding_of(format),
                            2.0 * format.bits / 8.0, zero_of(format.flat, format.bits));
    code.encode = [format](const Image& normals) {
        Report report;
        const Image map = encode_normal_map(normals, format, report);
        return format.bits == 8 ? without_z<std::uint8_t>(map) : without_z<std::uint16_t>(map);
    };
    code.decode = [format](const Image& codes) {
        Report report;
        return decode_xy_map(codes, {}, format.green, format.flat, report);
    };
    return code;
}

/// GL_INT_2_10_10_10_REV: a code c stands for c / 511.
NormalCode as_ten_bits() {
    constexpr int largest = 511;
    NormalCode code = named("xyz", "10 bit", "nearest", 4.0);
    code.encode = [](const Image& normals) {
        return coded<std::uint16_t>(normals, 3, [](const glm::dvec3& n, std::uint16_t* to) {
            for (int axis = 0; axis < 3; ++axis)
                to[axis] =
                    static_cast<std::uint16_t>(rounded_to_int(n[axis] * largest) + largest + 1);
        });
    };
    code.decode = [](const Image& codes) {
        return decoded<std::uint16_t>(codes, [](const std::uint16_t* from) {
            return glm::dvec3(from[0], from[1], from[2]) - (largest + 1.0);
        });
    };
    return code;
}

/// Float maps, (n + 1) / 2, rounded to half floats: what `relief-bake --half` writes.
NormalCode as_halves() {
    NormalCode code = named("xyz", "half", "nearest", 6.0);
    code.encode = [](const Image& normals) {
        Report report;
        const Image map = encode_normal_map(normals, {.bits = 32}, report);
        return coded<std::uint16_t>(map, 3, [](const glm::dvec3& sample, std::uint16_t* to) {
            for (int axis = 0; axis < 3; ++axis)
                to[axis] = glm::packHalf1x16(static_cast<float>(sample[axis]));
        });
    };
    code.decode = [](const Image& codes) {
        return decoded<std::uint16_t>(codes, [](const std::uint16_t* from) {
            const glm::dvec3 sample(glm::unpackHalf1x16(from[0]), glm::unpackHalf1x16(from[1]),
                                    glm::unpackHalf1x16(from[2]));
            return 2.0 * sample - 1.0;
        });
    };
    return code;
}

OctahedralCode octahedral_code(const glm::dvec3& normal, int largest, bool best) {
    const glm::dvec2 place = octahedral_place(normal, largest);
    if (!best) return nearest_code(place, largest, -1);
    return best_code(place, largest, -1, [&](OctahedralCode candidate) {
        const glm::dvec3 found = octahedral_direction(candidate, largest);
        return glm::length(glm::cross(found, normal)) / glm::length(found);
    });
}

NormalCode as_octahedral(int bits, bool best) {
    const int largest = (1 << (bits - 1)) - 1;
    // What two codes take in formats that there are: 16, 24 or 32 bits.
    NormalCode code = named("octahedral", fmt::format("2 x {} bit", bits),
                            best ? "best" : "nearest", std::ceil(2.0 * bits / 8.0));
    code.encode = [largest, best](const Image& normals) {
        return coded<std::uint16_t>(
            normals, 2, [largest, best](const glm::dvec3& n, std::uint16_t* to) {
                const OctahedralCode found = octahedral_code(n, largest, best);
                to[0] = static_cast<std::uint16_t>(found.x + largest);
                to[1] = static_cast<std::uint16_t>(found.y + largest);
            });
    };
    code.decode = [largest](const Image& codes) {
        return decoded<std::uint16_t>(codes, [largest](const std::uint16_t* from) {
            return octahedral_direction({from[0] - largest, from[1] - largest}, largest);
        });
    };
    return code;
}

}  // namespace

std::vector<NormalCode> normal_codes() {
    const auto rounded = [](int bits, Dither dither) {
        return NormalMapFormat{bits, Green::up, FlatCode::half, dither};
    };
    const auto zero_is_a_code = [](int bits) {
        return NormalMapFormat{bits, Green::up, FlatCode::middle, Dither::none};
    };
    std::vector<NormalCode> codes = {as_map(rounded(8, Dither::none)),
                                     as_map(rounded(8, Dither::none), FlatCode::middle),
                                     as_map(zero_is_a_code(8), FlatCode::middle),
                                     as_map(zero_is_a_code(8)),
                                     as_map(rounded(8, Dither::ordered)),
                                     as_map(rounded(8, Dither::blue_noise)),
                                     as_ten_bits(),
                                     as_map(rounded(16, Dither::none)),
                                     as_map(zero_is_a_code(16), FlatCode::middle),
                                     as_map(zero_is_a_code(16)),
                                     as_map(rounded(16, Dither::blue_noise)),
                                     as_halves(),
                                     as_map(rounded(32, Dither::none)),
                                     as_xy_map(rounded(8, Dither::none)),
                                     as_xy_map(rounded(8, Dither::blue_noise)),
                                     as_xy_map(rounded(16, Dither::none))};
    for (const int bits : {8, 10, 12, 16}) {
        for (const bool best : {false, true})
            codes.push_back(as_octahedral(bits, best));
    }
    return codes;
}

Image image_of_normals(std::span<const glm::dvec3> directions, int width) {
    const auto row = static_cast<std::size_t>(width);
    if (width <= 0 || directions.empty() || directions.size() % row != 0) {
        throw InvalidInput(
            fmt::format("{} directions do not fill rows of {} texels", directions.size(), width));
    }
    Image image =
        make_image(width, static_cast<int>(directions.size() / row), 3, 32, ColorSpace::data);
    for (std::size_t i = 0; i < image.sample_count(); ++i)
        image.as<float>()[i] = static_cast<float>(directions[i / 3][static_cast<int>(i % 3)]);
    return image;
}

std::vector<glm::dvec3> smooth_surface(int side) {
    return wave_heights(side, side, tiling_waves(side, side, 5, side / 2.0, 0.2, 41)).normals;
}

AngleDistribution patch_errors(const Image& normals, const Image& truth, int block) {
    const int columns = truth.width / block;
    const auto patches = static_cast<std::size_t>(columns * (truth.height / block));
    const auto sums_of = [&](const Image& map) {
        std::vector<glm::dvec3> sums(patches, glm::dvec3(0.0));
        for (int y = 0; y < map.height; ++y) {
            for (int x = 0; x < map.width; ++x) {
                sums[static_cast<std::size_t>(y / block * columns + x / block)] +=
                    normal_at(map.as<float>(), static_cast<std::size_t>(y * map.width + x));
            }
        }
        return sums;
    };
    const std::vector<glm::dvec3> found = sums_of(normals);
    const std::vector<glm::dvec3> expected = sums_of(truth);
    std::vector<float> degrees;
    for (std::size_t i = 0; i < patches; ++i)
        degrees.push_back(static_cast<float>(degrees_between(found[i], expected[i])));
    return angle_distribution(std::move(degrees));
}

}  // namespace relief
