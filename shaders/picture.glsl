// SPDX-License-Identifier: Apache-2.0
// The finishing pass: averages the drawn samples of each pixel over the background.

//@part vertex
// One triangle over the whole picture. Needs no vertex attributes.

void main() {
    vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    gl_Position = vec4(corner, 0.0, 1.0);
}

//@part fragment
// Each sample is exposed, tone-mapped and composited over the background; the samples are averaged
// in linear light and then coded. Their colors are premultiplied by alpha, since a sample without
// coverage has no color.

out vec4 color;

uniform vec4 background;  // As shown: linear, premultiplied by alpha.

//@include <samples>
//@include <output>

vec4 over_background(vec4 drawn) {
    vec3 radiance = drawn.a > 0.0 ? drawn.rgb / drawn.a : vec3(0.0);
    return vec4(shown(radiance) * drawn.a, drawn.a) + background * (1.0 - drawn.a);
}

void main() {
    vec4 sum = vec4(0.0);
    for (int i = 0; i < sample_count; ++i) sum += over_background(drawn_sample(i));
    vec3 average = sum.a > 0.0 ? sum.rgb / sum.a : vec3(0.0);
    color = vec4(code_of(average), sum.a / float(sample_count));
}

//@part one_sample implements samples
// One sample per pixel.

uniform sampler2D drawn;

const int sample_count = 1;

vec4 drawn_sample(int i) { return texelFetch(drawn, ivec2(gl_FragCoord.xy), 0); }

//@part four_samples implements samples
// Four samples per pixel.

uniform sampler2DMS drawn;

const int sample_count = 4;

vec4 drawn_sample(int i) { return texelFetch(drawn, ivec2(gl_FragCoord.xy), i); }

//@part four_texels implements samples
// Four samples per pixel, drawn as a picture of twice the width and height: GLSL ES has no textures of
// several samples.

uniform sampler2D drawn;

const int sample_count = 4;

vec4 drawn_sample(int i) {
    return texelFetch(drawn, 2 * ivec2(gl_FragCoord.xy) + ivec2(i % 2, i / 2), 0);
}
