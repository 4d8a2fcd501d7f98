// SPDX-License-Identifier: Apache-2.0
/// \file
/// Libraries that are used where they exist and not needed where they do not: OSMesa and EGL.
/// Tests: tests/shade/gl/context_test.cpp.
#pragma once

#include <span>
#include <string>

namespace relief::gl {

/// A library loaded at run time and kept until the process ends: drivers leave threads and exit
/// handlers behind that must find their code.
class DynamicLibrary {
  public:
    /// Loads the first of `names` that there is.
    ///
    /// \param variable  an environment variable; if set and not empty, the only name tried
    /// \throws GpuError with the loader's words for every name tried
    DynamicLibrary(const char* variable, std::span<const char* const> names);

    /// A function of the library. \throws GpuError if it has none of this name
    template <typename Function>
    Function function(const char* name) const {
        return reinterpret_cast<Function>(symbol(name));
    }

  private:
    void* symbol(const char* name) const;

    void* library_ = nullptr;
    std::string name_;
};

}  // namespace relief::gl
