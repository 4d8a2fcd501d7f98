// SPDX-License-Identifier: Apache-2.0
// `relief-normal-errors-page docs/normals.md` measures the tables of the page anew and puts them
// in.
#include "normal_errors/error_tables.h"
#include "support/error_page.h"

int main(int argc, char** argv) {
    using namespace relief::test;
    return write_sections(argc, argv, [] {
        return std::vector<PageSection>{{tables_begin, normal_error_tables() + "\n"}};
    });
}
