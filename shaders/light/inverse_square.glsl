// SPDX-License-Identifier: Apache-2.0
// The inverse square law, for every lamp.

float falloff(float distance_squared, float law) { return 1.0 / distance_squared; }
