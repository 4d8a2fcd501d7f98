// SPDX-License-Identifier: Apache-2.0
// `relief-normal-errors-page docs/normals.md` measures the tables of the page anew and puts them
// in.
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>

#include "normal_errors/error_tables.h"

int main(int argc, char** argv) {
    if (argc != 2) {
        std::cerr << "usage: relief-normal-errors-page PAGE\n";
        return 2;
    }
    std::ifstream in(argv[1]);
    std::string page{std::istreambuf_iterator<char>(in), {}};
    const std::size_t begin = page.find(relief::test::tables_begin);
    const std::size_t end = page.find(relief::test::tables_end);
    if (begin == std::string::npos || end == std::string::npos) {
        std::cerr << "relief-normal-errors-page: error: " << argv[1]
                  << ": has no place for tables\n";
        return 1;
    }
    const std::size_t first = begin + std::string(relief::test::tables_begin).size();
    page.replace(first, end - first, relief::test::normal_error_tables() + "\n");
    std::ofstream(argv[1]) << page;
    return 0;
}
