// SPDX-License-Identifier: Apache-2.0
// The structs of bakes, which exist with and without relief::bake.
#include "c/c_call.h"

using namespace relief;
using namespace relief::detail;

relief_bake_options relief::detail::default_bake_options() {
    const BakeOptions defaults;
    const OcclusionOptions occlusion;
    const FormatNumbers format = numbers_of({});
    relief_bake_options options{};
    options.offset = defaults.offset.value_or(RELIEF_ABSENT);
    options.max_distance = defaults.max_distance.value_or(RELIEF_ABSENT);
    options.hardness = defaults.hardness;
    options.sample_angle = defaults.map.sample_angle.value_or(RELIEF_ABSENT);
    options.occlusion_distance = occlusion.distance.value_or(RELIEF_ABSENT);
    options.occlusion_rays = occlusion.rays;
    options.samples = defaults.map.samples;
    options.padding = defaults.map.padding;
    options.space = number_of(defaults.space, bake_spaces);
    options.directions = number_of(defaults.directions, bake_ray_directions);
    options.take_back_faces = defaults.back_faces == BackFaces::take ? 1 : 0;
    options.allow_size_mismatch = defaults.allow_size_mismatch ? 1 : 0;
    options.green = format.green;
    options.flat = format.flat;
    options.dither = format.dither;
    const ThicknessOptions thickness;
    options.thickness_distance = thickness.distance.value_or(RELIEF_ABSENT);
    options.thickness_rays = thickness.rays;
    return options;
}

relief_status relief_bake_options_init(relief_bake_options* options, size_t size) {
    return init_struct(options, size, default_bake_options(), "relief_bake_options");
}

relief_status relief_bake_maps_init(relief_bake_maps* maps, size_t size) {
    return init_struct(maps, size, {}, "relief_bake_maps");
}

relief_status relief_bake_result_init(relief_bake_result* result, size_t size) {
    return init_struct(result, size, {}, "relief_bake_result");
}
