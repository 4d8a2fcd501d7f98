// SPDX-License-Identifier: Apache-2.0
// An exercise (../reflection-mapping.json): a part of shaders/reflection.glsl with a hole.

//@part phong implements reflection
// The mirror image gets Fresnel's factor, and scattering gets the rest.

//@include <fresnel>
//@include <mirror_image>
//@include <reflected_direction>
//@include <refraction>

vec3 with_reflection(Surface surface, vec3 scattered) {
    vec3 fresnel = fresnel_factor(surface);
    // TODO: add the mirror image of the environment.
    return scattered;
}
