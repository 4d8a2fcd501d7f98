// SPDX-License-Identifier: Apache-2.0
// Relief mapping: textures are looked up where the ray of view meets a relief below the surface. The
// assembly of a shader changes its lookups at texcoord_surface to the displaced coordinates, with
// the derivatives of the undisplaced ones, so that mip levels do not change at steps of the relief.
//
// Texel space: x and y are texture coordinates times the size of the height map, and depth is in
// texels below the surface of white, where a texel is as long as the square root of its area on the
// triangle. The ray is at p + k s at depth s. A triangle maps the plane affinely to texture
// coordinates, so that the differences between pixels give this map exactly, also where it mirrors
// or stretches. Above a curved surface (height_curve.glsl), s is the way of the ray, and its depth is
// ray_depth(s).

//@part displacement implements displacement
// The displaced texture coordinates. Surfaces whose interpolated normal points away from the eye are
// not displaced.

//@include "height_march.glsl#ray"
//@include <ray_curve>
//@include <hit_depth>

float depth_at_hit() {
    return view_texels.z > 0.0 ? hit_depth(texcoord_surface * height_size(), ray_slant()) : 0.0;
}

float relief_depth = depth_at_hit();
vec2 texcoord_displacement = ray_slant() * relief_depth / height_size();
vec2 texcoord_displaced = texcoord_surface + texcoord_displacement;

//@include <displaced_second>

//@neutral displacement
// Textures are looked up at the coordinates of the surface.

//@part ray
// The ray of view in texel space, on the tangent plane.

//@include "inputs.glsl#texcoord"
//@include "inputs.glsl#eye"
//@include "inputs.glsl#normal"
//@include "vector.glsl#normalized_or"
//@include "height_march.glsl#field"
//@include <position>

vec2 texcoord_right = dFdx(texcoord_surface);
vec2 texcoord_up = dFdy(texcoord_surface);
vec3 position_right = dFdx(position_world);
vec3 position_up = dFdy(position_world);

// Returns k for the ray of view, or of light, in a direction of any length. z is the share of the
// direction that one texel of depth is long; 0 if there is no ray.
vec3 ray_texels(vec3 outward_world) {
    vec3 normal = normalized_or(normal_world, vec3(0.0));
    vec2 right = texcoord_right * height_size();
    vec2 up = texcoord_up * height_size();
    float area = right.x * up.y - right.y * up.x;
    // Along a texel of x and of y, times the area.
    vec3 along_x = position_right * up.y - position_up * right.y;
    vec3 along_y = position_up * right.x - position_right * up.x;
    float texel = sqrt(length(cross(along_x, along_y)));
    float turned = dot(normal, cross(along_x, along_y));
    float toward = dot(normal, outward_world);
    vec2 moved = vec2(dot(normal, cross(outward_world, along_y)),
                      dot(normal, cross(along_x, outward_world)));
    vec2 k = -moved * (texel * sign(area) / turned) / toward;
    bool enters = toward > 0.0 && turned != 0.0 && dot(k, k) < 1e12;
    return enters ? vec3(k, texel / (abs(area) * toward)) : vec3(0.0);
}

vec3 view_texels = ray_texels(to_eye(position_world));

//@part second implements displaced_second
// The second texture coordinates, displaced by the same place on the triangle.

vec2 texcoord_right_2 = dFdx(texcoord_surface_2);
vec2 texcoord_up_2 = dFdy(texcoord_surface_2);

vec2 second_displacement() {
    float area = texcoord_right.x * texcoord_up.y - texcoord_right.y * texcoord_up.x;
    if (area == 0.0) return vec2(0.0);
    vec2 d = texcoord_displacement;
    float right = (d.x * texcoord_up.y - d.y * texcoord_up.x) / area;
    float up = (d.y * texcoord_right.x - d.x * texcoord_right.y) / area;
    return right * texcoord_right_2 + up * texcoord_up_2;
}

vec2 texcoord_displaced_2 = texcoord_surface_2 + second_displacement();

//@neutral displaced_second
// No texture is looked up at second texture coordinates.

//@part field
// The heights. Level 0 of the texture has the heights, level n the maxima of its patches: a patch
// lies between the centers of four texels, and its number is that of the upper left one.

uniform sampler2D height_texture;
uniform float height_depth;

vec2 height_size() { return vec2(textureSize(height_texture, 0)); }

//@part below
// How far the point of the ray after the way s is below the relief; negative above it.

//@include "height_march.glsl#field"
//@include <ray_curve>

float below_relief(vec2 p, vec2 k, float s) {
    float height = textureLod(height_texture, (p + k * s) / height_size(), 0.0).r;
    return ray_depth(s) - height_depth * (1.0 - height);
}

//@part parallax implements hit_depth
// One step, to the depth of the relief under the surface point. Source: [Kaneko 2001].

//@include "height_march.glsl#below"

float hit_depth(vec2 p, vec2 k) { return way_to(-below_relief(p, k, 0.0)); }

//@part layers
// Returns the depths of the last layer above the relief and of the first one below it; both are 0 if
// the ray begins below it.

//@include "height_march.glsl#below"

uniform float height_layers;

vec2 depths_around(vec2 p, vec2 k) {
    if (below_relief(p, k, 0.0) >= 0.0) return vec2(0.0);
    float layer = ray_end() / height_layers;
    float s = layer;
    for (float i = 1.0; i < height_layers && below_relief(p, k, s) < 0.0; i += 1.0) s += layer;
    return vec2(s - layer, s);
}

//@part bisection
// Halves the interval between a point above the relief and one below it.

//@include "height_march.glsl#below"

uniform float height_bisections;

float bisected(vec2 p, vec2 k, vec2 around) {
    for (float i = 0.0; i < height_bisections; i += 1.0) {
        float middle = 0.5 * (around.x + around.y);
        around = below_relief(p, k, middle) < 0.0 ? vec2(middle, around.y)
                                                  : vec2(around.x, middle);
    }
    return around.y;
}

//@part parallax_occlusion implements hit_depth
// Layers, then one secant step. Source: [Tatarchuk 2006].

//@include "height_march.glsl#layers"

float hit_depth(vec2 p, vec2 k) {
    vec2 around = depths_around(p, k);
    float above = -below_relief(p, k, around.x);
    float below = below_relief(p, k, around.y);
    float both = above + below;
    if (is_left(around.y) && below < 0.0) return around.y;
    return around.x + (around.y - around.x) * (both > 0.0 ? clamp(above / both, 0.0, 1.0) : 0.0);
}

//@part relief_mapping implements hit_depth
// Layers, then bisection. Source: [Policarpo et al. 2005].

//@include "height_march.glsl#layers"
//@include "height_march.glsl#bisection"

float hit_depth(vec2 p, vec2 k) { return bisected(p, k, depths_around(p, k)); }

//@part relaxed_cones implements hit_depth
// Steps within cones that a ray leaves at its second crossing at the earliest, then bisection. Source:
// [Policarpo and Oliveira 2007].

//@include "height_march.glsl#bisection"

uniform sampler2D cone_texture;
uniform float height_layers;

// Returns the ratio of radius to depth of the cone at a point, both in texels. Cone maps have two
// channels, which are looked up as gray and alpha.
float cone_at(vec2 p) {
    float root = textureLod(cone_texture, p / height_size(), 0.0).a;
    vec2 size = height_size();
    return root * root * max(size.x, size.y) / max(height_depth, 1e-9);
}

float hit_depth(vec2 p, vec2 k) {
    float slant = length(k);
    vec2 around = vec2(0.0);
    for (float i = 0.0; i < height_layers; i += 1.0) {
        float above = -below_relief(p, k, around.y);
        if (above <= 0.0) break;
        float cone = cone_at(p + k * around.y);
        // A cone of no width stops the ray. Bent rays stay within the cone at their largest rate.
        float rate = max(max(ray_rate(around.y), ray_rate(ray_end())), 0.0);
        float deeper = cone > 0.0 ? cone * above / (slant + cone * rate) : 0.0;
        around = vec2(around.y, min(around.y + deeper, ray_end()));
    }
    return bisected(p, k, around);
}

//@part walk
// Steps of a ray from node to node and from patch to patch.

//@include "height_march.glsl#nodes"
//@include <height_columns>
//@include <height_rows>

uniform float height_steps;

const float no_exit = 1e30;

float exit_depth(float from, float rate, float first, float last) {
    if (rate == 0.0) return no_exit;
    return ((rate > 0.0 ? last : first) - from) / rate;
}

vec2 exit_depths(vec2 from, vec2 k, HeightSpan x, HeightSpan y) {
    return vec2(exit_depth(from.x, k.x, float(x.first), float(x.last)),
                exit_depth(from.y, k.y, float(y.first), float(y.last)));
}

ivec2 cell_at(vec2 point, HeightSpan x, HeightSpan y) {
    return clamp(ivec2(floor(point)), ivec2(x.first, y.first), ivec2(x.last, y.last) - 1);
}

// Returns the cell after a node or a patch that the ray leaves at this point.
ivec2 next_cell(vec2 point, vec2 k, HeightSpan x, HeightSpan y, vec2 leaves) {
    ivec2 next = cell_at(point, x, y);
    if (leaves.x <= leaves.y) next.x = k.x > 0.0 ? x.last : x.first - 1;
    if (leaves.y <= leaves.x) next.y = k.y > 0.0 ? y.last : y.first - 1;
    return next;
}

float texel_height(ivec2 texel) { return texelFetch(height_texture, texel, 0).r; }

// Returns the coefficients of the heights of a patch along k: h = x + y d + z d d after the depth d.
vec3 heights_along(vec2 at, vec2 k, ivec2 cell) {
    ivec2 near = ivec2(height_column(cell.x), height_row(cell.y));
    ivec2 far = ivec2(height_column(cell.x + 1), height_row(cell.y + 1));
    float a = texel_height(near);
    float b = texel_height(ivec2(far.x, near.y)) - a;
    float c = texel_height(ivec2(near.x, far.y)) - a;
    float e = texel_height(far) - a - b - c;
    return vec3(a + b * at.x + c * at.y + e * at.x * at.y,
                b * k.x + c * k.y + e * (at.x * k.y + at.y * k.x), e * k.x * k.y);
}

//@part maximum_mipmaps implements hit_depth
// Descent through a pyramid of maximum heights: a node that the ray passes above is skipped. At level
// 0, the ray is intersected with the bilinear patch exactly. After height_steps steps, the point
// reached so far stands in. Source: [Tevs et al. 2008].

//@include "height_march.glsl#walk"

// Returns the way, from `begin` on, at which the ray passes the patch's surface; no_exit if it does
// not. With d the way from `begin`, the distance below the relief is q.x + q.y d + q.z d d.
float patch_depth(vec2 from, vec2 k, ivec2 cell, float begin) {
    vec3 along = heights_along(clamp(from + k * begin - vec2(cell), 0.0, 1.0), k, cell);
    vec3 q = vec3(ray_depth(begin) - height_depth * (1.0 - along.x),
                  ray_rate(begin) + height_depth * along.y, height_depth * along.z - ray_bend());
    if (q.x >= 0.0) return begin;
    float square = q.y * q.y - 4.0 * q.z * q.x;
    float root = q.y + sqrt(max(square, 0.0));
    return square >= 0.0 && root > 0.0 ? begin - 2.0 * q.x / root : no_exit;
}

// Returns the level at which the ray goes on: the next one if it has left the parent.
int level_beyond(ivec2 left, ivec2 cell, int level, int last_level) {
    ivec2 parents = (left ^ cell) >> (level + 1);
    return (parents.x | parents.y) != 0 ? min(level + 1, last_level) : level;
}

// The nodes of the first level are as large as the ray is long, but have at most 8 x 8 patches:
// larger ones are rarely skipped at once.
const int max_first_level = 3;

// Loops test at their end, because processors execute them for all pixels of a group until the last
// one leaves.
float hit_depth(vec2 p, vec2 k) {
    vec2 from = p - 0.5;
    ivec2 cell = ivec2(floor(from));
    int last_level = int(floor(log2(float(max(height_texels.x, height_texels.y)))));
    float last = ray_end();
    float reach = last * max(abs(k.x), abs(k.y)) + 1.0;
    int level = min(int(ceil(log2(reach))), min(max_first_level, last_level));
    float s = 0.0;
    float steps = 0.0;
    bool goes_on = true;
    do {
        do {
            if (level > 0) {
                steps += 1.0;
                HeightSpan x = height_columns(cell.x, level);
                HeightSpan y = height_rows(cell.y, level);
                vec2 leaves = exit_depths(from, k, x, y);
                float end = min(min(leaves.x, leaves.y), last);
                float highest = texelFetch(height_texture, ivec2(x.node, y.node), level).r;
                float top = height_depth * (1.0 - highest);
                bool passes = deepest(s, max(s, end)) < top;
                bool stays = !passes && top <= ray_depth(s);  // Rounding must not lead back to a cell.
                s = max(s, passes ? end : min(way_to(top), end));
                goes_on = steps < height_steps && (!passes || end < last);
                ivec2 left = cell;
                vec2 point = from + k * s;
                if (passes) cell = next_cell(point, k, x, y, leaves);
                else if (!stays) cell = cell_at(point, x, y);
                level = passes ? level_beyond(left, cell, level, last_level) : level - 1;
            }
        } while (level > 0 && goes_on);
        if (goes_on) {
            steps += 1.0;
            HeightSpan x = patch_span(cell.x);
            HeightSpan y = patch_span(cell.y);
            vec2 leaves = exit_depths(from, k, x, y);
            float end = min(min(leaves.x, leaves.y), last);
            float hit = patch_depth(from, k, cell, s);
            goes_on = hit > end && end < last && steps < height_steps;
            s = hit <= end ? hit : max(s, end);
            ivec2 left = cell;
            cell = next_cell(from + k * s, k, x, y, leaves);
            level = level_beyond(left, cell, 0, last_level);
        }
    } while (goes_on);
    return s;
}

//@part nodes
// A node of a level along one axis, and the patches that it covers. Level n has the size of the map
// divided by 2^n, rounded down; the last node covers the remaining patches.

struct HeightSpan {
    int node;
    int first;
    int last;  // Exclusive.
};

const int endless = 1 << 24;

HeightSpan patch_span(int cell) { return HeightSpan(cell, cell, cell + 1); }

HeightSpan node_span(int cell, int size, int level) {
    int last_node = max(size >> level, 1) - 1;
    int node = min(cell >> level, last_node);
    return HeightSpan(node, node << level, node == last_node ? size : (node + 1) << level);
}

HeightSpan moved_span(HeightSpan span, int by) {
    return HeightSpan(span.node, span.first + by, span.last + by);
}

ivec2 height_texels = textureSize(height_texture, 0);
vec2 texel_of_height = 1.0 / vec2(height_texels);

// A cell's middle is too far from a border of periods for rounding of the factor to matter.
int periods_before(int cell, int period, float inverse) {
    return int(floor((float(cell) + 0.5) * inverse)) * period;
}

//@part repeated
// Maps that repeat.

//@include "height_march.glsl#nodes"

int repeated_texel(int texel, int size, float inverse) {
    return texel - periods_before(texel, size, inverse);
}

HeightSpan repeated_span(int cell, int size, int level, float inverse) {
    int before = periods_before(cell, size, inverse);
    return moved_span(node_span(cell - before, size, level), before);
}

//@part clamped
// Maps whose border continues.

//@include "height_march.glsl#nodes"

int clamped_texel(int texel, int size) { return clamp(texel, 0, size - 1); }

HeightSpan clamped_span(int cell, int size, int level) {
    HeightSpan span = node_span(clamp(cell, 0, size - 1), size, level);
    if (cell < 0) return HeightSpan(span.node, -endless, 0);
    if (cell >= size) return HeightSpan(span.node, size, endless);
    return span;
}

//@part mirrored
// Maps that repeat mirrored.

//@include "height_march.glsl#nodes"

int mirrored_texel(int texel, int size, float inverse) {
    int within = texel - periods_before(texel, 2 * size, 0.5 * inverse);
    return within < size ? within : 2 * size - 1 - within;
}

HeightSpan mirrored_span(int cell, int size, int level, float inverse) {
    int before = periods_before(cell, 2 * size, 0.5 * inverse);
    int within = cell - before;
    if (within < size) return moved_span(node_span(within, size, level), before);
    int mirrored = 2 * size - 2 - within;
    if (mirrored < 0) return HeightSpan(0, cell, cell + 1);
    HeightSpan span = node_span(mirrored, size, level);
    int last = 2 * size - 1 - span.first;
    int first = 2 * size - 1 - min(span.last, size - 1);
    return HeightSpan(span.node, before + first, before + last);
}

//@part columns_repeated implements height_columns
// Columns of a map that repeats.

//@include "height_march.glsl#repeated"

int height_column(int x) { return repeated_texel(x, height_texels.x, texel_of_height.x); }

HeightSpan height_columns(int cell, int level) {
    return repeated_span(cell, height_texels.x, level, texel_of_height.x);
}

//@part columns_clamped implements height_columns
// Columns of a map that continues its border.

//@include "height_march.glsl#clamped"

int height_column(int x) { return clamped_texel(x, height_texels.x); }

HeightSpan height_columns(int cell, int level) {
    return clamped_span(cell, height_texels.x, level);
}

//@part columns_mirrored implements height_columns
// Columns of a map that repeats mirrored.

//@include "height_march.glsl#mirrored"

int height_column(int x) { return mirrored_texel(x, height_texels.x, texel_of_height.x); }

HeightSpan height_columns(int cell, int level) {
    return mirrored_span(cell, height_texels.x, level, texel_of_height.x);
}

//@part rows_repeated implements height_rows
// Rows of a map that repeats.

//@include "height_march.glsl#repeated"

int height_row(int y) { return repeated_texel(y, height_texels.y, texel_of_height.y); }

HeightSpan height_rows(int cell, int level) {
    return repeated_span(cell, height_texels.y, level, texel_of_height.y);
}

//@part rows_clamped implements height_rows
// Rows of a map that continues its border.

//@include "height_march.glsl#clamped"

int height_row(int y) { return clamped_texel(y, height_texels.y); }

HeightSpan height_rows(int cell, int level) {
    return clamped_span(cell, height_texels.y, level);
}

//@part rows_mirrored implements height_rows
// Rows of a map that repeats mirrored.

//@include "height_march.glsl#mirrored"

int height_row(int y) { return mirrored_texel(y, height_texels.y, texel_of_height.y); }

HeightSpan height_rows(int cell, int level) {
    return mirrored_span(cell, height_texels.y, level, texel_of_height.y);
}
