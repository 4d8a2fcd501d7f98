// SPDX-License-Identifier: Apache-2.0
// Nothing asks for it.

void pass_normal() {}
