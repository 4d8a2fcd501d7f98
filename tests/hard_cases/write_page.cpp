// SPDX-License-Identifier: Apache-2.0
// `relief-hard-cases-page docs/hard-cases.md` writes the page from the catalogue.
#include <cstdio>
#include <fstream>

#include "error_tables/error_tables.h"
#include "hard_cases/hard_cases.h"

int main(int argc, char** argv) {
    if (!relief::test::is_one_path(argc, argv)) {
        std::fputs("usage: relief-hard-cases-page docs/hard-cases.md\n", stderr);
        return 2;
    }
    std::ofstream file(argv[1], std::ios::binary);
    file << relief::test::hard_cases_page();
    return file.flush() ? 0 : 1;
}
