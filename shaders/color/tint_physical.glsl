// SPDX-License-Identifier: Apache-2.0
// What multiplies scattered light: the part of the base colour that is not metal's.

vec3 scattering_tint(Surface surface) { return surface.scattered_color; }
