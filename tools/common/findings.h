// SPDX-License-Identifier: Apache-2.0
/// \file
/// The library's findings, each with the part of the input that it was found in, as text for people
/// and as JSON. Tests: tests/tools/text_test.cpp.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "relief/mesh/report.h"

namespace relief::tools {

/// A finding and where: "mesh 'Body' primitive 0"; empty for the file as a whole.
struct PlacedFinding {
    std::string where;
    Finding finding;
};

class Findings {
  public:
    void add(const std::string& where, const Report& report);

    [[nodiscard]] bool empty() const { return findings_.empty(); }
    [[nodiscard]] const std::vector<PlacedFinding>& all() const { return findings_; }

    /// One line for each, at most `limit` of them and then how many more there are.
    [[nodiscard]] std::vector<std::string> lines(std::size_t limit = 12) const;

    /// [{"where", "kind", "element", "count", "first", "outcome"}, ...]
    [[nodiscard]] nlohmann::ordered_json json() const;

  private:
    std::vector<PlacedFinding> findings_;
};

}  // namespace relief::tools
