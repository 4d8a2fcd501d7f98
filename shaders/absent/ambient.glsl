// SPDX-License-Identifier: Apache-2.0
// No ambient light, or a surface that scatters none.

void add_ambient(Surface surface, inout Lighting lighting) {}
