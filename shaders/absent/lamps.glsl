// SPDX-License-Identifier: Apache-2.0
// No lamp reaches the surface, or it does nothing with their light.

void add_lamps(Surface surface, inout Lighting lighting) {}
