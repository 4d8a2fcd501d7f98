// SPDX-License-Identifier: Apache-2.0
// No vertex colours: nothing is tinted.

vec4 vertex_tint() { return vec4(1.0); }
