// SPDX-License-Identifier: Apache-2.0
// The surface covers whatever is behind it.

float alpha_here() { return 1.0; }
