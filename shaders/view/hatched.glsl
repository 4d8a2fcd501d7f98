// SPDX-License-Identifier: Apache-2.0
// A surface that has nothing to show.

vec3 view_color() {
    float stripe = mod(gl_FragCoord.x + gl_FragCoord.y, 16.0);
    return vec3(stripe < 8.0 ? 51.0 : 77.0) / 255.0;
}
