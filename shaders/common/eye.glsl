// SPDX-License-Identifier: Apache-2.0
// Where the picture is seen from.

uniform vec3 eye_world;
