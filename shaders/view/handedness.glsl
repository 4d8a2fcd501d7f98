// SPDX-License-Identifier: Apache-2.0
// Which way round the frame is, in world space: debug_views.h names the two colours. Mid-grey where
// it spans nothing.

#include <frame>

vec3 view_color() {
    mat3 frame = world_from_tangent();
    float turn = dot(cross(frame[2], frame[0]), frame[1]);
    if (turn > 0.0) return vec3(0.2, 0.6, 1.0);
    return turn < 0.0 ? vec3(1.0, 0.4, 0.2) : vec3(0.5);
}
