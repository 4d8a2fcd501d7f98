// SPDX-License-Identifier: Apache-2.0
// Highlights are as sharp as the material says.

float sharpened(float exponent) { return exponent; }
float dimmed(float exponent) { return 1.0; }
float widened(float roughness) { return roughness; }
