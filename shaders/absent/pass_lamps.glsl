// SPDX-License-Identifier: Apache-2.0
// Lamps are not computed at vertices.

void pass_lamps() {}
