// SPDX-License-Identifier: Apache-2.0
// Vertices of a shaded surface: the position in clip space, and everything that the fragment stage
// needs. The effect plan chooses the code of every pass_...(); an unneeded one is empty. Morph
// targets, then joints deform the vertex; a mesh at rest has no code for it.
// clip_from_object is multiplied in double precision, so that models far from the origin keep their
// shape.

in vec3 position_object;

uniform mat4 clip_from_object;

//@include <morphing>
//@include <skinning>

// In object space.
vec3 position_deformed = skinned_point(morphed(position_object, gl_VertexID, 0), gl_VertexID);

//@include <pass_position>
//@include <pass_normal>
//@include <pass_texcoord>
//@include <pass_texcoord_2>
//@include <pass_color>
//@include <pass_occlusion>
//@include <pass_shadow>
//@include <pass_lights>

void main() {
    gl_Position = clip_from_object * vec4(position_deformed, 1.0);
    pass_position();
    pass_normal();
    pass_texcoord();
    pass_texcoord_2();
    pass_color();
    pass_occlusion();
    pass_shadow();
    pass_lights();
}
