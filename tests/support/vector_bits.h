// SPDX-License-Identifier: Apache-2.0
/// \file
/// Limits the vector registers of loops (best_vector_target()), to compare their results.
#pragma once

#include <cstdlib>

namespace relief::test {

/// Sets RELIEF_VECTOR_BITS during its lifetime.
class VectorBits {
  public:
    /// \param bits  "128", "256" or "512"
    explicit VectorBits(const char* bits) { set(bits); }
    ~VectorBits() { set(""); }
    VectorBits(const VectorBits&) = delete;
    VectorBits& operator=(const VectorBits&) = delete;

  private:
    /// An empty text removes the variable.
    static void set(const char* bits) {
#if defined(_WIN32)
        ::_putenv_s("RELIEF_VECTOR_BITS", bits);
#else
        if (*bits == '\0')
            ::unsetenv("RELIEF_VECTOR_BITS");
        else
            ::setenv("RELIEF_VECTOR_BITS", bits, 1);
#endif
    }
};

}  // namespace relief::test
