// SPDX-License-Identifier: Apache-2.0
#include "driver.h"

int main(int argc, char** argv) {
    relief::tools::become_tool(argc, argv);
    return relief::tools::run_tool(relief::tools::relief_driver(), argc, argv);
}
