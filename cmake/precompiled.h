// SPDX-License-Identifier: Apache-2.0
/// \file
/// Headers of third parties and of the standard library that nearly every file includes, compiled
/// once for each kind of target (cmake/relief.cmake: relief_precompile). Files include what they
/// use nevertheless: builds with RELIEF_PCH=OFF, such as the debug preset, do not use this file.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>
