// SPDX-License-Identifier: Apache-2.0
// Only front faces are drawn: the normal is right as it is.

float facing() { return 1.0; }
