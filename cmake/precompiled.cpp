// SPDX-License-Identifier: Apache-2.0
// Nothing: a target that only lends its precompiled headers (precompiled.h) needs a file.
