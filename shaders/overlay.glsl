// SPDX-License-Identifier: Apache-2.0
// Points, lines and wireframes over a finished picture, in colors that are already coded as it is.

//@part vertex

in vec3 position_object;

uniform mat4 clip_from_object;

//@include <overlay_color>
//@include <morphing>
//@include <skinning>

void main() {
    vec3 position = skinned_point(morphed(position_object, gl_VertexID, 0), gl_VertexID);
    gl_Position = clip_from_object * vec4(position, 1.0);
    pass_overlay_color();
}

//@part fragment

in vec3 overlay_color;
out vec4 color;

//@include <shape>

void main() {
    cut();
    color = vec4(overlay_color, 1.0);
}

//@part one_color implements overlay_color
// All vertices have one color.

out vec3 overlay_color;

uniform vec3 all_color;

void pass_overlay_color() { overlay_color = all_color; }

//@part vertex_color implements overlay_color
// Each vertex has its own color, and is a point of 9 pixels where shaders say so (WebGL; marker_pixels).

in vec4 color_linear;
out vec3 overlay_color;

void pass_overlay_color() {
    overlay_color = color_linear.rgb;
    gl_PointSize = 9.0;
}

//@part disc implements shape
// The square of a point is cut to a disc.

void cut() {
    vec2 from_center = 2.0 * gl_PointCoord - vec2(1.0);
    if (dot(from_center, from_center) > 1.0) discard;
}

//@neutral shape
void cut() {}
