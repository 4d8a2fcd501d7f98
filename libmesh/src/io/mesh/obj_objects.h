// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which object of an OBJ file a face belongs to. Tests: tests/mesh/io/mesh/obj_objects_test.cpp.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/mesh/obj_parser.h"

namespace relief {

/// Those that have faces, in order of first use; the same name is the same object.
struct ObjObjects {
    std::vector<std::string> names;
    std::vector<std::uint32_t> of_face;  ///< Empty where there is at most one name.
};

/// By o, or in a file without o by g; "" for faces before any. No names where there is neither.
ObjObjects objects_of(const ObjStatements& statements);

}  // namespace relief
