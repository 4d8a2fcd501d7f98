// SPDX-License-Identifier: Apache-2.0
// The finished picture of drawn samples: each exposed and tone-mapped, laid over the background,
// averaged in linear light, and coded. Samples come with alpha multiplied in, since what is not
// covered has no colour.

out vec4 color;

uniform vec4 background;  // As it is to be seen, linear, alpha multiplied in.

#include <samples>
#include <output>

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
