// SPDX-License-Identifier: Apache-2.0
// One fragment, to be added to those before it.

vec3 view_color() { return vec3(64.0, 16.0, 4.0) / 255.0; }
