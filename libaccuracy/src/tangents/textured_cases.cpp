// SPDX-License-Identifier: Apache-2.0
// Tests: tests/accuracy/tangent_methods_test.cpp.
#include "tangents/textured_cases.h"

#include "analytic_words.h"

namespace relief {
namespace {

TexturedCase case_of(AnalyticSurface surface, Triangulation triangulation, TextureLayout layout) {
    constexpr std::uint32_t seed = 1;
    TexturedCase one;
    one.id = word_of(surface) + "-" + word_of(triangulation);
    one.name = word_of(surface) + ", " + word_of(triangulation);
    if (layout != TextureLayout::upright) {
        const std::string word = layout == TextureLayout::sheared ? "sheared" : "mirrored";
        one.id += "-" + word;
        one.name += ", image " + word;
    }
    one.mesh = [=](int cells) {
        return textured_mesh(surface, triangulation, layout, cells, seed);
    };
    return one;
}

}  // namespace

std::vector<TexturedCase> textured_cases() {
    std::vector<TexturedCase> cases;
    for (const Triangulation triangulation :
         {Triangulation::regular, Triangulation::jittered, Triangulation::anisotropic}) {
        for (const AnalyticSurface surface : all_surfaces)
            cases.push_back(case_of(surface, triangulation, TextureLayout::upright));
    }
    for (const TextureLayout layout : {TextureLayout::sheared, TextureLayout::mirrored})
        cases.push_back(case_of(AnalyticSurface::torus, Triangulation::jittered, layout));
    cases.push_back({"plate", "plate with thin bevels, image sheared on those", false,
                     [](int) { return bevelled_plate(0.02); }});
    return cases;
}

}  // namespace relief
