// SPDX-License-Identifier: Apache-2.0
// A point's square cut to a disc.

void cut() {
    vec2 from_center = 2.0 * gl_PointCoord - vec2(1.0);
    if (dot(from_center, from_center) > 1.0) discard;
}
