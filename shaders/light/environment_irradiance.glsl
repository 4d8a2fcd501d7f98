// SPDX-License-Identifier: Apache-2.0
// What the environment sheds on a surface that faces n, over pi, by spherical harmonics of order 2:
// its projection onto nine functions of the direction, each already blurred by the cosine lobe and
// multiplied with its constant. Source: [Ramamoorthi and Hanrahan 2001].

uniform vec4 irradiance_sh[9];

vec3 environment_irradiance(vec3 n) {
    vec3 sum = irradiance_sh[0].rgb + irradiance_sh[1].rgb * n.y + irradiance_sh[2].rgb * n.z +
               irradiance_sh[3].rgb * n.x + irradiance_sh[4].rgb * (n.x * n.y) +
               irradiance_sh[5].rgb * (n.y * n.z) +
               irradiance_sh[6].rgb * (3.0 * n.z * n.z - 1.0) +
               irradiance_sh[7].rgb * (n.x * n.z) +
               irradiance_sh[8].rgb * (n.x * n.x - n.y * n.y);
    return max(sum, vec3(0.0));
}
