// SPDX-License-Identifier: Apache-2.0
// No vertex colours: nothing is tinted.

vec3 vertex_tint() { return vec3(1.0); }
