// SPDX-License-Identifier: Apache-2.0
// What is drawn over a finished picture: points and lines at their places, or a mesh's triangles.

in vec3 position_object;

uniform mat4 clip_from_object;

#include <overlay_color>

void main() {
    gl_Position = clip_from_object * vec4(position_object, 1.0);
    pass_overlay_color();
}
