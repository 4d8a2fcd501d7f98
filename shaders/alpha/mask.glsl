// SPDX-License-Identifier: Apache-2.0
// The surface is there where alpha reaches the cutoff; NaN does not.

#include "alpha/product.glsl"

uniform float alpha_cutoff;

float alpha_here() {
    if (!(alpha_product() >= alpha_cutoff)) discard;
    return 1.0;
}
