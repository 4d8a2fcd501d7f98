// SPDX-License-Identifier: Apache-2.0
// What light does at one point: before the surface's tint, and as highlights.

struct Lighting {
    vec3 scattered;
    vec3 highlights;
};
