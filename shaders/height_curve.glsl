// SPDX-License-Identifier: Apache-2.0
// Rays of view over curved surfaces: silhouettes of reliefs that curve with the surface.

//@part curved implements ray_curve
// The surface curves below the tangent plane, and a point at a depth has the coordinates of the
// surface above it along another normal. With the turn B of the normal, a ray that is at x = k s and
// at the depth s on the plane is at the depth d = s - x B y / 2 with y = (1 - (s + d) B / 2)^-1 x, and
// its coordinates are twice the angle whose tangent is B y / 2, divided by B: exactly on spheres and
// cylinders, and to the second order on other surfaces. The path in texel space is a parabola above
// the line from its beginning through its middle, so that coordinates stay linear along the ray: it
// has the depths of the ray at its beginning, middle and end.

//@include "height_march.glsl#ray"
//@include "height_march.glsl#field"

vec3 normal_right = dFdx(normal_world);
vec3 normal_up = dFdy(normal_world);

struct Curvature {
    mat2 turn;    // Texels that the normal turns by for a texel to the right and down.
    mat2 metric;  // The inner products of the edges of a texel.
};

// The radius of curvature counts as at least twice the depth of black.
const float least_radius = 2.0;

// Returns the curvature of the triangle; zero if it is not finite.
Curvature curvature_here() {
    float size = length(normal_world);
    vec3 normal = normal_world / size;
    vec2 right = texcoord_right * height_size();
    vec2 up = texcoord_up * height_size();
    float area = right.x * up.y - right.y * up.x;
    vec3 along_x = (position_right * up.y - position_up * right.y) / area;
    vec3 along_y = (position_up * right.x - position_right * up.x) / area;
    vec3 normal_x = (normal_right * up.y - normal_up * right.y) / area;
    vec3 normal_y = (normal_up * right.x - normal_right * up.x) / area;
    float texel_squared = length(cross(along_x, along_y));
    float scale = sqrt(texel_squared) / (size * dot(normal, cross(along_x, along_y)));
    mat2 turn = scale * mat2(dot(normal, cross(normal_x, along_y)),
                             dot(normal, cross(along_x, normal_x)),
                             dot(normal, cross(normal_y, along_y)),
                             dot(normal, cross(along_x, normal_y)));
    vec3 x = along_x - dot(along_x, normal) * normal;
    vec3 y = along_y - dot(along_y, normal) * normal;
    float squared = dot(turn[0], turn[0]) + dot(turn[1], turn[1]);
    float bound = min(1.0, 1.0 / (least_radius * height_depth * sqrt(squared)));
    mat2 metric = mat2(dot(x, x), dot(x, y), dot(x, y), dot(y, y)) / texel_squared;
    // NaN and infinity fail the comparison.
    bool is_usable = squared > 1e-20 && squared < 1e30;
    return Curvature(is_usable ? bound * turn : mat2(0.0), is_usable ? metric : mat2(1.0));
}

// Returns the texels from the beginning, and the depth, of the point of a ray at the depth s on the
// tangent plane.
vec3 point_at(vec2 k, Curvature curvature, float s) {
    vec2 x = k * s;
    vec2 covector = curvature.metric * x;
    vec2 y = x;
    vec2 turned = vec2(0.0);
    float depth = s;
    for (int i = 0; i < 3; ++i) {
        y = inverse(mat2(1.0) - 0.5 * (s + depth) * curvature.turn) * x;
        turned = curvature.turn * y;
        depth = s - 0.5 * dot(covector, turned);
    }
    // The arc tangent, as a fraction of polynomials.
    float along = dot(curvature.metric * y, turned);
    float squared = dot(curvature.metric * turned, turned);
    return vec3(y - turned * (along / (12.0 + squared)), depth);
}

// Returns where a ray reaches black or is deepest, whichever is first, on the tangent plane. That is
// exact on the circle that curves as the surface does along the ray: with its curvature c and the
// slant k, (1 - c s)^2 + c^2 k^2 s^2 = (1 - c d)^2.
float last_depth(vec2 k, Curvature curvature) {
    vec2 covector = curvature.metric * k;
    float slope = dot(covector, curvature.turn * k);
    float along = slope / dot(covector, k);
    float gain = height_depth * (2.0 - along * height_depth);
    float square = 1.0 - (along + slope) * gain;
    return square < 0.0 ? 1.0 / (along + slope) : gain / (1.0 + sqrt(square));
}

// A path of depth s - bend s^2 and texels slant s after the way s; on the tangent plane it is at the
// depth plane.x s + plane.y s^2.
struct BentRay {
    vec2 slant;
    float bend;
    vec2 plane;
};

BentRay bent_ray_of(vec2 k, Curvature curvature) {
    BentRay straight = BentRay(k, 0.0, vec2(1.0, 0.0));
    if (view_texels.z <= 0.0 || curvature.turn == mat2(0.0)) return straight;
    float s = last_depth(k, curvature);
    vec3 middle = point_at(k, curvature, 0.5 * s);
    vec3 end = point_at(k, curvature, s);
    // Over the share t of the way along the line, the depth is a t - b t^2.
    vec2 covector = curvature.metric * middle.xy;
    float middle_squared = dot(covector, middle.xy);
    float share = middle_squared / dot(covector, end.xy);
    float weight = share * (1.0 - share);
    if (!(end.z > 0.0 && middle_squared > 1e-20 && weight > 0.1)) return straight;
    float b = (middle.z - share * end.z) / weight;
    float a = max(end.z + b, 1e-3 * end.z);
    float aside = s * (0.5 - share) / weight;
    return BentRay(middle.xy / (share * a), b / (a * a), vec2((s + aside) / a, -aside / (a * a)));
}

Curvature curvature = curvature_here();
BentRay bent_ray = bent_ray_of(view_texels.xy, curvature);

vec2 ray_slant() { return bent_ray.slant; }

float ray_depth(float way) { return (1.0 - bent_ray.bend * way) * way; }

float ray_rate(float way) { return 1.0 - 2.0 * bent_ray.bend * way; }

float ray_bend() { return bent_ray.bend; }

float deepest(float from, float to) {
    return ray_depth(bent_ray.bend > 0.0 ? clamp(0.5 / bent_ray.bend, from, to) : to);
}

bool leaves_relief = 1.0 - 4.0 * bent_ray.bend * height_depth < 0.0;

float way_to(float depth) {
    float square = 1.0 - 4.0 * bent_ray.bend * depth;
    return square < 0.0 ? 1.0 / bent_ray.bend : 2.0 * depth / (1.0 + sqrt(square));
}

float ray_end() { return leaves_relief ? 1.0 / bent_ray.bend : way_to(height_depth); }

float plane_depth(float way) { return (bent_ray.plane.x + bent_ray.plane.y * way) * way; }

// A front face whose interpolated normal points away from the eye is beyond the outline.
bool faces_away() {
    return gl_FrontFacing && curvature.turn != mat2(0.0) &&
           dot(normal_world, to_eye(position_world)) < 0.0;
}

// Loops reach the end of the ray to rounding only.
bool is_left(float way) { return faces_away() || (leaves_relief && way >= 0.9999 * ray_end()); }

//@neutral ray_curve
vec2 ray_slant() { return view_texels.xy; }
float ray_depth(float way) { return way; }
float ray_rate(float way) { return 1.0; }
float ray_bend() { return 0.0; }
float deepest(float from, float to) { return to; }
float way_to(float depth) { return depth; }
float ray_end() { return height_depth; }
float plane_depth(float way) { return way; }
bool is_left(float way) { return false; }
