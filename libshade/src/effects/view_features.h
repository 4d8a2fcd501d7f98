// SPDX-License-Identifier: Apache-2.0
/// \file
/// What is left of a draw's effects where a debug view is shown. Pure.
/// Tests: tests/shade/effects/debug_views_test.cpp.
#pragma once

#include "relief/shade/effects.h"

namespace relief {

/// What a view of data needs, canonical; nothing_to_show where there is not what it shows.
Features data_features(const Features& features);

/// The effects that take part in one term; not canonical yet.
Features term_features(Features features);

/// Whether the features have a term at all.
bool has_term(const Features& features, DebugView term);

/// Whether what is mirrored only dims the term: no mirror image is looked up.
inline bool has_black_mirror(const Features& f) {
    return is_term(f.view) && f.view != DebugView::reflection;
}
/// Whether what comes through the surface only dims the term.
inline bool has_black_transmission(const Features& f) {
    return is_term(f.view) && f.view != DebugView::refraction;
}

/// Whether the frame of normal maps is what is shown.
inline bool shows_frame(const Features& f) {
    return f.view == DebugView::tangent || f.view == DebugView::bitangent ||
           f.view == DebugView::handedness;
}
/// Whether a normal is what is shown.
inline bool shows_normal(const Features& f) {
    return f.view == DebugView::geometric_normal || f.view == DebugView::shading_normal;
}

}  // namespace relief
