// SPDX-License-Identifier: Apache-2.0
// The inverse square law where law is 1, and none where it is 0.

float falloff(float distance_squared, float law) {
    return 1.0 / (law * distance_squared + (1.0 - law));
}
