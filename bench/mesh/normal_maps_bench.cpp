// SPDX-License-Identifier: Apache-2.0
// Operations on normal maps without files, interleaved: nanoseconds per texel, for
// docs/normal-maps.md.
#include <fmt/format.h>

#include <functional>
#include <string>
#include <vector>

#include "relief/accuracy/ground_truth.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/statistics.h"

namespace {
using namespace relief::accuracy;

using namespace relief;

constexpr int side = 2048;

struct Operation {
    std::string name;
    std::function<void()> once;
    std::function<void()> prepare = [] {};  ///< Runs before each timed run, and is not timed.
};

Image bumpy_normals() {
    const std::vector<HeightWave> waves = tiling_waves(side, side, 4, 16, 0.5, 3);
    const BumpField field = wave_heights(side, side, waves);
    Image image = make_image(side, side, 3, 32, ColorSpace::data);
    for (std::size_t i = 0; i < image.sample_count(); ++i)
        image.as<float>()[i] = static_cast<float>(field.normals[i / 3][static_cast<int>(i % 3)]);
    return image;
}

std::vector<Operation> all_things(const Image& normals, Report& report) {
    std::vector<Operation> operations;
    const auto codes_of = [&](const NormalMapFormat& format) {
        return [&, format] { encode_normal_map(normals, format, report); };
    };
    operations.push_back({"encode 16 bits", codes_of({16})});
    operations.push_back({"encode 8 bits", codes_of({8})});
    operations.push_back({"encode 8 bits, blue-noise",
                          codes_of({8, Green::up, FlatCode::middle, Dither::blue_noise})});
    static const Image map = encode_normal_map(normals, {16}, report);
    operations.push_back(
        {"decode 16 bits", [&] { decode_normal_map(map, Green::up, FlatCode::middle, report); }});
    static Image flipped = map;
    operations.push_back(
        {"flip green of 16-bit codes", [&] {
             map_axes(flipped, {{{0, false}, {1, true}, {2, false}}}, FlatCode::middle, report);
         }});
    static const char* const names[] = {
        "reoriented", "partial-derivative", "whiteout", "udn", "unity", "linear", "overlay"};
    static Image base = normals;
    for (std::size_t i = 0; i < std::size(names); ++i) {
        operations.push_back(
            {fmt::format("blend, {}", names[i]),
             [&, i] { blend_normals(base, normals, all_normal_blends[i], report); },
             [&] { base = normals; }});
    }
    for (const auto& [name, filter] :
         {std::pair{"box", ResizeFilter::box}, std::pair{"lanczos", ResizeFilter::lanczos}}) {
        for (const ResizeDomain domain : {ResizeDomain::slopes, ResizeDomain::vectors}) {
            ResizeOptions options;
            options.filter = filter;
            options.domain = domain;
            operations.push_back(
                {fmt::format("resize to 50 %, {}, {}", name,
                             domain == ResizeDomain::slopes ? "slopes" : "vectors"),
                 [&, options] { resize_normals(normals, side / 2, side / 2, options, report); }});
        }
    }
    operations.push_back({"all mip levels", [&] { normal_mip_levels(normals); }});
    return operations;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc > 1) set_thread_limit(static_cast<unsigned>(std::stoul(argv[1])));
    const Image normals = bumpy_normals();
    Report report;
    const std::vector<Operation> operations = all_things(normals, report);
    std::vector<std::vector<double>> times(operations.size());
    interleave(operations.size(), {}, [&](std::size_t operation, bool counted) {
        operations[operation].prepare();
        const double taken = seconds_of(operations[operation].once);
        if (counted) times[operation].push_back(1e9 * taken / (double{side} * side));
    });
    for (std::size_t i = 0; i < operations.size(); ++i) {
        const TimeStatistics spread = time_statistics(times[i]);
        fmt::print("{:32} {:6.2f} ns a texel (p10 {:.2f}, p90 {:.2f})\n", operations[i].name,
                   spread.median, spread.p10, spread.p90);
    }
}
