// SPDX-License-Identifier: Apache-2.0
/// \file
/// The exceptions of relief, and reports of problems in the input and of fallbacks.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "relief/export.h"

namespace RELIEF_API relief {

// The exceptions of relief. Bad data always throws; programming errors assert.
//
// A message names the object, its value and the limit: "triangle 7 names vertex 12, but there are
// only 8". Nothing is repaired silently: a repair is a Finding in a Report.

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

// A Report contains the problems that library functions find in their input, and the fallbacks
// that they use.
//
// Functions with fallbacks have a parameter of type Report& and add to it. It may be left out:
// results are usable even if the caller ignores the report.

/// A problem of one kind, over all affected elements.
struct Finding {
    std::string kind;       ///< The problem, a fixed text: "degenerate triangle".
    std::string element;    ///< The type of element: "triangle", "vertex", "corner", "texel".
    std::string outcome;    ///< The outcome: "does not contribute to vertex normals".
    std::size_t count = 0;  ///< Number of affected elements.
    std::vector<std::size_t> first;  ///< The smallest indices, ascending, at most 8.

    friend bool operator==(const Finding&, const Finding&) = default;
};

/// Findings, one for each kind, in order of first appearance.
///
/// The contents do not depend on the order in which the elements of one kind are added.
class Report {
  public:
    /// Counts an element of a kind. The outcome belongs to the kind: the first one is kept.
    void add(std::string_view kind, std::string_view element, std::size_t index,
             std::string_view outcome);

    /// Adds a finding of another report.
    void add(const Finding& theirs);

    /// Adds all findings of another report.
    void merge(const Report& other);

    [[nodiscard]] std::span<const Finding> findings() const { return findings_; }
    [[nodiscard]] bool empty() const { return findings_.empty(); }

    /// Returns the number of elements that were counted for a kind.
    [[nodiscard]] std::size_t count(std::string_view kind) const;

  private:
    Finding& finding(std::string_view kind, std::string_view element, std::string_view outcome);

    std::vector<Finding> findings_;
};

/// A report that nobody reads: the default argument of functions that add to a Report.
class IgnoredReport {
  public:
    operator Report&() && { return report_; }  // NOLINT: implicit, as a default argument.

  private:
    Report report_;
};

/// Formats a finding as one line: "2 degenerate triangles (triangle 3, 17): do not contribute ...".
std::string to_string(const Finding& finding);

}  // namespace relief
