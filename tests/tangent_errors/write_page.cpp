// SPDX-License-Identifier: Apache-2.0
// `relief-tangent-errors-page docs/tangents.md` measures the tables of the page anew and puts them
// in.
#include "tangent_errors/error_tables.h"

int main(int argc, char** argv) {
    return relief::test::write_sections(argc, argv, relief::test::tangent_error_sections);
}
