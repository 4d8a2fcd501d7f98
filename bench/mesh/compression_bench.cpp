// SPDX-License-Identifier: Apache-2.0
// Block compression of a map of waves with a slope of 0.35 (RMS): error, size and speed on one
// thread, interleaved.
//
//     relief-compression-bench                 relief's encoders
//     relief-compression-bench write MAP.png   writes the map with 8 bits, for other encoders
//     relief-compression-bench FILE...         errors of KTX2 and DDS files of that map, green up
#include <fmt/format.h>

#include <functional>
#include <string>
#include <vector>

#include "relief/accuracy/ground_truth.h"
#include "relief/mesh/block_compression.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/statistics.h"
#include "relief/mesh/texture_file.h"

namespace {
using namespace relief::accuracy;

using namespace relief;

constexpr int side = 1024;

/// The normals of a field in floats.
Image map_of(const BumpField& field) {
    Image image = make_image(side, side, 3, 32, ColorSpace::data);
    for (std::size_t i = 0; i < image.sample_count(); ++i)
        image.as<float>()[i] = static_cast<float>(field.normals[i / 3][static_cast<int>(i % 3)]);
    return image;
}

Image normals_of(const Image& image, bool is_middle) {
    const FlatCode flat = is_middle ? FlatCode::middle : FlatCode::half;
    if (image.channels == 2) return decode_xy_map(image, {0, 1}, Green::up, flat);
    return decode_normal_map(image, Green::up, flat);
}

void print_line(const std::string& name, const ErrorStats& error, const std::string& rest) {
    fmt::print("{:22} mean {:.3f}, 99 % {:.3f}, maximum {:.3f} degrees{}\n", name, error.mean,
               error.p99, error.max, rest);
}

struct Contender {
    std::string name;
    BlockFormat format;
    std::function<std::vector<std::byte>()> encode;
};

std::vector<Contender> contenders(const Image& normals, const Image& codes) {
    std::vector<Contender> result;
    for (const auto& [quality_name, quality, label] : enum_names<BlockQuality>) {
        for (const BlockFormat format : {BlockFormat::bc5, BlockFormat::bc5_snorm}) {
            const NormalBlockOptions options{format, quality, Green::up};
            result.push_back({fmt::format("{} {}", enum_name(format), quality_name), format,
                              [&, options] { return encode_normal_blocks(normals, options); }});
        }
        result.push_back(
            {fmt::format("bc7 {}", quality_name), BlockFormat::bc7,
             [&, quality = quality] { return encode_blocks(codes, BlockFormat::bc7, quality); }});
    }
    return result;
}

void compare_encoders(const BumpField& field, const Image& normals) {
    const Image codes = encode_normal_map(normals, {.bits = 32});
    const std::vector<Contender> all = contenders(normals, codes);
    std::vector<std::vector<double>> speeds(all.size());
    interleave(all.size(), {3, 1}, [&](std::size_t i, bool counted) {
        const double seconds = seconds_of([&] { all[i].encode(); });
        if (counted) speeds[i].push_back(double{side} * side / seconds / 1e6);
    });
    for (std::size_t i = 0; i < all.size(); ++i) {
        const auto blocks = all[i].encode();
        const Image decoded =
            normals_of(decode_blocks(blocks, all[i].format, side, side), is_signed(all[i].format));
        const TimeStatistics speed = time_statistics(speeds[i]);
        print_line(all[i].name, normal_error(decoded, field),
                   fmt::format(", {:.1f} MTexel/s (p10 {:.1f}, p90 {:.1f})", speed.median,
                               speed.p10, speed.p90));
    }
    for (const int bits : {8, 16}) {
        const Image map = encode_normal_map(normals, {.bits = bits});
        print_line(fmt::format("rgb{}", bits), normal_error(normals_of(map, false), field), "");
    }
}

}  // namespace

int main(int argc, char** argv) try {
    set_thread_limit(1);
    const BumpField field = wave_heights(side, side, tiling_waves(side, side, 8, 9, 0.35, 6));
    const Image normals = map_of(field);
    if (argc == 3 && std::string(argv[1]) == "write") {
        write_image(argv[2], encode_normal_map(normals, {.bits = 8}));
        return 0;
    }
    if (argc == 1) compare_encoders(field, normals);
    for (int i = 1; i < argc; ++i) {
        print_line(argv[i],
                   normal_error(normals_of(read_image(argv[i], ImageUse::data), false), field), "");
    }
    return 0;
} catch (const relief::Error& error) {
    fmt::print(stderr, "relief-compression-bench: {}\n", error.what());
    return 1;
}
