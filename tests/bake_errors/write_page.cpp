// SPDX-License-Identifier: Apache-2.0
// `relief-bake-errors-page docs/bake.md` measures the tables of the page anew and puts them in.
#include "bake_errors/error_tables.h"

int main(int argc, char** argv) {
    using namespace relief::test;
    return write_sections(argc, argv, bake_tables);
}
