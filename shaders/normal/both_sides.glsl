// SPDX-License-Identifier: Apache-2.0
// Both sides are drawn, and a back face shows the opposite of its normal.

float facing() { return gl_FrontFacing ? 1.0 : -1.0; }
