// SPDX-License-Identifier: Apache-2.0
/// \file
/// What relief throws. Bad data throws, always; relief's own bugs assert.
///
/// A message names the thing, its value and the limit: "triangle 7 names vertex 12, but there are
/// only 8". Nothing is repaired silently: a repair is a Finding in a Report (report.h).
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

namespace relief {

/// Base of everything relief throws on purpose.
class Error : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// Data or options that contradict themselves or cannot be used.
class InvalidInput : public Error {
  public:
    using Error::Error;
};

/// A file that cannot be read or written; the message is "FILE: REASON".
class FileError : public Error {
  public:
    FileError(const std::filesystem::path& file, const std::string& reason)
        : Error(file.string() + ": " + reason) {}
};

}  // namespace relief
