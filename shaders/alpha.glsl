// SPDX-License-Identifier: Apache-2.0
// The surface's coverage.

//@part product
// The product of everything that alpha depends on.

//@include <diffuse_texture>
//@include <vertex_color>
//@include <opacity_texture>

uniform float opacity;

float alpha_product() {
    return opacity * diffuse_texel().a * vertex_tint().a * opacity_texel();
}

//@part mask implements alpha
// Fragments with an alpha below the cutoff, or NaN, are discarded. This ends a shader, but for the
// silhouettes of reliefs: the neighbors of a discarded fragment have no derivatives.

//@include "alpha.glsl#product"

uniform float alpha_cutoff;

float alpha_here() { return 1.0; }

void cut_holes() {
    if (!(alpha_product() >= alpha_cutoff)) discard;
}

//@part blend implements alpha
// The surface covers its background by alpha; NaN counts as 0.

//@include "alpha.glsl#product"

float alpha_here() {
    float alpha = alpha_product();
    return alpha > 0.0 ? min(alpha, 1.0) : 0.0;
}

void cut_holes() {}

//@neutral alpha
float alpha_here() { return 1.0; }
void cut_holes() {}

//@part opacity_texture implements opacity_texture
// The red channel of the opacity texture.

//@include "inputs.glsl#texcoord"

uniform sampler2D opacity_texture;

float opacity_lookup = texture(opacity_texture, texcoord_surface).r;

float opacity_texel() { return opacity_lookup; }

//@neutral opacity_texture
float opacity_texel() { return 1.0; }
