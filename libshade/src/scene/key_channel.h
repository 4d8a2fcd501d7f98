// SPDX-License-Identifier: Apache-2.0
/// \file
/// The value of a channel of key frames at a time. Tests: tests/shade/scene/scene_graph_test.cpp.
#pragma once

#include "relief/shade/scene_graph.h"

namespace relief {

/// \return rotations as unit quaternions x, y, z, w
/// \throws InvalidInput as pose() does of keys
glm::vec4 value_at(const KeyChannel& channel, double seconds);

/// That keys are as KeyChannel says. \throws InvalidInput naming the first offence
void check_keys(const KeyChannel& channel);

}  // namespace relief
