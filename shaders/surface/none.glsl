// SPDX-License-Identifier: Apache-2.0
// No light and no reflection: nothing asks for the surface's orientation.

struct Surface {
    bool unused;
};

Surface surface_here() { return Surface(false); }
