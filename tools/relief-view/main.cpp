// SPDX-License-Identifier: Apache-2.0
#include "view_command.h"

int main(int argc, char** argv) {
    return relief::tools::run_tool(relief::tools::relief_view(), argc, argv);
}
