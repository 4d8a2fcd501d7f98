// SPDX-License-Identifier: Apache-2.0
// Radiance up to white: what a screen can show of each sample, before samples are averaged. Else
// one sample of a bright light would whiten an edge pixel whatever it covers.

#include "common/displayable.glsl"

vec3 coded(vec3 radiance) { return limited(radiance, 1.0); }
