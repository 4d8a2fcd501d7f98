// SPDX-License-Identifier: Apache-2.0
// `relief-bump-errors-page docs/bump.md` measures the tables of the page anew and puts them in.
#include "bump_errors/error_tables.h"
#include "support/error_page.h"

int main(int argc, char** argv) {
    using namespace relief::test;
    return write_sections(argc, argv, [] {
        return std::vector<PageSection>{{kernels_begin, kernel_tables() + "\n"},
                                        {choices_begin, choice_tables() + "\n"},
                                        {steps_begin, step_tables() + "\n"},
                                        {depths_begin, depth_tables() + "\n"}};
    });
}
