// SPDX-License-Identifier: Apache-2.0
// The environment mirrored by the surface. with_reflection() weighs the mirror image against the
// scattered and the refracted light.

//@part phong implements reflection
// Phong's surfaces: the mirror image gets Fresnel's factor, and scattering and refraction get the
// rest. The lookup is in world space. Source: [Blinn and Newell 1976].

//@include <fresnel>
//@include <mirror_image>
//@include <reflected_direction>
//@include <refraction>

vec3 with_reflection(Surface surface, vec3 scattered) {
    vec3 fresnel = fresnel_factor(surface);
    return with_refraction(surface, scattered) * (vec3(1.0) - fresnel) +
           mirror_image(reflected_direction(surface)) * fresnel;
}

//@part metallic_roughness implements reflection
// glTF's surfaces: the blurred environment, weighted by the share that GGX facets mirror.
// Source: [Karis, SIGGRAPH 2013].

//@include "environment.glsl#brdf"
//@include "environment.glsl#blurred"
//@include <bounced_light>
//@include <mirror_normal>
//@include <occlusion>

vec3 with_reflection(Surface surface, vec3 scattered) {
    vec3 mirrored_world = reflect(-surface.view_world, mirror_normal(surface));
    vec3 around = blurred_radiance(mirrored_world, surface.roughness) * occlusion();
    vec3 mirrored = mirrored_albedo(surface);
    return with_bounced_light(surface, mirrored, scattered + around * mirrored);
}

//@part refraction_only implements reflection
// The surface refracts the environment and mirrors nothing.

//@include <refraction>

vec3 with_reflection(Surface surface, vec3 scattered) {
    return with_refraction(surface, scattered);
}

//@neutral reflection
vec3 with_reflection(Surface surface, vec3 scattered) { return scattered; }

//@part by_normal implements reflected_direction
// The environment along the normal.

vec3 reflected_direction(Surface surface) { return surface.normal_world; }

//@neutral reflected_direction
vec3 reflected_direction(Surface surface) {
    return reflect(-surface.view_world, surface.normal_world);
}

//@part mirror implements mirror_image
// A sharp mirror image.

//@include "environment.glsl#radiance"

vec3 mirror_image(vec3 direction_world) { return environment_radiance(direction_world); }

//@part glossy implements mirror_image
// A mirror image blurred by a constant roughness.

//@include "environment.glsl#blurred"

uniform float reflection_roughness;

vec3 mirror_image(vec3 direction_world) {
    return blurred_radiance(direction_world, reflection_roughness);
}
