// SPDX-License-Identifier: Apache-2.0
/// \file
/// Numbers and texts that JSON cannot hold: in the parts of shards, numbers that are not finite are
/// texts, and names of other bytes than UTF-8 are arrays of bytes.
/// Tests: tests/tools/relief_bake_shards_test.cpp, tests/check/check_shards_test.cpp.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "common/text.h"
#include "json_cursor.h"

namespace relief::tools {

/// "nan", "inf" and "-inf" stand for numbers that are not finite.
Json number_json(double number);
/// Any other text is NaN. \throws InvalidInput if it is neither a number nor a text
double number_in(const relief::detail::JsonCursor& json);
/// \throws nlohmann::json::exception
double number_in(const Json& json);

Json text_json(const std::string& text);
/// \throws InvalidInput if it is neither a text nor a list of bytes
std::string text_in(const relief::detail::JsonCursor& json);
/// \throws nlohmann::json::exception
std::string text_in(const Json& json);

Json texts_json(const std::vector<std::string>& texts);
/// \throws InvalidInput if it is not a list of texts
std::vector<std::string> texts_in(const relief::detail::JsonCursor& json);

}  // namespace relief::tools
