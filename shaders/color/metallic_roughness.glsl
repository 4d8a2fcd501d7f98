// SPDX-License-Identifier: Apache-2.0
// Metallic and roughness, the same all over.

uniform float metallic;
uniform float roughness;

vec2 metallic_and_roughness() { return vec2(metallic, roughness); }
