// SPDX-License-Identifier: Apache-2.0
// Highlights have the colour of the lamp's light.

vec3 highlight_power(int row, vec3 power) { return power; }
