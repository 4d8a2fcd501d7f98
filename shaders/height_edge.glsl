// SPDX-License-Identifier: Apache-2.0
// Silhouettes and depth, which follow from the hit of a relief (height_march.glsl).

//@part clip_both implements relief_edge
// Fragments whose ray leaves the map along an axis that does not repeat are discarded, and those whose
// ray leaves the relief of a curved surface. As with masks (alpha.glsl), this is a last step of a shader.

//@include "height_edge.glsl#left"

void cut_silhouette() {
    if (is_left(relief_depth) || leaves_map(texcoord_surface.x, texcoord_displaced.x) ||
        leaves_map(texcoord_surface.y, texcoord_displaced.y))
        discard;
}

//@part clip_u implements relief_edge
// The same for maps that repeat along v.

//@include "height_edge.glsl#left"

void cut_silhouette() {
    if (is_left(relief_depth) || leaves_map(texcoord_surface.x, texcoord_displaced.x)) discard;
}

//@part clip_v implements relief_edge
// The same for maps that repeat along u.

//@include "height_edge.glsl#left"

void cut_silhouette() {
    if (is_left(relief_depth) || leaves_map(texcoord_surface.y, texcoord_displaced.y)) discard;
}

//@part curved implements relief_edge
// The same for maps that repeat along both axes.

void cut_silhouette() {
    if (is_left(relief_depth)) discard;
}

//@neutral relief_edge
void cut_silhouette() {}

//@part left
// Tells whether a coordinate leaves [0,1] on the way from the surface to the relief.

bool is_outside(float texcoord) { return texcoord < 0.0 || texcoord > 1.0; }

bool leaves_map(float surface, float displaced) {
    return is_outside(displaced) && !is_outside(surface);
}

//@part written implements relief_depth
// The depth buffer gets the depth of the relief, so that other surfaces meet it where it is seen. The
// point of the relief is beyond that of the surface, by a multiple of the vector to the eye.

//@include "inputs.glsl#clip"
//@include "inputs.glsl#eye"

void write_depth() {
    vec4 beyond = -view_texels.z * plane_depth(relief_depth) *
                  (clip_from_world * vec4(to_eye(position_world), 0.0));
    float w = 1.0 / gl_FragCoord.w;
    float clip_depth = 2.0 * gl_FragCoord.z - 1.0;
    gl_FragDepth = gl_FragCoord.z + 0.5 * (beyond.z - clip_depth * beyond.w) / (w + beyond.w);
}

//@neutral relief_depth
void write_depth() {}
