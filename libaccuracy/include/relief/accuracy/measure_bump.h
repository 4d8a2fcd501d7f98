// SPDX-License-Identifier: Apache-2.0
/// \file
/// Measures the error and time of the conversions of a height map, and selects the cheapest one
/// within an error limit.
/// Tests: tests/accuracy/measure_bump_test.cpp.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "relief/accuracy/ground_truth.h"
#include "relief/export.h"
#include "relief/mesh/error_stats.h"
#include "relief/mesh/kernel_choice.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/timing.h"

namespace RELIEF_API relief {

/// A method of conversion.
struct BumpMethod {
    Kernel kernel = Kernel::sobel3;
    int gaussian_radius = 2;  ///< The radius of Kernel::gaussian.
    Arithmetic arithmetic = Arithmetic::float32;
    int bits = 16;  ///< Bits per channel of the stored map.
    /// The heights are smoothed by destaircase() first (height_map.h).
    bool destaircased = false;

    bool operator==(const BumpMethod&) const = default;
};

/// A cost that does not depend on measured time. It is ordered by the bits of the result, then by
/// de-staircasing, then by the number of operations per texel, which counts twice in float64.
double nominal_cost(const BumpMethod& method);

/// The measured error and time of a method.
struct BumpMeasurement {
    BumpMethod method;
    /// The angles between the stored normals and the reference, in degrees.
    ErrorStats error;
    /// The time of a conversion in memory, including smoothing (BumpExperiment::smoothing); zeros
    /// if it was not timed.
    TimeStatistics seconds;
    double megapixels_per_second = 0.0;
    /// No other method has both a smaller RMS error and a shorter time.
    bool is_pareto_optimal = false;
};

/// The reference of the errors.
struct BumpReference {
    /// The method of the reference, in float64 and not rounded to codes; absent if the exact
    /// normals are known.
    std::optional<BumpMethod> method;
    /// The expected RMS error of the reference against the surface from which the map was made, in
    /// degrees. Measured errors do not include it. 0 if the exact normals are known.
    double reference_degrees = 0.0;
    /// The expected maximum of that error.
    double reference_max_degrees = 0.0;
    /// The upper ends of both, if the map does not show whether detail is real (KernelChoice::
    /// upper_rms_degrees). Not less than the values above.
    double upper_degrees = 0.0;
    double upper_max_degrees = 0.0;
    std::string words;  ///< A description for people.
};

struct BumpExperiment {
    BumpReference reference;
    std::vector<BumpMeasurement> measurements;  ///< In the order of the methods.
    /// The time of destaircase() in seconds. It runs once per round and is added to all methods
    /// that need it. Zeros if no method needs it or nothing was timed.
    TimeStatistics smoothing;
    KernelChoice choice;      ///< For the map without smoothing.
    std::int64_t texels = 0;  ///< Number of measured texels.
    bool is_whole = true;     ///< False if only parts of a large map were measured.
};

struct BumpExperimentOptions {
    BumpOptions bump;        ///< Strength, texel and wrap.
    NormalMapFormat format;  ///< The format of the stored maps, except for their bits.
    Grain grain = Grain::automatic;
    Repeats repeats{5, 1};  ///< With `counted` = 0, nothing is timed.
};

/// The samples of a map, which may be too large for memory.
struct BumpSample {
    std::vector<Image> analyzed;  ///< The parts of parts_to_analyze(), for the choice of a kernel.
    std::vector<Image> measured;  ///< The parts of parts_to_measure().
    bool is_whole = true;         ///< The only measured part is the whole map.
};

/// Selects the parts of a map on which methods are measured: the whole map, or, if it has more
/// texels than the limit, nine parts with that many texels together, from top to bottom.
inline constexpr std::int64_t texels_to_measure = std::int64_t{1} << 20;
std::vector<ImagePart> parts_to_measure(int width, int height,
                                        std::int64_t max_texels = texels_to_measure);

/// The parts of a sample.
struct BumpSampleParts {
    std::vector<ImagePart> analyzed;
    std::vector<ImagePart> measured;

    /// All parts once, from top to bottom, as a file is read.
    [[nodiscard]] std::vector<ImagePart> in_order() const;
    /// Creates the sample. \param images  the images of in_order()
    [[nodiscard]] BumpSample sample(const std::vector<Image>& images) const;
};

/// Creates the sample of a map in memory.
BumpSample sample_of(const Image& height, std::int64_t max_texels = texels_to_measure);

/// Returns all combinations of kernels (the Gaussian with the given radius), precisions, bit depths
/// and de-staircasing.
std::vector<BumpMethod> bump_methods(int gaussian_radius, std::span<const int> depths,
                                     std::span<const Arithmetic> arithmetics,
                                     std::span<const bool> destaircased);

/// Measures the error and time of all methods on a map, interleaved.
///
/// \param sample  of one channel, as for normals_from_height(); the outermost 16 texels of parts
///         are not compared
/// \return errors against the most accurate normals that are known for this map: those of the
///         chosen kernel in float64, with or without de-staircasing, whichever has the smaller
///         error according to choose_kernel(). No reference can include the detail that was lost
///         when the map was quantized
/// \throws InvalidInput as normals_from_height() does
BumpExperiment measure_bump(const BumpSample& sample, std::span<const BumpMethod> methods,
                            const BumpExperimentOptions& options);

/// The same for a height field whose exact normals are known.
BumpExperiment measure_bump(const BumpField& field, std::span<const BumpMethod> methods,
                            BumpExperimentOptions options);

/// Returns the expected error of a measured method against the surface from which the map was made.
///
/// \param kind  of both parts. For ErrorKind::max the root of the sum of squares is an estimate,
///         because the maxima of both parts seldom occur in the same texel. For ErrorKind::p99 the
///         part of the reference is its maximum
ExpectedError expected_error(const BumpReference& reference, const BumpMeasurement& measurement,
                             ErrorKind kind = ErrorKind::rms);

/// Returns the upper end of the same error.
ExpectedError expected_error_upper(const BumpReference& reference,
                                   const BumpMeasurement& measurement,
                                   ErrorKind kind = ErrorKind::rms);

/// Limits for expected_error() in degrees. An absent limit is not checked.
struct ErrorLimits {
    std::optional<double> total;
    std::optional<double> added;
    ErrorKind kind = ErrorKind::rms;

    /// Returns true if the error is within the limits, and false if it is unknown.
    [[nodiscard]] bool hold(const ExpectedError& error) const {
        return (!total || error.total() <= *total) && (!added || error.added <= *added);
    }
};

/// Returns the measurement with the smallest nominal_cost() within the limits; null if there is
/// none.
const BumpMeasurement* cheapest_within(const BumpExperiment& experiment, const ErrorLimits& limits);

/// Returns the measurement with the smallest error; null if there is none.
const BumpMeasurement* most_accurate(const BumpExperiment& experiment, ErrorKind kind);

}  // namespace relief
