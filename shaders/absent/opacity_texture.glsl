// SPDX-License-Identifier: Apache-2.0
// No opacity texture.

float opacity_texel() { return 1.0; }
