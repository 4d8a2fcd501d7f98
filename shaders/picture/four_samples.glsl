// SPDX-License-Identifier: Apache-2.0
// Four samples a pixel.

uniform sampler2DMS drawn;

const int sample_count = 4;

vec4 drawn_sample(int i) { return texelFetch(drawn, ivec2(gl_FragCoord.xy), i); }
