// SPDX-License-Identifier: Apache-2.0
// max(a.b, 0)^exponent of unit vectors, for exponents from 0 to 1e6; x^0 is 1, also for x = 0.
// Near a = b the cosine's distance to 1 is taken from |a - b| (1 - a.b = |a - b|^2 / 2) and its
// logarithm from a series, since a float next to 1 is too coarse for large exponents.

float cosine_power(vec3 a, vec3 b, float exponent) {
    float cosine = dot(a, b);
    if (!(cosine > 0.0)) return exponent == 0.0 ? 1.0 : 0.0;
    vec3 between = a - b;
    float gap = 0.5 * dot(between, between);
    float log_near = -gap * (1.0 + gap * (0.5 + gap * 0.33333333));
    return exp(exponent * (gap < 0.01 ? log_near : log(min(cosine, 1.0))));
}
