// SPDX-License-Identifier: Apache-2.0
// Light from everywhere gets everywhere.

float occlusion() { return 1.0; }
