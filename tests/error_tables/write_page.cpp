// SPDX-License-Identifier: Apache-2.0
// `relief-NAME-errors-page PAGE` measures the tables of a page in docs/ and writes them into it.
// RELIEF_TABLES is the function of error_tables.h that measures them.
#include "error_tables/error_tables.h"

int main(int argc, char** argv) {
    return relief::test::write_sections(argc, argv, relief::test::RELIEF_TABLES);
}
