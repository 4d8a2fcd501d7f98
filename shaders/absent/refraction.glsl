// SPDX-License-Identifier: Apache-2.0
// Nothing comes through the surface.

vec3 with_refraction(Surface surface, vec3 scattered) { return scattered; }
