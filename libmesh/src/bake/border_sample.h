// SPDX-License-Identifier: Apache-2.0
/// \file
/// Samples on the border of their triangle, moved inside: for the ray that is cast again where the
/// first one slips past an open border.
///
/// A texel that only touches a chart has its nearest point exactly on an edge. Where nothing
/// continues the high mesh beyond that edge, whether a ray through the point meets it hangs on the
/// rounding of the point, of the ray and of Embree's copy of the mesh, all in float. Inside by more
/// than those errors there is no such doubt. Space and unit of the mesh.
/// Tests: tests/mesh/bake/border_sample_test.cpp.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "relief/mesh/mesh.h"
#include "relief/mesh/texel_coverage.h"

namespace relief {

/// The same sample, as far from every edge of its triangle as told; nothing if it already is.
///
/// \param texel     of that mesh
/// \param distance  where the triangle is too small for that, the sample is moved to the centre of
///                  its inscribed circle. A triangle without area, or that is not finite, gives
///                  nothing
///
/// A weight that is too small becomes what the distance asks for; the others give in proportion to
/// what they have too much. So the point moves by little more than the distance, unless the
/// triangle is a sliver.
std::optional<CoveredTexel> moved_inside(const Mesh& mesh, const CoveredTexel& texel,
                                         double distance);

}  // namespace relief
