// SPDX-License-Identifier: Apache-2.0
// Vertex attributes that the fragment stage needs, transformed to world space.

//@part position implements pass_position
// The position in world space: for point and spot lights, and for the direction to the eye.

out vec3 position_world;

uniform mat4 world_from_object;

void pass_position() { position_world = vec3(world_from_object * vec4(position_deformed, 1.0)); }

//@neutral pass_position
void pass_position() {}

//@part normal implements pass_normal
// The normal in world space, unit length at the vertex. The matrix is the inverse transpose of the
// object's, up to a positive factor; for a singular matrix it is the limit of that. A zero or
// non-finite normal is passed as 0, so that it does not contribute between vertices.

//@include "vector.glsl#normalized_or"

in vec3 normal_object;
out vec3 normal_world;

uniform mat3 world_from_object_normal;

//@include <deformed_normal>

void pass_normal() {
    normal_world = normalized_or(world_from_object_normal * deformed_normal(), vec3(0.0));
}

//@part normal_and_tangent implements pass_normal
// Normal and tangent in world space, unit length at the vertex, for a tangent-space normal map. The
// interpolated vectors are used without normalization: bakers assume that basis (MikkTSpace).
// handedness is -1 if the object's matrix mirrors, else +1.

//@include "vector.glsl#normalized_or"

in vec3 normal_object;
in vec4 tangent_object;
out vec3 normal_world;
out vec4 tangent_world;

uniform mat3 world_from_object_normal;
uniform mat3 world_from_object_tangent;
uniform float handedness;

//@include <deformed_normal>
//@include <deformed_tangent>

void pass_normal() {
    normal_world = normalized_or(world_from_object_normal * deformed_normal(), vec3(0.0));
    tangent_world.xyz = normalized_or(world_from_object_tangent * deformed_tangent(), vec3(0.0));
    tangent_world.w = tangent_object.w * handedness;
}

//@neutral pass_normal
void pass_normal() {}

//@part texcoord implements pass_texcoord
// Texture coordinates: (0,0) is the image's upper left corner, v grows downwards.

in vec2 texcoord;
out vec2 texcoord_surface;

void pass_texcoord() { texcoord_surface = texcoord; }

//@neutral pass_texcoord
void pass_texcoord() {}

//@part texcoord_2 implements pass_texcoord_2
// The second texture coordinates.

in vec2 texcoord_2;
out vec2 texcoord_surface_2;

void pass_texcoord_2() { texcoord_surface_2 = texcoord_2; }

//@neutral pass_texcoord_2
void pass_texcoord_2() {}

//@part color implements pass_color
// The vertex color, linear, and its alpha, as their distance from white: a rasterizer interpolates
// 0 exactly, but 1 as 1 - 6e-8, which would let a mask with cutoff 1 cut holes.

in vec4 color_linear;
out vec4 color_from_white;

void pass_color() { color_from_white = color_linear - vec4(1.0); }

//@neutral pass_color
void pass_color() {}

//@part morphing implements morphing
// Adds the displacements of the morph targets whose weight is not 0. Texels of morph_weights:
// (weight, number of the target). Texels of morph_displacements: for each target and vertex the
// components 0: position, 1: normal, 2: tangent, as far as any target has them.

//@include <buffers>

uniform samplerBuffer morph_weights;
uniform samplerBuffer morph_displacements;
uniform ivec3 morph_layout;  // Targets with a weight, texels of a target, texels of a vertex.

vec3 morphed(vec3 at_rest, int vertex, int component) {
    if (component >= morph_layout.z) return at_rest;
    for (int i = 0; i < morph_layout.x; ++i) {
        vec2 target = buffer_texel(morph_weights, i).xy;
        int texel = int(target.y) * morph_layout.y + vertex * morph_layout.z + component;
        at_rest += target.x * buffer_texel(morph_displacements, texel).xyz;
    }
    return at_rest;
}

//@neutral morphing
vec3 morphed(vec3 at_rest, int vertex, int component) { return at_rest; }

//@part skinning implements skinning
// Moves a vertex by the weighted mean of the matrices of its joints (linear blend skinning). Texels
// of joint_matrices: three rows for each joint. Texels of joint_weights: (joint, weight, joint,
// weight), joint_pairs of them for each vertex; the weights of a vertex add up to 1 exactly, so that
// joints at rest change no bit. Source: glTF 2.0, section 3.7.3.3.

//@include <buffers>

uniform samplerBuffer joint_matrices;
uniform samplerBuffer joint_weights;
uniform int joint_pairs;

void add_joint(float joint, float weight, inout mat3x4 sum) {
    int row = 3 * int(joint);
    sum[0] += weight * buffer_texel(joint_matrices, row);
    sum[1] += weight * buffer_texel(joint_matrices, row + 1);
    sum[2] += weight * buffer_texel(joint_matrices, row + 2);
}

mat3x4 skin_of(int vertex) {
    if (joint_pairs == 0) return mat3x4(1.0);
    mat3x4 sum = mat3x4(0.0);
    for (int i = 0; i < joint_pairs; ++i) {
        vec4 pair = buffer_texel(joint_weights, vertex * joint_pairs + i);
        add_joint(pair.x, pair.y, sum);
        add_joint(pair.z, pair.w, sum);
    }
    return sum;
}

mat3x4 skin = skin_of(gl_VertexID);  // The rows of the matrix of this vertex.

vec3 skinned_point(vec3 point, int vertex) {
    mat3x4 rows = vertex == gl_VertexID ? skin : skin_of(vertex);
    return vec4(point, 1.0) * rows;
}

//@neutral skinning
vec3 skinned_point(vec3 point, int vertex) { return point; }

//@part skinned_directions implements skinned_directions
// The axes of the skin, scaled to a largest element of 1, so that their products fit a float.

mat3 skin_axes() {
    mat3 rows = mat3(skin);
    vec3 of_columns = max(max(abs(rows[0]), abs(rows[1])), abs(rows[2]));
    float largest = max(max(of_columns.x, of_columns.y), of_columns.z);
    return transpose(largest > 0.0 ? rows / largest : rows);
}

vec3 skinned_tangent(vec3 tangent) { return skin_axes() * tangent; }

// Cofactors keep normals perpendicular; a mirroring matrix would turn them inside out.
vec3 skinned_normal(vec3 normal) {
    mat3 axes = skin_axes();
    mat3 cofactors = mat3(cross(axes[1], axes[2]), cross(axes[2], axes[0]), cross(axes[0], axes[1]));
    return (dot(axes[0], cofactors[0]) < 0.0 ? -1.0 : 1.0) * (cofactors * normal);
}

//@neutral skinned_directions
vec3 skinned_normal(vec3 normal) { return normal; }
vec3 skinned_tangent(vec3 tangent) { return tangent; }

//@part deformed_normal implements deformed_normal
// The deformed normal; that at rest if it loses its length.

//@include "vector.glsl#normalized_or"
//@include <skinned_directions>

vec3 deformed_normal() {
    vec3 normal = skinned_normal(morphed(normal_object, gl_VertexID, 1));
    return has_direction(normal) ? normal : normal_object;
}

//@part facet_normal implements deformed_normal
// The normal of the deformed triangle, for meshes with flat normals, in which no two triangles share
// a vertex. Texels of facet_corners: for each vertex the two next corners of its triangle at rest,
// and their numbers.

//@include "vector.glsl#normalized_or"
//@include "vector.glsl#rescaled"
//@include <skinned_directions>
//@include <buffers>

uniform samplerBuffer facet_corners;

vec3 edge_to(vec4 corner) {
    int vertex = int(corner.w);
    return rescaled(skinned_point(morphed(corner.xyz, vertex, 0), vertex) - position_deformed);
}

vec3 deformed_normal() {
    vec3 across = cross(edge_to(buffer_texel(facet_corners, 2 * gl_VertexID)),
                        edge_to(buffer_texel(facet_corners, 2 * gl_VertexID + 1)));
    if (has_direction(across)) return across;
    vec3 normal = skinned_normal(morphed(normal_object, gl_VertexID, 1));
    return has_direction(normal) ? normal : normal_object;
}

//@neutral deformed_normal
vec3 deformed_normal() { return normal_object; }

//@part deformed_tangent implements deformed_tangent
// The deformed tangent; that at rest if it loses its length.

//@include "vector.glsl#normalized_or"
//@include <skinned_directions>

vec3 deformed_tangent() {
    vec3 tangent = skinned_tangent(morphed(tangent_object.xyz, gl_VertexID, 2));
    return has_direction(tangent) ? tangent : tangent_object.xyz;
}

//@neutral deformed_tangent
vec3 deformed_tangent() { return tangent_object.xyz; }
