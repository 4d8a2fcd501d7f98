// SPDX-License-Identifier: Apache-2.0
/// \file
/// Ways to draw one thing, drawn by OpenGL in turns, timed, and held against the picture that it
/// should be. Tests: tests/accuracy/drawn_methods_test.cpp.
#pragma once

#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "relief/accuracy/experiment.h"
#include "relief/shade/context.h"
#include "relief/shade/scene.h"

namespace relief {

/// OpenGL, or why there is none.
class Drawing {
  public:
    explicit Drawing(Backend backend = Backend::automatic);

    /// Whether pictures can be drawn; if not, the experiment's finding says why.
    bool is_possible_for(Experiment& experiment) const;

    [[nodiscard]] const Context& context() const { return *context_; }
    [[nodiscard]] bool is_there() const { return context_ != nullptr; }

  private:
    std::unique_ptr<Context> context_;
    std::string absence_;
};

/// One way to draw.
struct DrawnMethod {
    std::string name;
    std::vector<std::pair<std::string, std::string>> choices;
    Scene scene;
    int samples = 1;  ///< 1 or 4 for each pixel, as OpenGL's multisampling takes them.
    /// Pixels that are drawn along the side of one pixel, and averaged afterwards.
    int pixels_a_side = 1;
    double stored_bytes = 0.0;
    std::string note = {};
};

/// What became of one.
struct DrawnPicture {
    Image picture;  ///< 8-bit sRGB, three channels.
    Image errors;   ///< FLIP of each pixel.
};

/// Draws all of them, and adds a measurement for each to the experiment.
///
/// \param truth  three float channels, linear light; pictures become as large
/// \return in the order of the methods. Times are of frames from the first command to the last
///         pixel; reading back is not in them, and neither is the averaging of `pixels_a_side`. All
///         threads are those that the driver has; one thread, measured where it draws in software,
///         is these on one processor
std::vector<DrawnPicture> measure_drawn(const Drawing& drawing,
                                        std::span<const DrawnMethod> methods, const Image& truth,
                                        const RunOptions& options, Experiment& experiment);

/// The error of a picture that is not measured: a point of a curve.
double drawn_error(const Drawing& drawing, const DrawnMethod& method, const Image& truth);

/// A picture beside what it should be.
PicturePair pair_of(const std::string& title, const std::string& method, const Image& picture,
                    const Image& truth);

/// A method as a sentence names it.
struct NamedMeasurement {
    std::string name;
    const Measurement& measurement;
};

/// " Median frame times: 1.2 ms (stored), 3.4 ms (derived)."; empty where one was not timed. On one
/// thread where that was measured, as mark_efficient() takes times.
std::string frame_times(std::initializer_list<NamedMeasurement> methods);

}  // namespace relief
