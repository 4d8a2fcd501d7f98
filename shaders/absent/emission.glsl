// SPDX-License-Identifier: Apache-2.0
// The surface has no light of its own.

vec3 emitted_radiance() { return vec3(0.0); }
