// SPDX-License-Identifier: Apache-2.0
// Debug views: the color that a view of data shows, and the terms that a view of one term leaves
// out. relief/shade/debug_views.h defines the views and their colors.

//@part direction_color
// A unit vector as a color; a zero or non-finite vector is mid-gray.

//@include "vector.glsl#normalized_or"

vec3 direction_color(vec3 direction) {
    return 0.5 * normalized_or(direction, vec3(0.0)) + vec3(0.5);
}

//@part normal implements view
// The normal in world space.

//@include "view.glsl#direction_color"
//@include <normal>

vec3 view_color() { return direction_color(shading_normal()); }

//@part tangent implements view
// The tangent in world space.

//@include "view.glsl#direction_color"
//@include <frame>

vec3 view_color() { return direction_color(world_from_tangent()[0]); }

//@part bitangent implements view
// The bitangent in world space.

//@include "view.glsl#direction_color"
//@include <frame>

vec3 view_color() { return direction_color(world_from_tangent()[1]); }

//@part handedness implements view
// The orientation of the tangent frame in world space: one of two colors, or mid-gray if the frame
// is degenerate.

//@include <frame>

vec3 view_color() {
    mat3 frame = world_from_tangent();
    float turn = dot(cross(frame[2], frame[0]), frame[1]);
    if (turn > 0.0) return vec3(0.2, 0.6, 1.0);
    return turn < 0.0 ? vec3(1.0, 0.4, 0.2) : vec3(0.5);
}

//@part texcoords implements view
// The fractions of the texture coordinates, and a checkerboard of 8 x 8 squares in blue.

//@include "inputs.glsl#texcoord"

vec3 view_color() {
    vec2 square = floor(8.0 * texcoord_surface);
    return vec3(fract(texcoord_surface), mod(square.x + square.y, 2.0));
}

//@part normal_map implements view
// The normal in tangent space, from a normal map or a bump map.

//@include "view.glsl#direction_color"
//@include <detail>

vec3 view_color() { return direction_color(normal_tangent()); }

//@part object_normal_map implements view
// The normal in object space, from its map.

//@include "view.glsl#direction_color"
//@include "normal_map.glsl#texel"

vec3 view_color() { return direction_color(normal_texel()); }

//@part height implements view
// The height that a bump map stores.

//@include "inputs.glsl#texcoord"

uniform sampler2D bump_texture;

float height_lookup = texture(bump_texture, texcoord_surface).r;

vec3 view_color() { return vec3(height_lookup); }

//@part overdraw implements view
// One fragment; the framebuffer adds them up.

vec3 view_color() { return vec3(64.0, 16.0, 4.0) / 255.0; }

//@part hatched implements view
// A surface that has nothing to show.

vec3 view_color() {
    float stripe = mod(gl_FragCoord.x + gl_FragCoord.y, 16.0);
    return vec3(stripe < 8.0 ? 51.0 : 77.0) / 255.0;
}

//@part no_scattering implements tint
// A view of glTF's highlights: scattered light is black.

vec3 scattering_tint(Surface surface) { return vec3(0.0); }

//@part no_highlights implements specular_texture
// A view of scattered light in glTF's model: highlights are black.

vec3 specular_texture_color() { return vec3(0.0); }

//@part black_mirror_image implements reflection
// A view of a term that reflections dim: the mirror image is black, and only takes its share.

//@include <fresnel>
//@include <refraction>

vec3 with_reflection(Surface surface, vec3 scattered) {
    return with_refraction(surface, scattered) * (vec3(1.0) - fresnel_factor(surface));
}
