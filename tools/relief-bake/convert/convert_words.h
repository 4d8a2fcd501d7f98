// SPDX-License-Identifier: Apache-2.0
/// \file
/// The words of `relief-bake convert` for what can be chosen. Tests: tests/tools/convert_test.cpp.
#pragma once

#include "common/options.h"
#include "convert/convert_options.h"

namespace relief::tools {

inline Choices<Flip> flip_choices() {
    return {{"green", Flip::green}, {"red", Flip::red}, {"both", Flip::both}};
}

inline Choices<AlphaChoice> alpha_choices() {
    return {{"keep", AlphaChoice::keep}, {"drop", AlphaChoice::drop}};
}

inline Choices<XyChannels> xy_choices() {
    return {{"rg", XyChannels{0, 1}}, {"ag", XyChannels{3, 1}}};
}

inline Choices<ResizeFilter> filter_choices() {
    return {{"best", ResizeFilter::best},
            {"box", ResizeFilter::box},
            {"triangle", ResizeFilter::triangle},
            {"cubic", ResizeFilter::cubic},
            {"lanczos", ResizeFilter::lanczos}};
}

inline Choices<ResizeDomain> domain_choices() {
    return {{"slopes", ResizeDomain::slopes}, {"vectors", ResizeDomain::vectors}};
}

inline Choices<NormalBlend> blend_choices() {
    return {{"reoriented", NormalBlend::reoriented},
            {"partial-derivative", NormalBlend::partial_derivative},
            {"whiteout", NormalBlend::whiteout},
            {"udn", NormalBlend::udn},
            {"unity", NormalBlend::unity},
            {"linear", NormalBlend::linear},
            {"overlay", NormalBlend::overlay}};
}

}  // namespace relief::tools
