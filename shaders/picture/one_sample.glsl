// SPDX-License-Identifier: Apache-2.0
// One sample a pixel.

uniform sampler2D drawn;

const int sample_count = 1;

vec4 drawn_sample(int i) { return texelFetch(drawn, ivec2(gl_FragCoord.xy), 0); }
