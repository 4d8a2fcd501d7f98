// SPDX-License-Identifier: Apache-2.0
// The inverse square law.

float falloff(float distance_squared, float inverse_range) { return 1.0 / distance_squared; }
