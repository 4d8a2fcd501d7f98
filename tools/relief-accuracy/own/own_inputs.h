// SPDX-License-Identifier: Apache-2.0
/// \file
/// What `relief-accuracy own` can be asked for, and running it on one file or pair.
/// Tests: tests/tools/accuracy_own_test.cpp.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/wrap_option.h"
#include "relief/accuracy/own.h"
#include "relief/mesh/height_map.h"

namespace relief::tools {

/// What the numbers of an image are.
enum class ImageKind { heights, normals };

struct OwnRequest {
    std::vector<std::filesystem::path> files;
    std::optional<std::filesystem::path> high, low;
    std::optional<ImageKind> image_kind;  ///< Absent: by what the image shows.
    std::optional<NormalTruth> truth;
    std::optional<double> crease_degrees;
    std::optional<double> strength;
    std::optional<HeightChannel> channel;
    std::optional<WrapsOrAuto> wrap;
    std::optional<int> size;
};

/// What is measured: a file, or a pair.
struct OwnInput {
    std::filesystem::path file;
    std::optional<std::filesystem::path> high;  ///< `file` is the low mesh then.
    std::string name;                           ///< In titles.
};

/// \throws UsageError where options contradict each other, or have no effect on these inputs
std::vector<OwnInput> inputs_of(const OwnRequest& request);

/// The options that are told, as they are typed: " --strength 8".
std::string words_of(const OwnRequest& request);

/// Measures one.
/// \param options  all but file and arguments
/// \param taken    gets what the file was taken for, in words
/// \throws FileError naming the file
std::vector<OwnExperiment> measure(const OwnInput& input, const OwnRequest& request,
                                   OwnOptions options, std::string& taken);

}  // namespace relief::tools
