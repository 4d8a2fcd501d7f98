// SPDX-License-Identifier: Apache-2.0
// Where the fragment is in its textures.

in vec2 texcoord_surface;
