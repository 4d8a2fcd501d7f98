// SPDX-License-Identifier: Apache-2.0
// No lamp falls off with distance.

float falloff(float distance_squared, float law) { return 1.0; }
