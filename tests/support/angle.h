// SPDX-License-Identifier: Apache-2.0
/// \file
/// Directions are compared by the angle between them, never by components.
#pragma once

#include "relief/mesh/direction_error.h"

namespace relief::test {

using relief::degrees_between;

}  // namespace relief::test
