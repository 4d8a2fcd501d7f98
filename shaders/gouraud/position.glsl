// SPDX-License-Identifier: Apache-2.0
// In the vertex stage the point is what pass_position() has just written.
