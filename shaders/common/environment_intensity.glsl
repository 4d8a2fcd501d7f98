// SPDX-License-Identifier: Apache-2.0
// What the environment's radiance is multiplied with.

uniform float environment_intensity;
