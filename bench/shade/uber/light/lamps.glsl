// SPDX-License-Identifier: Apache-2.0
// All lamps, those of a kind behind a branch; directional ones are on unless switched off.

#include <directional_lights>
#include <point_lights>
#include <spot_lights>

uniform int use_point_lights;
uniform int use_spot_lights;

void add_lamps(Surface surface, inout Lighting lighting) {
    add_directional_lights(surface, lighting);
    if (use_point_lights != 0) add_point_lights(surface, lighting);
    if (use_spot_lights != 0) add_spot_lights(surface, lighting);
}
