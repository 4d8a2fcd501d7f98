// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "relief/mesh/error.h"

namespace relief {

/// OpenGL is missing, too old or out of memory, or refuses a shader. The message contains that of
/// the driver.
class GpuError : public Error {
  public:
    using Error::Error;
};

}  // namespace relief
