// SPDX-License-Identifier: Apache-2.0
/// \file
/// What PNG files are made of: big-endian numbers, and chunks of a length, a type, data and a
/// checksum. Source: [ISO/IEC 15948]. Tests: tests/mesh/io/png/png_test.cpp.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace relief {

void append_big16(std::string& to, std::uint32_t value);
void append_big32(std::string& to, std::uint32_t value);

/// \param data  below 2 GiB
void append_chunk(std::string& file, std::string_view type, std::string_view data);

}  // namespace relief
