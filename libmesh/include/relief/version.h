// SPDX-License-Identifier: Apache-2.0
/// \file
/// The version of relief, by Semantic Versioning; between two releases, the next one with "-dev".
/// CMakeLists.txt reads RELIEF_VERSION from here.
#pragma once

#define RELIEF_VERSION "1.1.0-dev"
#define RELIEF_VERSION_MAJOR 1
#define RELIEF_VERSION_MINOR 1
#define RELIEF_VERSION_PATCH 0
