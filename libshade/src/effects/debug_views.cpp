// SPDX-License-Identifier: Apache-2.0
// The words for debug views: the one table that command lines, panels and messages take them from.
// Tests: tests/shade/effects/debug_views_test.cpp.
#include "relief/shade/debug_views.h"

#include <array>

namespace relief {

namespace {

using enum DebugViewKind;
using V = DebugView;

constexpr std::array all_views = {
    DebugViewInfo{V::picture, "picture", "everything, as always", picture},
    DebugViewInfo{V::geometric_normal, "geometric-normal", "the normals of triangles", data},
    DebugViewInfo{V::shading_normal, "shading-normal", "the normals that light meets", data},
    DebugViewInfo{V::tangent, "tangent", "the tangents of the frame that normal maps are read in",
                  data},
    DebugViewInfo{V::bitangent, "bitangent", "its bitangents", data},
    DebugViewInfo{V::handedness, "handedness",
                  "blue where that frame is right-handed, red where it is mirrored", data},
    DebugViewInfo{V::texcoords, "texcoords", "u in red, v in green, 8 x 8 squares in blue", data},
    DebugViewInfo{V::normal_map, "normal-map", "the normal map's vectors", data},
    DebugViewInfo{V::height, "height", "the bump map's heights", data},
    DebugViewInfo{V::ambient, "ambient", "light from everywhere, alone", term},
    DebugViewInfo{V::diffuse, "diffuse", "what lamps make surfaces scatter, alone", term},
    DebugViewInfo{V::specular, "specular", "the highlights of lamps, alone", term},
    DebugViewInfo{V::environment_light, "environment-light",
                  "what the environment makes surfaces scatter, alone", term},
    DebugViewInfo{V::reflection, "reflection", "the mirrored environment, alone", term},
    DebugViewInfo{V::refraction, "refraction", "the environment seen through surfaces, alone",
                  term},
    DebugViewInfo{V::emission, "emission", "what surfaces emit, alone", term},
    DebugViewInfo{V::overdraw, "overdraw", "how many fragments lie on each other", count},
    DebugViewInfo{V::nothing_to_show, "nothing", "that there is nothing to show", data},
};

/// Whether each view's row is where the view looks for it, and its kind is what is_data() says.
constexpr bool are_in_order() {
    for (std::size_t i = 0; i < all_views.size(); ++i) {
        if (all_views[i].view != static_cast<V>(i)) return false;
    }
    return all_views.back().view == V::nothing_to_show;
}
static_assert(are_in_order());

}  // namespace

std::span<const DebugViewInfo> debug_views() {
    return std::span(all_views).first(all_views.size() - 1);
}

const DebugViewInfo& debug_view_info(DebugView view) {
    return all_views.at(static_cast<std::size_t>(view));
}

}  // namespace relief
