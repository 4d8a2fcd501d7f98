// SPDX-License-Identifier: Apache-2.0
// No spot light reaches the surface.

void add_spot_lights(Surface surface, inout Lighting lighting) {}
