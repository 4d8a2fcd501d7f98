// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which effects change no pixel where they are forced on, and which are choices of the scene.
/// Pure. Tests: tests/shade/effects/effect_forcing_test.cpp,
/// tests/shade/render/forced_effects_test.cpp.
#pragma once

#include <string>

#include "relief/shade/effects.h"

namespace relief {

/// A draw whose effects are forced.
struct ForcingSubject {
    const Scene& scene;
    const Material& material;
    const Features& planned;
};

/// Why this effect, which is not planned, would change the picture of this draw if it were forced
/// on; nothing where it is neutral, once all else that canonical() asks for is there.
std::string why_not_neutral(const ForcingSubject& subject, const Effect& effect);

/// The name of an effect that is on in `before` and pushed out by what made `after` of it; nothing
/// where none is. Mixed falloff pushes nothing out: it is both laws.
std::string displaced_effect(const Features& before, const Features& after);

}  // namespace relief
