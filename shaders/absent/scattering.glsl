// SPDX-License-Identifier: Apache-2.0
// A view of highlights alone: nothing of what is scattered.

vec3 scattering_tint(Surface surface) { return vec3(0.0); }
