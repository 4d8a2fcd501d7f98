// SPDX-License-Identifier: Apache-2.0
#include "map_options.h"

#include "common/choices.h"
#include "field_options.h"

namespace relief::tools {
namespace {

constexpr const char* maps_group = "Maps, for all materials; the model needs texture coordinates";

void add_normal_options(CLI::App& app, ViewOptions& options) {
    add_path(app, "--normal-map", options.normal_map, "Normal map.").group(maps_group);
    add_choice(app, "--green", options.green, green_choices(),
               "Where the normal map's green is bright: on slopes facing up in the image (OpenGL, "
               "glTF) or down (DirectX). Default: up.")
        .group(maps_group);
    add_choice(app, "--normal-space", options.normal_space, enum_choices<NormalSpace>(),
               "The space of the normal map's vectors. Default: tangent.")
        .group(maps_group);
    add_number(app, "--normal-scale", "S", options.normal_scale, {-100, 100, ""},
               "Multiplies the slopes of normal maps, the model's own too. Default: as the model "
               "says, else 1.")
        .group(maps_group);
    add_choice(app, "--tangent-frame", options.tangent_frame, enum_choices<TangentFrame>(),
               "Where normal and bump maps get their frame from: the mesh's tangents (MikkTSpace's "
               "where it has none), or how texture coordinates change from pixel to pixel. "
               "Default: stored.")
        .group(maps_group);
    add_choice(
        app, "--specular-antialiasing", options.specular_antialiasing,
        Choices<bool>{{"on", true}, {"off", false}},
        "Widen highlights where a normal map's detail is finer than a pixel, so that they do "
        "not sparkle. Default: off.")
        .group(maps_group);
}

void add_height_options(CLI::App& app, ViewOptions& options) {
    add_path(app, "--height-map", options.height_map,
             "Height map, made into a normal map on the fly, or drawn as a bump map.")
        .group(maps_group);
    add_choice(app, "--height-as", options.height_as,
               Choices<HeightUse>{{"normal_map", HeightUse::normal_map},
                                  {"bump_map", HeightUse::bump_map}},
               "Convert the height map once, or let the shader take its slopes at every pixel. "
               "Default: normal_map.")
        .group(maps_group);
    add_number(app, "--strength", "S", options.strength, {},
               "Height in texels that the height map's value 1.0 stands for. Default: 16.")
        .group(maps_group);
    add_choice(app, "--kernel", options.kernel, kernel_or_auto_choices(),
               "How slopes are taken from the height map; auto takes the truest for it, as "
               "relief-bake bump does. Default: auto.")
        .group(maps_group);
}

}  // namespace

void add_map_options(CLI::App& app, ViewOptions& options) {
    add_path(app, "--diffuse-map", options.diffuse_map,
             "Colour image that replaces every material's diffuse colour.")
        .group(maps_group);
    add_normal_options(app, options);
    add_height_options(app, options);
}

void check_maps(const ViewOptions& options) {
    const char* const give_height = "give a height map too, or leave it out";
    const char* const give_normal = "give a normal map too, or leave it out";
    refuse(options.normal_map && options.height_map, "--height-map",
           "contradicts --normal-map, as both give the normals", "leave one of them out");
    refuse(options.green && !options.normal_map, "--green", "says how to read a --normal-map",
           give_normal);
    refuse(options.normal_space && !options.normal_map, "--normal-space",
           "says how to read a --normal-map", give_normal);
    refuse(options.strength && !options.height_map, "--strength", "says how to read a --height-map",
           give_height);
    refuse(options.kernel && !options.height_map, "--kernel", "says how to read a --height-map",
           give_height);
    refuse(options.height_as && !options.height_map, "--height-as",
           "says what a --height-map becomes", give_height);
    const bool bump = options.height_as == HeightUse::bump_map;
    refuse(bump && options.kernel, "--kernel", "is for converting, and a bump map is not converted",
           "leave it out");
    refuse(bump && options.normal_scale, "--normal-scale", "scales normal maps, not bump maps",
           "use --strength");
    refuse(options.tangent_frame && options.normal_space == NormalSpace::object, "--tangent-frame",
           "an object-space map needs no tangent frame", "leave it out");
}

}  // namespace relief::tools
