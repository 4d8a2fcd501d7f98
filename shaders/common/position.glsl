// SPDX-License-Identifier: Apache-2.0
// Where the fragment is.

in vec3 position_world;
