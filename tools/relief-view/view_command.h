// SPDX-License-Identifier: Apache-2.0
/// \file
/// The command of relief-view, and its output files: a picture, numbered pictures, an animation, a
/// scene file or a model. Tests: tests/tools/sequence_test.cpp,
/// tests/tools/window/capture_test.cpp.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "common/command.h"
#include "relief/mesh/image.h"
#include "relief/shade/renderer.h"
#include "scene_options.h"
#include "view_options.h"

namespace relief::tools {

struct ViewOptions;

/// The tool for main(), and for tests that run it in their own process.
Tool relief_view();

/// Opens the window and returns when it is closed.
/// \param options  settled; without a model, the window waits for one to be dropped
/// \throws WindowError
ExitCode run_window(const ViewOptions& options);

Command add_view_command(CLI::App& tool);

// Output files.

void add_sequence_options(CLI::App& app, ViewOptions& options);

/// \throws UsageError if options contradict each other, or the output cannot store several pictures
void check_sequence(const ViewOptions& options);

/// The number of pictures; 1 without a sequence.
int picture_count(const ViewOptions& options);

/// The file of picture `index`, counted from 1. The number replaces a run of # in the name, or is
/// appended: "spin-0001.png".
std::filesystem::path numbered_file(const std::filesystem::path& output, int index);

/// The destination of pictures: one file, numbered files or an animation.
class PictureSink {
  public:
    virtual ~PictureSink() = default;
    virtual void take(const Image& picture) = 0;
    /// Called after the last picture. \throws FileError
    virtual void finish() {}
};
std::unique_ptr<PictureSink> make_sink(const ViewOptions& options);

/// Poses the scene for picture `index`, counted from 0: rotated, or at the time of the picture.
void pose_for(ComposedScene& composed, const ViewOptions& options, int index);

/// Times of all pictures in milliseconds.
struct SequenceTimes {
    std::vector<double> draw;
    std::vector<double> read_back;
};

/// Draws all pictures and passes them on. The camera moves only if it belongs to the scene.
/// \param prepare  makes the renderer of the current scene; called again for each picture if
///                 materials move
/// \return the last frame
Frame draw_sequence(const std::function<std::unique_ptr<Renderer>()>& prepare,
                    ComposedScene& composed, const ViewOptions& options, Stages& stages,
                    const std::function<void(const Frame&)>& take, SequenceTimes& times);

void add_save_options(CLI::App& app, ViewOptions& options);

/// \throws UsageError if the format of a file is not supported
void check_save_options(const ViewOptions& options);

/// Writes the files of --save-scene and --save-model.
void save_files(const ViewOptions& options, const ComposedScene& composed, Stages& stages);

/// Writes a model. Missing normals are added, and so are tangents if a normal map needs them. Other
/// data stays. Materials of other formats become glTF materials.
///
/// \param file     .glb or .gltf
/// \param options  for the normals and the axis that points up
/// \throws FileError if a file cannot be read or written
/// \throws InvalidInput if the model is a scene file
void save_model(const std::filesystem::path& file, const std::filesystem::path& model,
                const SceneOptions& options = {});

}  // namespace relief::tools
