// SPDX-License-Identifier: Apache-2.0
/// \file
/// Files dropped on a window as a file manager does it: the source's side of the XDND protocol,
/// version 5 (freedesktop.org).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace relief::test {

/// Drops files on the one window of that display that takes drops, at a place of the screen.
///
/// \return whether the window took them to the end
bool drop_files(const std::string& display, const std::vector<std::filesystem::path>& files, int x,
                int y);

}  // namespace relief::test
