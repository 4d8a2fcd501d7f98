// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which models a command line names, and the file that each is to become: common/file_jobs.h, with
/// what is special to models. Tests: tests/tools/process_jobs_test.cpp.
#pragma once

#include <optional>

#include "common/file_jobs.h"
#include "common/model_file.h"

namespace relief::tools {

/// In a folder a model keeps its name; STL and OFF, which cannot be written, become .glb unless
/// there is a `format`.
///
/// \param format  of outputs in a folder; absent: the input's own
/// \throws UsageError as jobs_of does, and for a format where the name of the output has one, or an
///         input of none
JobList model_jobs_of(const FileWords& words, std::optional<ModelFormat> format);

}  // namespace relief::tools
