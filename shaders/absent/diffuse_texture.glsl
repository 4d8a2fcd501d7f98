// SPDX-License-Identifier: Apache-2.0
// No diffuse texture: nothing is tinted.

vec3 diffuse_texture_color() { return vec3(1.0); }
