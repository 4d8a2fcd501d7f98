// SPDX-License-Identifier: Apache-2.0
/// \file
/// A value in a report's JSON and where it stands, so that what is wrong with it can be told:
/// "/experiments/0/id: is missing". Tests: tests/tools/accuracy_report_test.cpp.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace relief::tools {

/// All its functions throw InvalidInput if something else stands there than is asked for.
class JsonPlace {
  public:
    /// \param value  must live longer
    explicit JsonPlace(const nlohmann::json& value, std::string place = "");

    /// A member that must be there.
    [[nodiscard]] JsonPlace at(const std::string& key) const;
    /// One that need not; null is as good as nothing.
    [[nodiscard]] std::optional<JsonPlace> find(const std::string& key) const;
    [[nodiscard]] std::vector<JsonPlace> elements() const;
    /// The members of an object, in the order of their names.
    [[nodiscard]] std::vector<std::pair<std::string, JsonPlace>> members() const;

    [[nodiscard]] std::string text() const;
    [[nodiscard]] bool boolean() const;
    [[nodiscard]] double number() const;
    /// The same, where null stands for NaN.
    [[nodiscard]] double number_or_nan() const;
    [[nodiscard]] std::uint64_t whole_number() const;

    [[noreturn]] void fail(const std::string& problem) const;

  private:
    const nlohmann::json* value_;
    std::string place_;
};

}  // namespace relief::tools
