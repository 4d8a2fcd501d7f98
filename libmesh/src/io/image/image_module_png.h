// SPDX-License-Identifier: Apache-2.0
/// \file
/// libpng's errors as text instead of on stderr; see image_module_png.cpp.
#pragma once

#include <string>

namespace relief {

/// What libpng last complained of in this thread; empty where it did not, and after asking.
std::string last_png_complaint();

}  // namespace relief
