// SPDX-License-Identifier: Apache-2.0
// A surface that lets through and mirrors nothing.

#include <refraction>

vec3 with_reflection(Surface surface, vec3 scattered) {
    return with_refraction(surface, scattered);
}
