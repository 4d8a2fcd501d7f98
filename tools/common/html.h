// SPDX-License-Identifier: Apache-2.0
/// \file
/// Text and pictures in HTML pages that load nothing.
/// Tests: tests/tools/accuracy_page/report_page_test.cpp.
#pragma once

#include <string>
#include <string_view>

namespace relief::tools {

/// Returns text for elements and quoted attributes, with entities for & < > " '.
std::string html_escaped(std::string_view text);

/// Returns bytes as base64 [RFC 4648], for data: URLs.
std::string base64(std::string_view bytes);

}  // namespace relief::tools
