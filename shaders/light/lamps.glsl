// SPDX-License-Identifier: Apache-2.0
// All lamps, at this point.

#include <directional_lights>
#include <point_lights>
#include <spot_lights>

void add_lamps(Surface surface, inout Lighting lighting) {
    add_directional_lights(surface, lighting);
    add_point_lights(surface, lighting);
    add_spot_lights(surface, lighting);
}
