// SPDX-License-Identifier: Apache-2.0
// Soft shadows of the main light, from shadow maps: one for each place on the light.
// libshade/src/effects/light_rows.h describes them. Source: [Williams 1978].

//@part pass implements pass_shadow
// Vertex stage: the place in the map of the middle of the light, homogeneous. The matrix is multiplied
// in double precision, so that models far from the origin have sharp shadows.

uniform mat4 shadow_from_object;

out vec4 shadow_place;

void pass_shadow() { shadow_place = shadow_from_object * vec4(position_deformed, 1.0); }

//@neutral pass_shadow
void pass_shadow() {}

//@part place implements shadow_place
// Fragment stage: the same place, interpolated.

in vec4 shadow_place;

vec4 place_seen() { return shadow_place; }

//@part displaced_place implements shadow_place
// Fragment stage: the place of the point of the relief that the view meets (height_march.glsl). It is
// beyond the surface by a multiple of the vector to the eye.

//@include "inputs.glsl#eye"

in vec4 shadow_place;

uniform mat4 shadow_from_world;

vec4 place_seen() {
    vec3 nearer = view_texels.z * plane_depth(relief_depth) * to_eye(position_world);
    return shadow_place - shadow_from_world * vec4(nearer, 0.0);
}

//@neutral shadow_place
// The vertex stage has written shadow_place in pass_shadow().

vec4 place_seen() { return shadow_place; }

//@part visible_share
// The share of the main light that reaches the surface. The surface is lifted along its normal, so
// that it does not shade itself. Each lookup compares with the four nearest texels.

//@include <shadow_place>

uniform mat4 shadow_lift;
uniform vec2 shadow_shift;
uniform int shadow_samples;
uniform vec4 shadow_points[8];  // Two places on the light in each.
uniform sampler2DArrayShadow shadow_maps;

float visible_share(Surface surface) {
    vec4 place = place_seen() + shadow_lift * vec4(surface.normal_world, 0.0);
    vec3 middle = place.xyz / place.w;
    float shift = dot(shadow_shift, place.zw) / place.w;
    float share = 0.0;
    for (int i = 0; i < shadow_samples; ++i) {
        vec4 points = shadow_points[i / 2];
        vec2 point = i % 2 == 0 ? points.xy : points.zw;
        share += texture(shadow_maps, vec4(middle.xy + point * shift, float(i), middle.z));
    }
    bool is_in_front = shadow_samples > 0 && place.w > 0.0;
    return is_in_front ? share / float(shadow_samples) : 1.0;
}

//@part directional implements directional_shadow
// The main light is the first directional light.

//@include "shadow.glsl#visible_share"

float directional_share(Surface surface) { return visible_share(surface); }

//@neutral directional_shadow
float directional_share(Surface surface) { return 1.0; }

//@part point implements point_shadow
// The main light is the first point light.

//@include "shadow.glsl#visible_share"

float point_share(Surface surface) { return visible_share(surface); }

//@neutral point_shadow
float point_share(Surface surface) { return 1.0; }

//@part spot implements spot_shadow
// The main light is the first spot light.

//@include "shadow.glsl#visible_share"

float spot_share(Surface surface) { return visible_share(surface); }

//@neutral spot_shadow
float spot_share(Surface surface) { return 1.0; }
