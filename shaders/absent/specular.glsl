// SPDX-License-Identifier: Apache-2.0
// The surface has no highlights.

vec3 specular_highlight(Surface surface, vec3 light_world) { return vec3(0.0); }
