// SPDX-License-Identifier: Apache-2.0
/// \file
/// Edit rebase: edits of the panels are applied to a scene that was read again, because a file
/// changed or another map was dropped. Each value that differs between the scene as read and the
/// edited scene is an edit. Other values follow the file. The fields are those of
/// relief/shade/scene_fields.h. Tests: tests/tools/window/edit_rebase_test.cpp.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "relief/shade/scene.h"

namespace relief::tools {

/// The result of a rebase.
struct RebasedEdits {
    std::size_t kept = 0;           ///< Number of values that were applied to the fresh scene.
    std::vector<std::string> lost;  ///< Messages about lost edits.
};

/// Materials are matched by name, or by index if they have no name and their number is unchanged.
/// Lights of a kind are matched by index if their number is unchanged. Added lights stay added.
/// Removed lights stay removed if the file's lights are unchanged. A texture, normal map or bump
/// map that was added or removed stays so, unless the file has changed it too.
///
/// \param read  the scene as it was read
/// \param edited  the same scene with edits
/// \param fresh  the scene as it is read now; receives the edits
RebasedEdits rebase_edits(const shade::Scene& read, const shade::Scene& edited,
                          shade::Scene& fresh);

}  // namespace relief::tools
