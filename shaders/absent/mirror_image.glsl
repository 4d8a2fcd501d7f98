// SPDX-License-Identifier: Apache-2.0
// A view of what the mirror image dims: black, so that only its share of the light is missing.

vec3 mirror_image(vec3 mirrored_world) { return vec3(0.0); }
