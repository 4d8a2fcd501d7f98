// SPDX-License-Identifier: Apache-2.0
// How much of what is behind it the surface covers.

#include <diffuse_texture>
#include <vertex_color>
#include <opacity_texture>

uniform float opacity;

float alpha_product() {
    return opacity * diffuse_texel().a * vertex_tint().a * opacity_texel();
}
