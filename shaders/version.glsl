// SPDX-License-Identifier: Apache-2.0
// The differences between the versions of GLSL: 330 core, and 300 es, which WebGL 2 has.

//@part es_precision
// The highest precision for all numbers and lookups; 330 core has no other.

precision highp float;
precision highp int;
precision highp sampler2D;
precision highp samplerCube;
precision highp sampler2DArrayShadow;

//@part es_buffers implements buffers
// 300 es has no buffer textures: the texels are in the rows of a texture.

#define samplerBuffer sampler2D

vec4 buffer_texel(sampler2D rows, int index) {
    int width = textureSize(rows, 0).x;
    return texelFetch(rows, ivec2(index % width, index / width), 0);
}

//@neutral buffers
#define buffer_texel texelFetch
