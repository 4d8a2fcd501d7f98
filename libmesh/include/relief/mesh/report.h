// SPDX-License-Identifier: Apache-2.0
/// \file
/// What a library call found wrong in its input and what it did about it.
///
/// Functions that may have to fall back take a Report& and add to it; a caller that ignores the
/// report still gets usable results, and one that prints it hides nothing.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace relief {

/// One kind of trouble, over all elements that show it.
struct Finding {
    std::string kind;       ///< What is wrong, in fixed words: "degenerate triangle".
    std::string element;    ///< What `first` counts: "triangle", "vertex", "corner", "texel".
    std::string outcome;    ///< What was done about it: "has no say in its vertices' normals".
    std::size_t count = 0;  ///< How many elements show it.
    std::vector<std::size_t> first;  ///< The smallest element indices, ascending, at most 8.

    friend bool operator==(const Finding&, const Finding&) = default;
};

/// Findings, one for each kind, in order of first appearance.
///
/// The contents do not depend on the order in which the elements of one kind are added.
class Report {
  public:
    /// Counts one more element of a kind. The outcome belongs to the kind: the first one given
    /// stays.
    void add(std::string_view kind, std::string_view element, std::size_t index,
             std::string_view outcome);

    /// Adds what was counted elsewhere.
    void add(const Finding& theirs);

    /// Adds all findings of another report.
    void merge(const Report& other);

    [[nodiscard]] std::span<const Finding> findings() const { return findings_; }
    [[nodiscard]] bool empty() const { return findings_.empty(); }

    /// How many elements were counted for a kind; 0 where there were none.
    [[nodiscard]] std::size_t count(std::string_view kind) const;

  private:
    Finding& finding(std::string_view kind, std::string_view element, std::string_view outcome);

    std::vector<Finding> findings_;
};

/// One line for people: "2 degenerate triangles (triangle 3, 17): have no say ...".
std::string to_string(const Finding& finding);

}  // namespace relief
