// SPDX-License-Identifier: Apache-2.0
/// \file
/// Error against time for bump maps: ways to convert a height map, measured on that map, and the
/// cheapest that is good enough. The one home of it. Tests:
/// tests/mesh/accuracy/bump_experiment_test.cpp.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "relief/mesh/angle_distribution.h"
#include "relief/mesh/bump_fields.h"
#include "relief/mesh/kernel_choice.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/timing.h"

namespace relief {

/// A way to convert.
struct BumpMethod {
    Kernel kernel = Kernel::sobel3;
    int gaussian_radius = 2;  ///< Of Kernel::gaussian.
    Arithmetic arithmetic = Arithmetic::float32;
    int bits = 16;              ///< Of the stored map.
    bool destaircased = false;  ///< After destaircase() (destaircase.h).

    bool operator==(const BumpMethod&) const = default;
};

/// What it costs by its own nature, for choices that must not depend on a clock: bytes of the
/// result first, then de-staircasing, then the operations a texel, twice as dear in float64.
double cost_of(const BumpMethod& method);

/// What a method did.
struct BumpMeasurement {
    BumpMethod method;
    AngleDistribution error;  ///< Of the stored normals from the reference, in degrees.
    /// Of a conversion in memory, smoothing included (BumpExperiment::smoothing); zeros if none
    /// was timed.
    Spread seconds;
    double megapixels_per_second = 0.0;
    bool is_efficient = false;  ///< None measured has both less RMS error and less time.
};

/// What errors are counted from.
struct BumpReference {
    /// In float64, unrounded; nothing where the truth is known.
    std::optional<BumpMethod> method;
    /// What the reference itself is expected to be off the ground that the map was made of: errors
    /// below say nothing about that. 0 where the truth is known.
    double own_degrees = 0.0;
    /// The same, of the texel that is off most.
    double own_max_degrees = 0.0;
    std::string words;  ///< All that, for people.
};

struct BumpExperiment {
    BumpReference reference;
    std::vector<BumpMeasurement> measurements;  ///< In the order of the methods.
    /// Seconds of smoothing the steps away: once in each round, part of the time of all methods
    /// that want it, in that round. Zeros if none does, or none was timed.
    Spread smoothing;
    KernelChoice choice;      ///< For the map as it is.
    std::int64_t texels = 0;  ///< That were looked at.
    bool is_whole = true;     ///< False: parts of a large map.
};

struct BumpExperimentOptions {
    BumpOptions bump;        ///< Strength, texel and wrap.
    NormalMapFormat format;  ///< Of the stored maps, but for their bits.
    Grain grain = Grain::automatic;
    Repeats repeats{5, 1};  ///< `counted` 0: nothing is timed.
};

/// What is known of a map, which may be too large for memory.
struct BumpSample {
    std::vector<Image> looked_at;  ///< parts_to_look_at(): for the choice of a kernel.
    std::vector<Image> measured;   ///< parts_to_measure()
    bool is_whole = true;          ///< The one part measured is the map.
};

/// The parts of a map that methods are measured on: one, the whole of it, unless it has more than
/// so many texels; then nine that have as many together. From top to bottom.
inline constexpr std::int64_t texels_to_measure = std::int64_t{1} << 20;
std::vector<ImagePart> parts_to_measure(int width, int height,
                                        std::int64_t most_texels = texels_to_measure);

/// Which parts a sample is made of.
struct BumpSampleParts {
    std::vector<ImagePart> looked_at;
    std::vector<ImagePart> measured;

    /// All of them from top to bottom, each once: as a file is read.
    [[nodiscard]] std::vector<ImagePart> in_order() const;
    /// \param images  of in_order()
    [[nodiscard]] BumpSample sample(const std::vector<Image>& images) const;
};

/// Of a map in memory.
BumpSample sample_of(const Image& height, std::int64_t most_texels = texels_to_measure);

/// Every kernel (the Gaussian with the radius given), in both arithmetics, in each of the depths.
std::vector<BumpMethod> bump_methods(int gaussian_radius, std::span<const int> depths,
                                     std::span<const Arithmetic> arithmetics,
                                     std::span<const bool> destaircased);

/// Converts the map in every way and measures error and time, all in turns.
///
/// \param sample  of one channel, as for normals_from_height(); of parts, the outermost 16 texels
///                are not compared
/// \return errors from the truest normals known for this map: those of the chosen kernel in
///         float64, of the map as it is or de-staircased, whichever choose_kernel() expects less
///         error of. What was lost when the map was rounded, no reference can know
/// \throws InvalidInput as normals_from_height() does
BumpExperiment measure_bump(const BumpSample& sample, std::span<const BumpMethod> methods,
                            const BumpExperimentOptions& options);

/// The same on a field whose true normals are known, and from those.
BumpExperiment measure_bump(const BumpField& field, std::span<const BumpMethod> methods,
                            BumpExperimentOptions options);

/// Which error a bound is for.
enum class ErrorKind { rms, max };

/// The error to be expected of a measured method, from the surface that the map was made of.
///
/// \param kind  of both parts. Greatest errors seldom meet in one texel, so that their root sum of
///              squares is an estimate too
ExpectedError expected_error(const BumpReference& reference, const BumpMeasurement& measurement,
                             ErrorKind kind = ErrorKind::rms);

/// Limits in degrees for expected_error(); absent: none.
struct ErrorLimits {
    std::optional<double> total;
    std::optional<double> added;
    ErrorKind kind = ErrorKind::rms;

    /// False where an error is not known.
    [[nodiscard]] bool hold(const ExpectedError& error) const {
        return (!total || error.total() <= *total) && (!added || error.added <= *added);
    }
};

/// The measurement of least cost_of() within the limits; nullptr where there is none.
const BumpMeasurement* cheapest_within(const BumpExperiment& experiment, const ErrorLimits& limits);

/// The one of least error; nullptr if nothing was measured.
const BumpMeasurement* truest(const BumpExperiment& experiment, ErrorKind kind);

}  // namespace relief
