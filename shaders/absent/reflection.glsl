// SPDX-License-Identifier: Apache-2.0
// Nothing is mirrored.

vec3 with_reflection(Surface surface, vec3 scattered) { return scattered; }
