// SPDX-License-Identifier: Apache-2.0
// No point light reaches the surface.

void add_point_lights(Surface surface, inout Lighting lighting) {}
