// SPDX-License-Identifier: Apache-2.0
// Averaged samples as a finished picture. They were averaged with alpha multiplied in, since what
// is not covered has no colour; here it is divided out again.

uniform sampler2D averaged;
out vec4 color;

#include <output>

void main() {
    vec4 pixel = texelFetch(averaged, ivec2(gl_FragCoord.xy), 0);
    color = vec4(coded(pixel.a > 0.0 ? pixel.rgb / pixel.a : vec3(0.0)), pixel.a);
}
