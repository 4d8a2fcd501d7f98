// SPDX-License-Identifier: Apache-2.0
// The environment lights no surface.

void add_environment_light(Surface surface, inout Lighting lighting) {}
