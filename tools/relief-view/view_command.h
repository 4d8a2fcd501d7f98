// SPDX-License-Identifier: Apache-2.0
/// \file
/// The one command of relief-view.
#pragma once

#include "common/command.h"

namespace relief::tools {

Command add_view_command(CLI::App& tool);

}  // namespace relief::tools
