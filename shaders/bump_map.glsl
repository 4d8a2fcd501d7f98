// SPDX-License-Identifier: Apache-2.0
// Bump maps: textures of heights.

//@part heights implements detail
// The normal in tangent space from a height map: central differences over one texel, or over the
// pixel if that is larger, so that detail finer than a pixel does not flicker. Heights are in
// texels. Source: [Blinn 1978], with a frame of unit vectors so that strength means the same on
// every surface.

//@include "inputs.glsl#texcoord"

uniform sampler2D bump_texture;
uniform float bump_strength;

//@include <bump_lookup>

vec3 normal_of_heights() {
    vec2 size = vec2(textureSize(bump_texture, 0));
    vec2 pixel = max(abs(dFdx(texcoord_surface)), abs(dFdy(texcoord_surface))) * size;
    vec2 reach = max(pixel, vec2(1.0));  // In texels.
    vec2 right = vec2(reach.x / size.x, 0.0);
    vec2 down = vec2(0.0, reach.y / size.y);
    vec2 rise = vec2(height_beside(right) - height_beside(-right),
                     height_beside(-down) - height_beside(down));
    return vec3(-bump_strength * rise / (2.0 * reach), 1.0);
}

vec3 bump_normal = normal_of_heights();

vec3 normal_tangent() { return bump_normal; }

//@part displaced implements bump_lookup
// The height beside the place where the view meets a relief.

float height_beside(vec2 offset) {
    return textureGrad(bump_texture, texcoord_displaced + offset, texcoord_right, texcoord_up).r;
}

//@neutral bump_lookup
float height_beside(vec2 offset) { return texture(bump_texture, texcoord_surface + offset).r; }
