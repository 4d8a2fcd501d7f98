// SPDX-License-Identifier: Apache-2.0
// No diffuse texture: nothing is tinted.

vec4 diffuse_texel() { return vec4(1.0); }
