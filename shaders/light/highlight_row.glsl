// SPDX-License-Identifier: Apache-2.0
// The row after a lamp's own: its colour for highlights.

vec3 highlight_power(int row, vec3 power) { return light_row(row).rgb; }
