// SPDX-License-Identifier: Apache-2.0
// Vertices of a shaded surface: to clip space, and each thing that the fragment stage asks for.
// Every pass_...() is chosen by the effect plan; one that nothing needs is in absent/.
// clip_from_object is multiplied out in double precision, so that models far from the origin
// keep their shape.

in vec3 position_object;

uniform mat4 clip_from_object;

#include <pass_position>
#include <pass_normal>
#include <pass_texcoord>
#include <pass_color>
#include <pass_lamps>

void main() {
    gl_Position = clip_from_object * vec4(position_object, 1.0);
    pass_position();
    pass_normal();
    pass_texcoord();
    pass_color();
    pass_lamps();
}
