// SPDX-License-Identifier: Apache-2.0
// One colour, already coded as the picture is.

in vec3 overlay_color;
out vec4 color;

#include <shape>

void main() {
    cut();
    color = vec4(overlay_color, 1.0);
}
