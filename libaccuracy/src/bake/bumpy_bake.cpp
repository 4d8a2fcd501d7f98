// SPDX-License-Identifier: Apache-2.0
// Clocks are those of BakeTrials. Tests: tests/accuracy/bake_experiments_test.cpp.
#include "bake/bumpy_bake.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/trigonometric.hpp>

#include "relief/accuracy/measure.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/shapes.h"

namespace relief {
namespace {

Mesh low_sphere(Report& report) {
    return with_frames(make_sphere(BumpyBake::low_slices, BumpyBake::low_stacks),
                       {.tangents = TangentMode::mikktspace}, report)
        .mesh;
}

BakeMapOptions square_map(int side) {
    BakeMapOptions map;
    map.width = map.height = side;
    return map;
}

}  // namespace

std::string words_of(const BakeWay& way) {
    if (way.sample_degrees)
        return fmt::format("up to {} rays beyond {:g}°", way.samples, *way.sample_degrees);
    return way.samples == 1 ? "1 ray" : fmt::format("{} rays", way.samples);
}

BumpyBake::BumpyBake(int high_stacks, int side)
    : high_(high_stacks),
      baker_(std::span(&high_.mesh(), 1), low_sphere(report_), BakeOptions{}, report_),
      map_(square_map(side)),
      trials_(baker_, map_, static_cast<std::size_t>(side) * static_cast<std::size_t>(side)) {}

std::string BumpyBake::words() const {
    return fmt::format("sphere with bumps, {} triangles, for one of {}; map of {} x {} texels",
                       high_.mesh().triangles.size(), baker_.low().triangles.size(), map_.width,
                       map_.height);
}

double BumpyBake::texels() const {
    return static_cast<double>(map_.width) * map_.height;
}

const std::vector<NormalMapFormat>& BumpyBake::formats() {
    static const std::vector<NormalMapFormat> all = {{.bits = 8}, {.bits = 16}, {.bits = 32}};
    return all;
}

Image BumpyBake::map_by(const BakeWay& way, const NormalMapFormat& format) const {
    BakeMapOptions map = map_;
    map.samples = way.samples;
    if (way.sample_degrees) map.sample_angle = glm::radians(*way.sample_degrees);
    Image normals = make_image(map.width, map.height, 3, 32, ColorSpace::data);
    std::span<float> left = normals.as<float>();
    Report unsaid;
    baker_.bake(
        map,
        [&](const BakedRows& rows) {
            std::copy(rows.normals.begin(), rows.normals.end(), left.begin());
            left = left.subspan(rows.normals.size());
        },
        unsaid);
    return encode_normal_map(normals, format, unsaid);
}

std::vector<BakeWayFound> BumpyBake::measured(std::span<const BakeWay> ways,
                                              const RunOptions& options) const {
    std::vector<BakeWayFound> found;
    for (const BakeWay& way : ways)
        found.push_back({trials_.measure(way, formats())});
    if (!options.is_timed) return found;
    // A way's rays are cast once for all formats, which follow one another.
    const std::size_t depths = formats().size();
    BakeTrial trial;
    const auto timings = [&] {
        return rounds_in_turns(ways.size() * depths, options, [&](std::size_t i) {
            if (i % depths == 0) trial = trials_.measure(ways[i / depths], formats());
            return trial.cast_seconds + trial.code_seconds[i % depths];
        });
    };
    const std::vector<Timing> one = on_one_thread(options, timings);
    const std::vector<Timing> all = timings();
    for (std::size_t i = 0; i < one.size(); ++i) {
        found[i / depths].one_thread.push_back(one[i]);
        found[i / depths].all_threads.push_back(all[i]);
    }
    return found;
}

}  // namespace relief
