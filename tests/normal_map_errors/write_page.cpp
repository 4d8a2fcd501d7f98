// SPDX-License-Identifier: Apache-2.0
// `relief-normal-map-errors-page docs/normal-maps.md` measures the tables of the page anew and puts
// them in.
#include "normal_map_errors/error_tables.h"

int main(int argc, char** argv) {
    using namespace relief::test;
    return write_sections(argc, argv, normal_map_tables);
}
