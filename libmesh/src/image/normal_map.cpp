// SPDX-License-Identifier: Apache-2.0
// Encoding and decoding of unit normals in tangent space (y up) with either code for zero, and
// permutations of axes.
//
// Directions of any length are normalized in double precision before rounding. Ties round away from
// zero, so n and -n stay mirrored. An undefined direction becomes flat and is counted. A code is
// negated by subtracting it from twice the code of zero; only 0 of FlatCode::middle has no
// negative, and is counted. An invalid permutation throws.
#include "relief/mesh/normal_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "image/dither_tile.h"
#include "image/normal_bands.h"
#include "image/normal_coding.h"
#include "image/texel_loops.h"
#include "image/unit_vectors.h"
#include "relief/mesh/map_description.h"
#include "relief/mesh/report.h"

namespace relief {
using namespace relief::detail;

namespace {

/// Encodes a row of normals: to_codes(column, direction, samples) for each texel.
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

/// Encodes a row of normals; the index of the row determines its dithering.
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

/// \param first_row  the row of the map that the first row of `normals` is
template <typename Sample>
void encode(const ImageView& normals, const NormalMapFormat& format, int first_row,
            const MutableImageView& map, Report& report) {
    for_each_row(normals.width, normals.height, report, [&](std::size_t index, Report& found) {
        const int row = static_cast<int>(index);
        const auto encode_into = [&](Sample* threes) {
            encode_row(normals.row<float>(row), normals.width, first_row + row, format, threes,
                       found);
        };
        if (map.channels == 3) return encode_into(map.row<Sample>(row));
        const auto width = static_cast<std::size_t>(normals.width);
        std::vector<Sample> threes(3 * width + 1);
        encode_into(threes.data());
        spread_samples(threes.data(), width, map.channels, map.row<Sample>(row));
    });
}

/// Returns whether a texel has only codes next to zero, where zero lies between two codes: its
/// vector is then as short as the rounding error. With FlatCode::middle such a texel decodes to
/// exactly zero.
template <typename Sample>
bool has_no_direction(const Sample* sample, FlatCode flat) {
    if constexpr (std::is_same_v<Sample, float>) {
        return false;
    } else {
        constexpr Sample lower = std::numeric_limits<Sample>::max() / 2;
        return flat == FlatCode::half && std::all_of(sample, sample + 3, [](Sample code) {
                   return static_cast<Sample>(code - lower) <= 1;
               });
    }
}

/// Decodes texels of a map one by one or in groups.
template <typename Sample>
class NormalDecoder {
  public:
    NormalDecoder(int channels, Green green, FlatCode flat, const ExactFlat<Sample>& exact)
        : channels_(static_cast<std::size_t>(channels)),
          up_(green == Green::up ? 1.0 : -1.0),
          flat_(flat),
          decoded_(flat),
          exact_(exact) {}

    void decode_row(const Sample* samples, std::size_t width, std::size_t first_texel,
                    float* normals, Report& found) const {
        const UnitVectorFunctions functions = unit_vector_functions();
        VectorGroup group;
        group.z.fill(1.0);
        for (std::size_t first = 0; first < width; first += vectors_per_group) {
            const std::size_t count = std::min(vectors_per_group, width - first);
            for (std::size_t i = 0; i < count; ++i) {
                const Direction vector = vector_of(samples + (first + i) * channels_);
                group.x[i] = vector.x;
                group.y[i] = vector.y;
                group.z[i] = vector.z;
            }
            if (functions.make_units(group, count, normals + 3 * first)) continue;
            for (std::size_t i = 0; i < count; ++i) {
                Direction direction{group.x[i], group.y[i], group.z[i]};
                if (!make_unit(direction)) {
                    found.add("normal without direction", "texel", first_texel + first + i,
                              "read as flat");
                }
                store(direction, normals + 3 * (first + i));
            }
        }
    }

  private:
    [[nodiscard]] Direction vector_of(const Sample* sample) const {
        if (has_no_direction(sample, flat_)) return {0.0, 0.0, 0.0};
        const double z = decoded_(sample[2]);
        if (exact_.is_flat(sample[0], sample[1])) return {0.0, 0.0, z};
        return {decoded_(sample[0]), decoded_(sample[1]) * up_, z};
    }

    std::size_t channels_;
    double up_;
    FlatCode flat_;
    SampleDecoder<Sample> decoded_;
    const ExactFlat<Sample>& exact_;
};

template <typename Sample>
void decode(const ImageView& map, Green green, FlatCode flat, const ExactFlat<Sample>& exact,
            const MutableImageView& normals, Report& report) {
    const auto width = static_cast<std::size_t>(map.width);
    const NormalDecoder<Sample> decoder(map.channels, green, flat, exact);
    for_each_row(map.width, map.height, report, [&](std::size_t row, Report& found) {
        decoder.decode_row(map.row<Sample>(static_cast<int>(row)), width, row * width,
                           normals.row<float>(static_cast<int>(row)), found);
    });
}

/// Counts the texels with each pair of the two codes around zero, lower first, x before y.
template <typename Code>
void count_pairs_around_zero(const ImageView& map, int x, int y,
                             std::array<std::size_t, 4>& counts) {
    constexpr Code lower = std::numeric_limits<Code>::max() / 2;
    for (int row = 0; row < map.height; ++row) {
        const Code* sample = map.row<Code>(row);
        for (int column = 0; column < map.width; ++column, sample += map.channels) {
            const auto in_x = static_cast<Code>(sample[x] - lower);
            const auto in_y = static_cast<Code>(sample[y] - lower);
            if (in_x <= 1 && in_y <= 1) ++counts[2U * in_x + in_y];
        }
    }
}

void check_map(const ImageView& map) {
    if (map.empty()) throw InvalidInput("the normal map is empty");
    if (map.channels < 3) {
        throw InvalidInput(fmt::format("a normal map has 3 or 4 channels, not {}", map.channels));
    }
}

}  // namespace

void detail::check_target(const MutableImageView& target, const ImageView& input, int bits,
                          int min_channels, int max_channels, const char* what) {
    if (target.width == input.width && target.height == input.height &&
        target.channels >= min_channels && target.channels <= max_channels && target.bits() == bits)
        return;
    const std::string channels = min_channels == max_channels
                                     ? fmt::format("{}", min_channels)
                                     : fmt::format("{} to {}", min_channels, max_channels);
    throw InvalidInput(
        fmt::format("the memory for the {} has {} x {} texels of {} channels with {} bits, but "
                    "must have {} x {} of {} with {}",
                    what, target.width, target.height, target.channels, target.bits(), input.width,
                    input.height, channels, bits));
}

Image encode_normal_map(const ImageView& normals, const NormalMapFormat& format, Report& report) {
    check_floats(normals, 3, "normals");
    Image result = make_image(normals.width, normals.height, 3, format.bits, ColorSpace::data);
    encode_normal_map(normals, format, MutableImageView(result), report);
    return result;
}

void encode_normal_map(const ImageView& normals, const NormalMapFormat& format,
                       const MutableImageView& map, Report& report,
                       const ExecutionOptions& execution) {
    const ExecutionScope scope(execution);
    check_floats(normals, 3, "normals");
    check_target(map, normals, format.bits, 2, 4, "normal map");
    with_sample_type(
        map, [&]<typename Sample>(Sample) { encode<Sample>(normals, format, 0, map, report); });
}

Image decode_normal_map(const ImageView& map, Green green, FlatCode flat, Report& report,
                        FlatTexels texels) {
    check_map(map);
    Image result = make_image(map.width, map.height, 3, 32, ColorSpace::data);
    decode_normal_map(map, green, flat, MutableImageView(result), report, texels);
    return result;
}

void decode_normal_map(const ImageView& map, Green green, FlatCode flat,
                       const MutableImageView& normals, Report& report, FlatTexels texels,
                       const ExecutionOptions& execution) {
    const ExecutionScope scope(execution);
    check_map(map);
    check_target(normals, map, 32, 3, 3, "normals");
    with_sample_type(map, [&]<typename Sample>(Sample) {
        decode<Sample>(map, green, flat, ExactFlat<Sample>(map, flat, texels, 0, 1), normals,
                       report);
    });
}

Image detail::encode_normal_rows(const ImageView& normals, const NormalMapFormat& format,
                                 int first_row, Report& report) {
    Image result = make_image(normals.width, normals.height, 3, format.bits, ColorSpace::data);
    with_sample_type(result, [&]<typename Sample>(Sample) {
        encode<Sample>(normals, format, first_row, MutableImageView(result), report);
    });
    return result;
}

Image detail::decode_normal_rows(const ImageView& map, FlatCode flat, const FlatCodes& codes,
                                 Report& report) {
    check_map(map);
    Image result = make_image(map.width, map.height, 3, 32, ColorSpace::data);
    with_sample_type(map, [&]<typename Sample>(Sample) {
        decode<Sample>(map, Green::up, flat, ExactFlat<Sample>(codes), MutableImageView(result),
                       report);
    });
    return result;
}

void FlatCodeCount::add(const ImageView& map, int x, int y) {
    bits_ = map.bits();
    if (bits_ == 8) count_pairs_around_zero<std::uint8_t>(map, x, y, counts_);
    if (bits_ == 16) count_pairs_around_zero<std::uint16_t>(map, x, y, counts_);
}

FlatCodes FlatCodeCount::codes() const {
    const std::size_t all = std::accumulate(counts_.begin(), counts_.end(), std::size_t{0});
    const auto most = std::max_element(counts_.begin(), counts_.end());
    if (all == 0 || 4 * *most < 3 * all) return std::nullopt;
    const auto pair = static_cast<unsigned>(most - counts_.begin());
    const unsigned lower = bits_ == 8 ? 127 : 32767;
    return std::array{static_cast<std::uint16_t>(lower + pair / 2),
                      static_cast<std::uint16_t>(lower + pair % 2)};
}

std::optional<std::array<std::uint16_t, 2>> flat_texel_codes(const ImageView& map, int x, int y) {
    if (map.empty()) throw InvalidInput("the normal map is empty");
    if (std::min(x, y) < 0 || std::max(x, y) >= map.channels) {
        throw InvalidInput(
            fmt::format("channels {} and {} of an image that has {}", x, y, map.channels));
    }
    FlatCodeCount count;
    count.add(map, x, y);
    return count.codes();
}

FlatCode detect_flat_code(const ImageView& map,
                          const std::map<std::string, std::string>& metadata) {
    check_map(map);
    return read_description(metadata).flat.value_or(FlatCode::half);
}

std::map<std::string, std::string> normal_map_metadata(const NormalMapFormat& format) {
    MapDescription description;
    description.kind = MapKind::normal;
    description.green = format.green;
    description.flat = format.flat;
    description.color_space = ColorSpace::data;
    return write_description(description, format.bits);
}

namespace {

/// The negative of a stored sample.
template <typename Sample>
struct Opposite {
    FlatCode flat;

    /// The negative is twice the code of zero minus the code. In the arithmetic of the codes, 256 -
    /// c is 0 - c.
    [[nodiscard]] Sample of(Sample code) const {
        constexpr Sample largest = std::numeric_limits<Sample>::max();
        if (flat == FlatCode::half) return static_cast<Sample>(largest - code);
        return code == 0 ? largest : static_cast<Sample>(0 - code);
    }
    [[nodiscard]] bool exists(Sample code) const { return flat == FlatCode::half || code != 0; }
};

template <>
struct Opposite<float> {
    FlatCode flat;
    [[nodiscard]] static float of(float sample) { return 1.0F - sample; }
    [[nodiscard]] static bool exists(float) { return true; }
};

template <typename Sample>
void map_row(Sample* row, std::size_t width, std::size_t channels, const AxisMapping& mapping,
             const Opposite<Sample>& opposite, std::size_t first_texel, Report& found) {
    for (std::size_t x = 0; x < width; ++x) {
        Sample* const texel = row + x * channels;
        const std::array<Sample, 3> old = {texel[0], texel[1], texel[2]};
        for (std::size_t i = 0; i < 3; ++i) {
            const Sample sample = old[static_cast<std::size_t>(mapping[i].axis)];
            texel[i] = mapping[i].is_negative ? opposite.of(sample) : sample;
            if (mapping[i].is_negative && !opposite.exists(sample))
                found.add("code 0 without an opposite", "texel", first_texel + x,
                          "stored as the largest code");
        }
    }
}

void check_mapping(const AxisMapping& mapping) {
    std::array<int, 3> uses{};
    for (const SignedAxis& to : mapping) {
        if (to.axis < 0 || to.axis > 2)
            throw InvalidInput(fmt::format("there is no axis {}, only 0, 1 and 2", to.axis));
        if (++uses[static_cast<std::size_t>(to.axis)] > 1)
            throw InvalidInput(fmt::format("axis {} is used twice", "xyz"[to.axis]));
    }
}

}  // namespace

void map_axes(Image& map, const AxisMapping& mapping, FlatCode flat, Report& report) {
    check_mapping(mapping);
    if (map.channels < 3)
        throw InvalidInput(fmt::format("a normal map has 3 or 4 channels, not {}", map.channels));
    const auto width = static_cast<std::size_t>(map.width);
    const auto channels = static_cast<std::size_t>(map.channels);
    with_sample_type(map, [&]<typename Sample>(Sample) {
        Sample* const samples = map.as<Sample>().data();
        for_each_row(map.width, map.height, report, [&](std::size_t row, Report& found) {
            map_row(samples + row * width * channels, width, channels, mapping,
                    Opposite<Sample>{flat}, row * width, found);
        });
    });
}

void map_normal_axes(Image& normals, const AxisMapping& mapping) {
    check_mapping(mapping);
    check_floats(normals, 3, "normals");
    const std::span<float> all = normals.as<float>();
    Report unused;
    for_each_texel(all.size() / 3, unused, [&](std::size_t texel, Report&) {
        float* const normal = &all[texel * 3];
        const std::array<float, 3> old = {normal[0], normal[1], normal[2]};
        for (std::size_t i = 0; i < 3; ++i) {
            const float part = old[static_cast<std::size_t>(mapping[i].axis)];
            normal[i] = mapping[i].is_negative ? 0.0F - part : part;  // This is never -0.
        }
    });
}

}  // namespace relief
