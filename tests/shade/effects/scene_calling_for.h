// SPDX-License-Identifier: Apache-2.0
/// \file
/// The way back from effects to scenes: a small scene that calls for these and no others.
#pragma once

#include "relief/shade/effects.h"

namespace relief::test {

struct CallingScene {
    Scene scene;
    FrameSettings settings;
    /// What its only draw is to be planned with: the features asked for, but where no scene calls
    /// for just those (a light buffer for few lights; glTF's model that does not mirror its
    /// environment; codes before blending).
    Features expected;
};

/// \param features  canonical
CallingScene scene_calling_for(const Features& features);

}  // namespace relief::test
