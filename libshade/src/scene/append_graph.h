// SPDX-License-Identifier: Apache-2.0
/// \file
/// A model hung on a node of a larger scene. Tests: tests/shade/scene/scene_json_test.cpp.
#pragma once

#include <cstddef>

#include "relief/shade/scene_graph.h"

namespace relief {

/// Adds everything of a part but its camera, environment and settings: its world becomes the
/// node's space, and its animations play along. Its ambient light is added.
void append(SceneGraph& graph, SceneGraph part, std::size_t node);

}  // namespace relief
