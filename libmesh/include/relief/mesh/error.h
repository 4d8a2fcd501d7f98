// SPDX-License-Identifier: Apache-2.0
/// \file
/// The exceptions of relief. Bad data always throws; programming errors assert.
///
/// A message names the object, its value and the limit: "triangle 7 names vertex 12, but there are
/// only 8". Nothing is repaired silently: a repair is a Finding in a Report (report.h).
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

namespace relief {

/// The base class of all exceptions that relief throws.
class Error : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// Data or options that are contradictory or out of range.
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
