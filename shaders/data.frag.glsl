// SPDX-License-Identifier: Apache-2.0
// A debug view of data: stores the value of <view> as it is, without light and coding. A blended
// surface counts as opaque; a mask cuts its holes.

out vec4 color;

//@include <second_texcoord>
//@include <displacement>
//@include <relief_edge>
//@include <relief_depth>
//@include <alpha>
//@include <view>

void main() {
    float alpha = alpha_here();
    color = vec4(view_color(), alpha);
    write_depth();
    cut_holes();
    cut_silhouette();
}
