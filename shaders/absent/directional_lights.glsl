// SPDX-License-Identifier: Apache-2.0
// No directional light reaches the surface.

void add_directional_lights(Surface surface, inout Lighting lighting) {}
