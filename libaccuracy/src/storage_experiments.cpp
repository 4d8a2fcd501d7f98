// SPDX-License-Identifier: Apache-2.0
// Encodes normals as normal maps, as half floats, in 10 bits and as octahedral codes. Integer codes
// are decoded by the library; the other codes exist only here. Encodes evenly spread tangent frames
// with every frame encoding, and compares the decoded frames with the frames in double. Compresses
// normal maps to the blocks of GPUs.
#include "storage_experiments.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <numbers>

#include "experiment_driver.h"
#include "experiment_parts.h"
#include "octahedral_code.h"
#include "parallel.h"
#include "portable_math.h"
#include "relief/accuracy/ground_truth.h"
#include "relief/mesh/block_compression.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/report.h"
#include "relief/mesh/statistics.h"

namespace relief::accuracy::detail {
using namespace relief::detail;

namespace {

constexpr std::size_t grain = 4096;  ///< Smaller pieces are not worth a thread.

std::size_t texels_of(const Image& image) {
    return static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
}

glm::dvec3 normal_at(std::span<const float> samples, std::size_t texel) {
    return {samples[3 * texel], samples[3 * texel + 1], samples[3 * texel + 2]};
}

void set_normal(std::span<float> samples, std::size_t texel, const glm::dvec3& normal) {
    for (int axis = 0; axis < 3; ++axis)
        samples[3 * texel + static_cast<std::size_t>(axis)] = static_cast<float>(normal[axis]);
}

/// Encodes and decodes each texel by codes of 16 bits.
///
/// \param encode  writes the codes of a normal, of `channels` channels
/// \param decode  returns the direction of codes, of any length
template <typename Encode, typename Decode>
auto by_texels(int channels, Encode encode, Decode decode) {
    return [=](const Image& normals) -> NormalDecoder {
        Image codes = make_image(normals.width, normals.height, channels, 16, ColorSpace::data);
        const auto stride = static_cast<std::size_t>(channels);
        const std::span<const float> from = normals.as<float>();
        const std::span<std::uint16_t> to = codes.as<std::uint16_t>();
        parallel_for(texels_of(normals), grain, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                encode(normal_at(from, i), &to[i * stride]);
        });
        return [decode, stride, codes = std::move(codes)] {
            Image decoded = make_image(codes.width, codes.height, 3, 32, ColorSpace::data);
            const std::span<const std::uint16_t> words = codes.as<std::uint16_t>();
            const std::span<float> samples = decoded.as<float>();
            parallel_for(texels_of(codes), grain, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i)
                    set_normal(samples, i, glm::normalize(decode(&words[i * stride])));
            });
            return decoded;
        };
    };
}

/// \param zero  the code of zero in integer maps; "exact" for layouts that represent 0 exactly
NormalCode named(const std::string& layout, const std::string& bits, const std::string& rounding,
                 double bytes, const std::string& zero = "exact") {
    NormalCode code;
    code.name = layout + " " + bits;
    if (rounding != "nearest") code.name += ", " + rounding;
    code.choices = {{"layout", layout}, {"bits", bits}, {"rounding", rounding}, {"zero", zero}};
    code.stored_bytes = bytes;
    return code;
}

std::string rounding_of(const NormalMapFormat& format) {
    return format.dither == Dither::none ? "nearest" : enum_name(format.dither);
}

std::string zero_of(FlatCode flat, int bits) {
    const double largest = bits == 8 ? 255.0 : 65535.0;
    return fmt::format("{}", flat == FlatCode::middle ? (largest + 1.0) / 2.0 : largest / 2.0);
}

/// A normal map whose decoder takes `decoder` for zero, as glTF and engines do by default.
NormalCode as_map(const NormalMapFormat& format, FlatCode decoder = FlatCode::half) {
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
    code.compute = [format, decoder](const Image& normals) -> NormalDecoder {
        return [=, codes = encode_normal_map(normals, format)] {
            return decode_normal_map(codes, format.green, decoder);
        };
    };
    return code;
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

/// Only x and y of such a map; z is computed from the unit length.
NormalCode as_xy_map(const NormalMapFormat& format) {
    NormalCode code = named("xy", fmt::format("{} bit", format.bits), rounding_of(format),
                            2.0 * format.bits / 8.0, zero_of(format.flat, format.bits));
    code.compute = [format](const Image& normals) -> NormalDecoder {
        const Image map = encode_normal_map(normals, format);
        return [format, codes = format.bits == 8 ? without_z<std::uint8_t>(map)
                                                 : without_z<std::uint16_t>(map)] {
            return decode_xy_map(codes, {}, format.green, format.flat);
        };
    };
    return code;
}

/// GL_INT_2_10_10_10_REV: code c represents c / 511.
NormalCode as_ten_bits() {
    constexpr int largest = 511;
    NormalCode code = named("xyz", "10 bit", "nearest", 4.0);
    code.compute = by_texels(
        3,
        [](const glm::dvec3& n, std::uint16_t* to) {
            for (int axis = 0; axis < 3; ++axis)
                to[axis] =
                    static_cast<std::uint16_t>(rounded_to_int(n[axis] * largest) + largest + 1);
        },
        [](const std::uint16_t* from) {
            return glm::dvec3(from[0], from[1], from[2]) - (largest + 1.0);
        });
    return code;
}

/// (n + 1) / 2 rounded to half floats, as `relief-bake --half` writes.
NormalCode as_halves() {
    NormalCode code = named("xyz", "half", "nearest", 6.0);
    const auto halves = by_texels(
        3,
        [](const glm::dvec3& sample, std::uint16_t* to) {
            for (int axis = 0; axis < 3; ++axis)
                to[axis] = glm::packHalf1x16(static_cast<float>(sample[axis]));
        },
        [](const std::uint16_t* from) {
            const glm::dvec3 sample(glm::unpackHalf1x16(from[0]), glm::unpackHalf1x16(from[1]),
                                    glm::unpackHalf1x16(from[2]));
            return 2.0 * sample - 1.0;
        });
    code.compute = [halves](const Image& normals) {
        return halves(encode_normal_map(normals, {.bits = 32}));
    };
    return code;
}

OctahedralCode octahedral_code(const glm::dvec3& normal, int largest, bool best) {
    const glm::dvec2 place = octahedral_place(normal, largest);
    if (!best) return nearest_code(place, largest, -1);
    return best_code(place, largest, -1, [&](OctahedralCode candidate) {
        const glm::dvec3 actual = octahedral_direction(candidate, largest);
        return glm::length(glm::cross(actual, normal)) / glm::length(actual);
    });
}

NormalCode as_octahedral(int bits, bool best) {
    const int largest = (1 << (bits - 1)) - 1;
    // Two codes occupy 16, 24 or 32 bits in existing formats.
    NormalCode code = named("octahedral", fmt::format("2 x {} bit", bits),
                            best ? "best" : "nearest", std::ceil(2.0 * bits / 8.0));
    code.compute = by_texels(
        2,
        [largest, best](const glm::dvec3& n, std::uint16_t* to) {
            const OctahedralCode actual = octahedral_code(n, largest, best);
            to[0] = static_cast<std::uint16_t>(actual.x + largest);
            to[1] = static_cast<std::uint16_t>(actual.y + largest);
        },
        [largest](const std::uint16_t* from) {
            return octahedral_direction({from[0] - largest, from[1] - largest}, largest);
        });
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
    const auto offered = [](NormalCode code, const char* file_and_options) {
        code.command = file_and_options;
        return code;
    };
    std::vector<NormalCode> codes = {
        offered(as_map(rounded(8, Dither::none)), "OUT.png --bits 8 --zero-code 127.5"),
        as_map(rounded(8, Dither::none), FlatCode::middle),
        offered(as_map(zero_is_a_code(8), FlatCode::middle), "OUT.png --bits 8 --zero-code 128"),
        as_map(zero_is_a_code(8)),
        offered(as_map(rounded(8, Dither::ordered)),
                "OUT.png --bits 8 --zero-code 127.5 --dither ordered"),
        offered(as_map(rounded(8, Dither::blue_noise)),
                "OUT.png --bits 8 --zero-code 127.5 --dither blue-noise"),
        as_ten_bits(),
        offered(as_map(rounded(16, Dither::none)), "OUT.png --bits 16 --zero-code 127.5"),
        as_map(zero_is_a_code(16), FlatCode::middle),
        as_map(zero_is_a_code(16)),
        as_map(rounded(16, Dither::blue_noise)),
        offered(as_halves(), "OUT.exr --half"),
        offered(as_map(rounded(32, Dither::none)), "OUT.exr"),
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

ErrorStats patch_errors(const Image& normals, const Image& ground_truth, int block) {
    const int columns = ground_truth.width / block;
    const auto patches = static_cast<std::size_t>(columns * (ground_truth.height / block));
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
    const std::vector<glm::dvec3> actual = sums_of(normals);
    const std::vector<glm::dvec3> expected = sums_of(ground_truth);
    std::vector<float> degrees;
    for (std::size_t i = 0; i < patches; ++i)
        degrees.push_back(angle_of(actual[i], expected[i]));
    return error_stats(std::move(degrees));
}

namespace {

/// Exact normals, and the same rounded to float as the texels of a map.
struct ExactTexels {
    std::vector<glm::dvec3> directions;
    Image normals;

    ExactTexels(std::vector<glm::dvec3> exact, int side)
        : directions(std::move(exact)), normals(image_of_normals(directions, side)) {}
};

/// An experiment whose methods store the normals of a map in codes.
/// \param error  returns the error of the decoded normals of a code
template <typename Error>
PreparedExperiment code_experiment(Experiment report,
                                   const std::shared_ptr<const ExactTexels>& input,
                                   const std::vector<NormalCode>& codes, StorageWork work,
                                   const Error& error) {
    PreparedExperiment prepared;
    prepared.report = std::move(report);
    prepared.report.error_unit = "degrees";
    prepared.report.item = "texel";
    prepared.report.items = static_cast<double>(input->directions.size());
    prepared.costs.memory = false;
    prepared.methods = methods_on(std::shared_ptr<const Image>(input, &input->normals), codes,
                                  [input, error](const NormalCode& code) {
                                      return error(code, stored(code, input->normals));
                                  });
    if (work == StorageWork::encode) return prepared;
    for (std::size_t i = 0; i < codes.size(); ++i) {
        // The error encodes the normals, which the work decodes.
        const auto decode = std::make_shared<NormalDecoder>();
        prepared.methods[i].error = [input, code = codes[i], decode, error] {
            *decode = code.compute(input->normals);
            return error(code, (*decode)());
        };
        prepared.methods[i].work = [decode] { (*decode)(); };
    }
    return prepared;
}

/// The errors of single normals.
auto texel_errors_of(const std::shared_ptr<const ExactTexels>& input) {
    return
        [input](const NormalCode&, const Image& map) { return map_errors(map, input->directions); };
}

Chart patches_chart(const Image& ground_truth, const std::vector<NormalCode>& codes) {
    std::vector<Image> maps;
    for (const NormalCode& code : codes)
        maps.push_back(stored(code, ground_truth));
    Chart chart = chart_over(
        {.id = "patches",
         .title = "The mean of larger patches",
         .x_label = "side of a patch, texels",
         .y_label = "RMS error of the mean normal, degrees"},
        names_of(codes), {1, 2, 4, 8, 16, 32}, [](double side) { return static_cast<int>(side); },
        [&](std::size_t i, int side) {
            return curve_error(patch_errors(maps[i], ground_truth, side));
        });
    for (Curve& curve : chart.curves)
        fit(curve, std::nullopt);
    return chart;
}

PreparedExperiment normal_reading_experiment(const PlanOptions& options) {
    const int side = options.is_quick ? 128 : 512;
    const auto texels = static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
    const auto input = std::make_shared<const ExactTexels>(upper_directions(texels), side);
    PreparedExperiment prepared = code_experiment(
        {.question = "What is the error of a stored normal, by layout and bits?",
         .ground_truth =
             "The directions in double, which are unit by construction and evenly distributed.",
         .input = fmt::format("{} directions spread evenly over the half sphere above a surface",
                              input->directions.size())},
        input, normal_codes(), StorageWork::decode, texel_errors_of(input));
    prepared.compared = {"xyz 8 bit", "xyz 8 bit, zero at 128",
                         "xyz 8 bit, zero at 128, read as glTF does", "octahedral 2 x 8 bit, best",
                         "octahedral 2 x 16 bit, best"};
    return prepared;
}

PreparedExperiment normal_writing_experiment(const PlanOptions&) {
    constexpr int side = 256;  // The same size as in docs/normal-maps.md.
    const auto input = std::make_shared<const ExactTexels>(smooth_surface(side), side);
    PreparedExperiment prepared = code_experiment(
        {.question =
             "How long does encoding a smooth surface take, and does dithering preserve the mean "
             "of a patch?",
         .ground_truth =
             "The normals of the surface in closed form, single and summed over patches. A test "
             "verifies them by numerical differentiation of the heights.",
         .input = fmt::format("{} x {} texels of waves of 128 texels and more", side, side)},
        input, normal_codes(), StorageWork::encode, texel_errors_of(input));
    prepared.compared = {"xyz 8 bit", "xyz 8 bit, blue-noise", "xyz 16 bit"};
    prepared.finish = [input](Experiment& report) {
        report.charts = {patches_chart(input->normals, normal_codes())};
    };
    return prepared;
}

const double golden_angle = std::numbers::pi * (3.0 - std::sqrt(5.0));

}  // namespace

SampleFrames sample_frames(std::span<const glm::dvec3> normals,
                           std::span<const glm::dvec3> tangents) {
    SampleFrames frames;
    frames.normals.assign(normals.begin(), normals.end());
    frames.tangents.assign(tangents.begin(), tangents.end());
    for (std::size_t i = 0; i < normals.size(); ++i) {
        frames.float_normals.emplace_back(normals[i]);
        frames.float_tangents.emplace_back(glm::vec3(tangents[i]), i % 2 == 0 ? 1.0F : -1.0F);
    }
    return frames;
}

std::vector<glm::dvec3> even_directions(std::size_t count) {
    std::vector<glm::dvec3> directions;
    for (std::size_t i = 0; i < count; ++i) {
        const double turn = golden_angle * static_cast<double>(i);
        const double z = 1.0 - (2.0 * static_cast<double>(i) + 1.0) / static_cast<double>(count);
        const double radius = std::sqrt(1.0 - z * z);
        directions.emplace_back(radius * portable::cos(turn), radius * portable::sin(turn), z);
    }
    return directions;
}

std::vector<glm::dvec3> upper_directions(std::size_t count) {
    std::vector<glm::dvec3> directions = even_directions(2 * count);
    directions.resize(count);
    return directions;
}

SampleFrames even_frames(std::size_t count) {
    const std::vector<glm::dvec3> normals = even_directions(count);
    std::vector<glm::dvec3> tangents;
    for (std::size_t i = 0; i < count; ++i) {
        const double turn = golden_angle * static_cast<double>(i);
        const double spin = std::numbers::sqrt2 * turn;
        const glm::dvec3 along(-portable::sin(turn), portable::cos(turn), 0.0);
        tangents.push_back(portable::cos(spin) * along +
                           portable::sin(spin) * glm::cross(normals[i], along));
    }
    return sample_frames(normals, tangents);
}

FrameCodeErrors frame_code_errors(const SampleFrames& ground_truth, FrameEncoding encoding,
                                  FrameRounding rounding) {
    Report report;
    const std::vector<std::uint32_t> words = encode_frames(
        ground_truth.float_normals, ground_truth.float_tangents, encoding, rounding, report);
    return frame_errors(ground_truth, decode_frames(words, encoding, report));
}

FrameCodeErrors frame_errors(const SampleFrames& ground_truth, const Frames& actual) {
    std::vector<float> normals;
    std::vector<float> tangents;
    std::vector<float> texels;
    FrameCodeErrors errors;
    for (std::size_t i = 0; i < ground_truth.normals.size(); ++i) {
        const glm::dvec3 normal(actual.normals[i]);
        const glm::dvec3 tangent(actual.tangents[i]);
        normals.push_back(angle_of(normal, ground_truth.normals[i]));
        tangents.push_back(angle_of(tangent, ground_truth.tangents[i]));
        errors.flipped_frames += actual.tangents[i].w == ground_truth.float_tangents[i].w ? 0U : 1U;
        const glm::dmat3 basis(tangent, glm::cross(normal, tangent), normal);
        const glm::dmat3 expected(ground_truth.tangents[i],
                                  glm::cross(ground_truth.normals[i], ground_truth.tangents[i]),
                                  ground_truth.normals[i]);
        add_texel_angles(texels, basis, expected);
    }
    errors.normal = error_stats(normals);
    errors.tangent = error_stats(tangents);
    normals.insert(normals.end(), tangents.begin(), tangents.end());
    errors.both = error_stats(std::move(normals));
    errors.texel = error_stats(std::move(texels));
    return errors;
}

std::vector<Method> frame_methods(const std::shared_ptr<const SampleFrames>& frames,
                                  StorageWork work) {
    std::vector<Method> methods;
    for (const FrameEncoding encoding : all_frame_encodings) {
        for (const FrameRounding rounding : {FrameRounding::nearest, FrameRounding::best}) {
            const bool is_nearest = rounding == FrameRounding::nearest;
            if (encoding == FrameEncoding::float32 && !is_nearest) continue;
            const std::string word = is_nearest ? "nearest" : "best";
            const auto encode = [frames, encoding, rounding] {
                return encode_frames(frames->float_normals, frames->float_tangents, encoding,
                                     rounding);
            };
            Method& method = methods.emplace_back();
            method.name = fmt::format("{}, {}", enum_name(encoding), word);
            method.choices = {{"encoding", std::string(enum_name(encoding))}, {"rounding", word}};
            method.stored_bytes = 4.0 * static_cast<double>(words_per_frame(encoding));
            method.error = [frames, encoding, rounding] {
                const FrameCodeErrors errors = frame_code_errors(*frames, encoding, rounding);
                return MethodError(errors.both,
                                   errors.flipped_frames == 0
                                       ? ""
                                       : fmt::format("The handedness of {} frames changed.",
                                                     errors.flipped_frames));
            };
            if (work == StorageWork::encode)
                method.work = [encode] { encode(); };
            else
                method.work = [encoding, words = encode()] { decode_frames(words, encoding); };
        }
    }
    return methods;
}

namespace {

/// All encodings on evenly spread frames.
PreparedExperiment frame_experiment(const PlanOptions& options, StorageWork work) {
    const auto frames =
        std::make_shared<const SampleFrames>(even_frames(options.is_quick ? 20000 : 200000));
    const bool is_decoding = work == StorageWork::decode;
    PreparedExperiment prepared;
    prepared.report = {
        .question = is_decoding
                        ? "How many bytes does a tangent frame need, and how long does decoding "
                          "take?"
                        : "How long does encoding tangent frames take, and does the search for the "
                          "best codes pay off?",
        .ground_truth =
            "The frames in double before encoding, which are orthonormal by construction.",
        .input = fmt::format("{} frames spread evenly over the sphere", frames->normals.size()),
        .error_unit = "degrees",
        .item = "frame",
        .items = static_cast<double>(frames->normals.size())};
    prepared.methods = frame_methods(frames, work);
    prepared.compared = {"float32, nearest",  "octahedral8, nearest", "octahedral8, best",
                         "angle10, nearest",  "angle10, best",        "octahedral16, best",
                         "quaternion16, best"};
    return prepared;
}

Image decoded_blocks(std::span<const std::byte> blocks, BlockFormat format, int width, int height) {
    const Image image = decode_blocks(blocks, format, width, height);
    const FlatCode flat = is_signed(format) ? FlatCode::middle : FlatCode::half;
    if (image.channels == 2) return decode_xy_map(image, {0, 1}, Green::up, flat);
    return decode_normal_map(image, Green::up, flat);
}

NormalCode as_blocks(BlockFormat format, BlockQuality quality) {
    NormalCode code;
    code.name = fmt::format("{}, {}", enum_name(format), enum_name(quality));
    code.choices = {{"format", enum_name(format)}, {"quality", enum_name(quality)}};
    code.stored_bytes = static_cast<double>(bytes_per_block(format)) / 16.0;
    code.compute = [format, quality](const Image& normals) -> NormalDecoder {
        // BC7 is encoded from the exact components, not from codes of 8 bits.
        auto blocks =
            channels_of(format) == 2
                ? encode_normal_blocks(normals, {.format = format, .quality = quality})
                : encode_blocks(encode_normal_map(normals, {.bits = 32}), format, quality);
        return [format, blocks = std::move(blocks), width = normals.width,
                height = normals.height] { return decoded_blocks(blocks, format, width, height); };
    };
    return code;
}

std::vector<NormalCode> compressions() {
    using enum BlockQuality;
    std::vector<NormalCode> methods;
    for (const BlockFormat format : {BlockFormat::bc5, BlockFormat::bc5_snorm, BlockFormat::bc7}) {
        for (const BlockQuality quality : {fast, normal, best})
            methods.push_back(as_blocks(format, quality));
    }
    std::vector<NormalCode> texels;
    for (const int bits : {8, 16})
        texels.push_back(as_xy_map({.bits = bits, .flat = FlatCode::half}));
    for (const int bits : {8, 16})
        texels.push_back(as_map({.bits = bits, .flat = FlatCode::half}));
    texels.push_back(as_octahedral(8, true));
    for (NormalCode& code : texels) {
        code.choices = {{"format", code.name}, {"quality", "none"}};
        methods.push_back(std::move(code));
    }
    return methods;
}

/// Waves with a slope of 0.35 (RMS).
/// \param offset  of the texels from their centers, to the right and down
std::vector<glm::dvec3> compressed_waves(int side, double shortest, double offset = 0.0) {
    std::vector<HeightWave> waves = tiling_waves(side, side, 8, shortest, 0.35, 3);
    for (HeightWave& wave : waves)
        wave.phase += glm::dot(wave.frequency, glm::dvec2(offset));
    return wave_heights(side, side, waves).normals;
}

/// Returns whether a code stores z. Shaders compute z of the others after filtering.
bool has_z(const NormalCode& code) {
    return !code.name.starts_with("xy ") && !code.name.starts_with("bc5");
}

/// The normals that bilinear filtering gives at the corners of texels: means of four texels of a
/// map that tiles.
Image filtered_at_corners(const Image& normals, const NormalCode& code) {
    const auto width = static_cast<std::size_t>(normals.width);
    const auto height = static_cast<std::size_t>(normals.height);
    Image result = normals;
    for (std::size_t i = 0; i < width * height; ++i) {
        const std::size_t right = (i % width + 1) % width;
        const std::size_t row = i / width * width;
        const std::size_t next_row = (i / width + 1) % height * width;
        glm::dvec3 mean(0.0);
        for (const std::size_t texel : {i, row + right, next_row + i % width, next_row + right})
            mean += 0.25 * normal_at(normals.as<float>(), texel);
        if (!has_z(code))
            mean.z = std::sqrt(std::max(0.0, 1.0 - mean.x * mean.x - mean.y * mean.y));
        set_normal(result.as<float>(), i, glm::normalize(mean));
    }
    return result;
}

Chart wavelengths_chart(int side) {
    std::vector<NormalCode> methods = compressions();
    // BC7 is slow.
    std::erase_if(methods, [](const NormalCode& code) { return code.name.starts_with("bc7"); });
    return chart_over(
        {.id = "wavelengths",
         .title = "Shorter waves",
         .x_label = "shortest wave, texels",
         .y_label = "RMS error, degrees"},
        names_of(methods), {5.0, 10.0, 20.0, 40.0},
        [&](double shortest) { return ExactTexels(compressed_waves(side, shortest), side); },
        [&](std::size_t i, const ExactTexels& waves) {
            return curve_error(map_errors(stored(methods[i], waves.normals), waves.directions));
        });
}

PreparedExperiment compression_experiment(const PlanOptions& options, bool is_filtered) {
    const int side = options.is_quick ? 128 : 512;
    const auto waves = std::make_shared<const ExactTexels>(compressed_waves(side, 20.0), side);
    std::vector<NormalCode> methods = compressions();
    // A GPU filters codes, and means of octahedral codes across a fold are not normals.
    if (is_filtered) methods.pop_back();
    PreparedExperiment prepared = code_experiment(
        {.question =
             is_filtered
                 ? "What is the error of compressed maps after bilinear filtering?"
                 : "What do block formats cost in accuracy, and how long does encoding take?",
         .ground_truth = fmt::format(
             "The normals of the surface in closed form{}. A test verifies them by numerical "
             "differentiation of the heights.",
             is_filtered ? " at the corners of texels" : ""),
         .input = fmt::format("{} x {} texels of 8 waves of 20 texels and more, slope 0.35 (RMS)",
                              side, side)},
        waves, methods, StorageWork::encode,
        [=, corners = compressed_waves(side, 20.0, 0.5)](const NormalCode& code, const Image& map) {
            return is_filtered ? map_errors(filtered_at_corners(map, code), corners)
                               : map_errors(map, waves->directions);
        });
    prepared.compared = {"bc5, fast", "bc5, best", "bc7, fast", "bc7, best", "xyz 8 bit"};
    prepared.finish = [side, is_filtered](Experiment& report) {
        if (!is_filtered) report.charts = {wavelengths_chart(std::min(side, 256))};
    };
    return prepared;
}

}  // namespace

std::vector<PlannedExperiment> compression_plan(const PlanOptions&) {
    return {{"compression/waves", "Normal maps in block formats",
             [](const PlanOptions& options) { return compression_experiment(options, false); }},
            {"compression/filtered", "Compression, filtered between texels",
             [](const PlanOptions& options) { return compression_experiment(options, true); }}};
}

std::vector<PlannedExperiment> storage_plan(const PlanOptions&) {
    using enum StorageWork;
    return {{"storage/normals", "Normals in few bits", normal_reading_experiment},
            {"storage/smooth-surface", "A smooth surface in few bits, written",
             normal_writing_experiment},
            {"storage/frames", "Tangent frames in few bits",
             [](const PlanOptions& options) { return frame_experiment(options, decode); }},
            {"storage/frames-written", "Tangent frames in few bits, written",
             [](const PlanOptions& options) { return frame_experiment(options, encode); }}};
}

}  // namespace relief::accuracy::detail
