// SPDX-License-Identifier: Apache-2.0
/// \file
/// A view that was copied as text, here or elsewhere: the options of a command line that say where
/// the camera stands. Tests: tests/tools/window/pasted_view_test.cpp.
#pragma once

#include <optional>
#include <string>

#include "view_options.h"

namespace relief::tools {

struct PastedView {
    CameraOption camera;
    std::optional<float> vertical_fov;
};

/// \param text  "--camera 30,20@0,0,0,3 --fov 35", with whatever else stands on that line, or only
///              what follows --camera
/// \throws UsageError if it says nothing of a camera, or nothing that can be understood
PastedView pasted_view(const std::string& text);

}  // namespace relief::tools
