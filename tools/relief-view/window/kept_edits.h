// SPDX-License-Identifier: Apache-2.0
/// \file
/// What panels changed, put onto a scene that was read anew: from a file that changed, or with
/// another map dropped on it. Pure: neither a window nor files.
///
/// Each number that differs between a scene as it was read and as it was edited is an edit. What is
/// as it was read follows the file. The fields that can be edited are those of
/// relief/shade/scene_fields.h.
#pragma once

#include <string>
#include <vector>

#include "relief/shade/scene.h"

namespace relief::tools {

/// How it went.
struct KeptEdits {
    std::size_t kept = 0;           ///< Numbers that were put onto the fresh scene.
    std::vector<std::string> lost;  ///< What is edited no more, and why: for the notes.
};

/// Materials are found again by name; those without one by their place, where they are as many.
/// Lights of a kind are found by their place, where they are as many; those that were added stay
/// added, and those removed removed where the file's are as they were. A texture, normal map or
/// bump map that was put in or taken out stays so unless another one has come there meanwhile.
///
/// \param read    the scene as it was read
/// \param edited  the same with edits
/// \param fresh   as it is read now; gets the edits
KeptEdits keep_edits(const Scene& read, const Scene& edited, Scene& fresh);

}  // namespace relief::tools
