// SPDX-License-Identifier: Apache-2.0
/// \file
/// Pages of docs/ with tables of errors in them, which a program measures and puts in, and a test
/// compares with what it measures itself.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace relief::test {

/// Three digits, and no exponent for what is 0 but for float's rounding.
std::string in_digits(double degrees);

/// The two lines that begin a Markdown table; the first column has no name.
std::string table_header(const std::vector<std::string>& columns);

/// A line of a table, with the cells of the least ranks in bold. A cell of rank NaN is not
/// compared.
std::string table_row(const std::string& name, const std::vector<double>& ranks,
                      const std::vector<std::string>& cells);

/// What stands in a page between a line and the next line that is `tables_end`.
struct PageSection {
    std::string begin;  ///< The line before it, with its end.
    std::string text;
};
inline constexpr const char* tables_end = "<!-- end of tables -->\n";

/// What stands there in a page as it is. \throws std::runtime_error if there is no such place
std::string section_in(const std::string& page, const std::string& begin);

/// Whether the arguments of a program are one file or folder to write to. An option, such as
/// --help, is not.
bool is_one_path(int argc, const char* const* argv);

/// The whole of a program that is called with a page's path: measures the sections and puts them
/// in. \return the exit status; says on standard error what is wrong
int write_sections(int argc, const char* const* argv,
                   const std::function<std::vector<PageSection>()>& measure);

/// A text file. \throws std::runtime_error if it cannot be read
std::string contents_of_page(const std::string& path);

}  // namespace relief::test
