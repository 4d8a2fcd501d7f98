// SPDX-License-Identifier: Apache-2.0
/// \file
/// Headers of third parties and of the standard library that nearly every file includes, compiled
/// once for each kind of target (cmake/relief.cmake: relief_precompile). Files include what they
/// use all the same: builds with RELIEF_PCH=OFF, the debug preset's among them, have none of this.
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
