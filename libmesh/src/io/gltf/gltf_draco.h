// SPDX-License-Identifier: Apache-2.0
/// \file
/// Primitives that KHR_draco_mesh_compression has compressed.
/// Tests: tests/mesh/io/gltf/gltf_draco_test.cpp.
#pragma once

#include "io/gltf/gltf_contents.h"
#include "relief/mesh/report.h"

namespace relief {

/// Decodes every primitive whose plain data is not there.
///
/// Its accessors then have data in their own types, min and max of what was decoded, and nothing
/// says any more that it was compressed; a primitive whose plain data is there as well keeps both.
/// Nothing happens, and nothing is paid, where there are no such primitives.
/// \param report  counts accessors whose count is not that of the data: the data's is taken
/// \throws InvalidInput naming the primitive, if its data is damaged, holds points instead of
///         triangles, or does not have what its attributes name
void unpack_draco(GltfContents& contents, Report& report);

}  // namespace relief
