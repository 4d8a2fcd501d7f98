// SPDX-License-Identifier: Apache-2.0
// Tests: tests/accuracy/bake_experiments_test.cpp.
#include "bake/baked_pictures.h"

#include <fmt/format.h>

#include "analytic_words.h"
#include "drawn/drawn_methods.h"
#include "drawn/lit_scene.h"
#include "drawn/many_samples.h"

namespace relief {
namespace {

constexpr int picture_side = 320;
constexpr int rays_a_side = 2;

std::string name_of(const BakedMap& map) {
    return fmt::format("{}, {}", words_of(map.way), depth_words(map.format.bits));
}

Image picture_of(const Scene& scene) {
    return many_samples(scene, picture_side, rays_a_side);
}

}  // namespace

void add_error_maps(const BumpyBake& bake, std::span<const BakedMap> maps, double brightest,
                    Experiment& experiment) {
    for (const BakedMap& map : maps) {
        experiment.heat_maps.push_back({"Where the map is off", name_of(map),
                                        bake.trials().error_map(map.way, map.format), brightest});
    }
}

void add_renderings(const BumpyBake& bake, std::span<const BakedMap> maps, Experiment& experiment) {
    const Scene high = lit_scene(bake.high().mesh(), glossy_plastic());
    const Image truth = picture_of(high);
    for (const BakedMap& map : maps) {
        Scene low =
            bumpy_scene(bake.baker().low(), glossy_plastic(), bake.map_by(map.way, map.format));
        low.camera = high.camera;
        experiment.pictures.push_back(
            pair_of(fmt::format("{} triangles with a map of {} x {} texels, and the {} that it was "
                                "baked from",
                                bake.baker().low().triangles.size(), bake.map().width,
                                bake.map().height, bake.high().mesh().triangles.size()),
                    name_of(map), to_srgb(picture_of(low), 8), truth));
    }
}

}  // namespace relief
