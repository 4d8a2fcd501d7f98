// SPDX-License-Identifier: Apache-2.0
// A debug view of data: what <view> gives, stored as it is, with no light and no coding. What is
// blended counts as opaque; a mask cuts its holes.

out vec4 color;

#include <alpha>
#include <view>

void main() {
    float alpha = alpha_here();
    color = vec4(view_color(), alpha);
}
