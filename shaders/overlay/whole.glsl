// SPDX-License-Identifier: Apache-2.0
// All of it.

void cut() {}
