// SPDX-License-Identifier: Apache-2.0
// No light has a range.

float within_range(float distance_squared, float inverse_range) { return 1.0; }
