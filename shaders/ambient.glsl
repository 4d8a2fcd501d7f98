// SPDX-License-Identifier: Apache-2.0
// Ambient light: the same from all directions.

//@part phong implements ambient
// The material's share of the scene's ambient light, scattered.

//@include "inputs.glsl#ambient"
//@include <occlusion>
//@include <term_limit>

void add_ambient(Surface surface, inout Lighting lighting) {
    lighting.scattered += limited(ambient_scattered) * occlusion();
}

//@part metallic_roughness implements ambient
// Ambient light both scatters and mirrors.

//@include "inputs.glsl#ambient"
//@include <film>
//@include <occlusion>

void add_ambient(Surface surface, inout Lighting lighting) {
    vec3 received = ambient_scattered * occlusion();
    lighting.scattered += received;
    lighting.highlights += received * with_film(surface, 1.0, 1.0, surface.f0);
}

//@neutral ambient
void add_ambient(Surface surface, inout Lighting lighting) {}

//@part occlusion implements occlusion
// The share of ambient and environment light that arrives: the texture's red, weighted by the
// material's strength, times that of the vertices.

//@include "inputs.glsl#texcoord"
//@include <open_share>

uniform sampler2D occlusion_texture;
uniform float occlusion_strength;

float occlusion_lookup = texture(occlusion_texture, texcoord_surface).r;

float occlusion() {
    float share = 1.0 + occlusion_strength * (occlusion_lookup - 1.0);
    return share * open_share();
}

//@part occlusion_by_vertex implements occlusion
// The share of the vertices alone.

//@include <open_share>

float occlusion() { return open_share(); }

//@neutral occlusion
float occlusion() { return 1.0; }

//@part open_share implements open_share
// The share of ambient and environment light that arrives, interpolated between vertices: 1 minus the
// hidden share, because interpolation of zeros is exact.

in float hidden_share;

float open_share() { return 1.0 - hidden_share; }

//@neutral open_share
float open_share() { return 1.0; }

//@part pass_occlusion implements pass_occlusion
// Vertex stage: the hidden share of the vertex.

//@include <buffers>

uniform samplerBuffer hidden_shares;

out float hidden_share;

void pass_occlusion() { hidden_share = buffer_texel(hidden_shares, gl_VertexID).r; }

//@neutral pass_occlusion
void pass_occlusion() {}
