// SPDX-License-Identifier: Apache-2.0
// Self-shadowing of a relief (height_march.glsl): its points are dark where it hides a light from them.

//@part share implements relief_share
// The share of a light that reaches the point that the view meets. The ray climbs from there to the
// surface of white; nodes of the pyramid of maxima that it enters above their maximum are skipped, and
// patches are intersected exactly. It begins at the relief itself, lifted by a small share of the
// depth, so that neither rounding nor the method of the view puts it below. Sources: [Policarpo et al.
// 2005] for the second ray, [Tevs et al. 2008] for the nodes.

//@include "height_march.glsl#walk"

const float relief_lift = 1.0 / 512.0;

// Returns the height above the beginning, from `climbed` on, at which a ray that climbs from the depth
// `start` passes the patch's surface; no_exit if it does not.
float patch_climb(vec2 from, vec2 up, ivec2 cell, float start, float climbed) {
    vec3 along = heights_along(clamp(from + up * climbed - vec2(cell), 0.0, 1.0), up, cell);
    vec3 q = vec3(start - climbed - height_depth * (1.0 - along.x), height_depth * along.y - 1.0,
                  height_depth * along.z);
    if (q.x >= 0.0) return climbed;
    float square = q.y * q.y - 4.0 * q.z * q.x;
    float root = q.y + sqrt(max(square, 0.0));
    return square >= 0.0 && root > 0.0 ? climbed - 2.0 * q.x / root : no_exit;
}

// Returns whether the relief hides the direction `up`, in texels for each texel of height.
bool is_hidden(vec2 from, vec2 up) {
    ivec2 cell = ivec2(floor(from));
    int last_level = int(floor(log2(float(max(height_texels.x, height_texels.y)))));
    float height = heights_along(from - vec2(cell), up, cell).x;
    float start = height_depth * max(1.0 - height - relief_lift, 0.0);
    if (start == 0.0) return false;
    int level = 0;
    float climbed = 0.0;
    int left = 0;  // Nodes and patches that the ray has left; every second time it ascends.
    for (float steps = 0.0; steps < height_steps; steps += 1.0) {
        HeightSpan x = patch_span(cell.x);
        HeightSpan y = patch_span(cell.y);
        if (level > 0) {
            x = height_columns(cell.x, level);
            y = height_rows(cell.y, level);
            float highest = texelFetch(height_texture, ivec2(x.node, y.node), level).r;
            if (start - climbed > height_depth * (1.0 - highest)) {
                level -= 1;
                continue;
            }
        }
        vec2 leaves = exit_depths(from, up, x, y);
        float end = min(min(leaves.x, leaves.y), start);
        if (level == 0 && patch_climb(from, up, cell, start, climbed) <= end) return true;
        if (end >= start) return false;
        climbed = max(climbed, end);
        cell = next_cell(from + up * climbed, up, x, y, leaves);
        left += 1;
        level = min(level + 1 - (left & 1), last_level);
    }
    return false;
}

float relief_share(vec3 light_world, float share) {
    if (view_texels.z == 0.0 || share == 0.0) return share;
    vec3 ray = ray_texels(light_world);
    if (ray.z == 0.0) return 0.0;
    return is_hidden(texcoord_displaced * height_size() - 0.5, -ray.xy) ? 0.0 : share;
}

//@neutral relief_share
float relief_share(vec3 light_world, float share) { return share; }
