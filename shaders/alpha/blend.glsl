// SPDX-License-Identifier: Apache-2.0
// The surface covers as much as alpha says; NaN covers nothing.

#include "alpha/product.glsl"

float alpha_here() {
    float alpha = alpha_product();
    return alpha > 0.0 ? min(alpha, 1.0) : 0.0;
}
