// SPDX-License-Identifier: Apache-2.0
// Measures the conversion of a user's height map, the storage of a user's normal map, and the bake
// of a user's pair of meshes.
#include "asset_report.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <glm/trigonometric.hpp>

#include "experiment_parts.h"
#include "relief/accuracy/asset.h"
#include "relief/accuracy/bake_accuracy.h"
#include "relief/mesh/height_map.h"
#include "relief/mesh/image.h"
#include "relief/mesh/statistics.h"
#include "storage_experiments.h"

namespace relief::accuracy {
using namespace relief::accuracy::detail;

namespace {

constexpr std::array measured_arithmetics = {Arithmetic::float32, Arithmetic::float64};

/// The conversion of all parts, as it is timed.
std::function<void()> work_of(const BumpMethod& method, const BumpSample& sample,
                              const BumpOptions& bump) {
    return [=, &sample, map = Image()]() mutable {
        for (const Image& part : sample.measured)
            convert_by(method, part, bump, map);
    };
}

std::string unknown_loss(const AssetOptions& options) {
    return fmt::format("the unknown loss of the file's {} compression", options.lossy_compression);
}

std::string lossy_note(const AssetOptions& options) {
    return fmt::format(
        "The file has lost an unknown amount by {} compression, which is not in these errors.",
        options.lossy_compression);
}

std::string command_of(const BumpMethod& method, const BumpOptions& bump,
                       const AssetOptions& options) {
    std::string command =
        fmt::format("relief-bake bump {} OUT.{} --strength {:g} --kernel {}", options.arguments,
                    method.bits == 32 ? "exr" : "png", bump.strength, enum_name(method.kernel));
    if (method.kernel == Kernel::gaussian)
        command += fmt::format(" --kernel-radius {}", method.gaussian_radius);
    command += std::string(" --precision ") + enum_name(method.arithmetic);
    if (method.bits != 32) command += fmt::format(" --bits {}", method.bits);
    if (method.destaircased) command += " --destaircase";
    return command + " --wrap " + name_of(*bump.wrap) + options.height_arguments;
}

/// Heights with steps are also smoothed, in one arithmetic and depth, which suffices to show the
/// effect.
std::vector<BumpMethod> methods_for(const KernelChoice& choice, const AssetOptions& options) {
    constexpr int max_bits_with_steps = 12;
    const int radius = best_gaussian_radius(choice);
    const std::array as_is = {false};
    std::vector<BumpMethod> methods =
        bump_methods(radius, options.map_bits, measured_arithmetics, as_is);
    const bool has_steps = choice.depth.bits > 0 && choice.depth.bits <= max_bits_with_steps;
    if (!has_steps || !options.smooths_steps) return methods;
    const std::array smooth = {true};
    for (const BumpMethod& method :
         bump_methods(radius, std::array{16}, std::array{Arithmetic::float32}, smooth))
        methods.push_back(method);
    return methods;
}

}  // namespace

AssetExperiment measure_asset_heights(const BumpSample& sample, glm::ivec2 size,
                                      const BumpOptions& bump, const AssetOptions& options,
                                      Report& report) {
    AssetExperiment asset =
        asset_experiment(Subject::bump, "bump", "Normals from heights", options);
    const KernelChoice choice = choose_kernel(sample.analyzed, bump);
    report_blurred_noise(choice, report);
    const std::vector<BumpMethod> methods = methods_for(choice, options);
    BumpExperimentOptions how;
    how.bump = bump;
    how.repeats = {0, 0};
    const BumpExperiment result = measure_bump(sample, methods, how);
    Experiment& experiment = asset.experiment;
    experiment.question = "Which kernel is most accurate on this map, and what does it cost?";
    const BumpReference& reference = result.reference;
    const bool is_lossy = !options.lossy_compression.empty();
    if (is_lossy) {
        experiment.ground_truth =
            "The conversion by the kernel that is selected for this map, in float64. " +
            lossy_note(options);
    } else {
        experiment.ground_truth =
            fmt::format("The most accurate conversion that is known for this map: {}. {}.",
                        reference.description, choice.reason);
        experiment.reference_error = reference.error.rms;
        if (reference.upper_error.rms > KernelChoice::min_range * reference.error.rms)
            experiment.reference_error_upper = reference.upper_error.rms;
    }
    experiment.input = result.is_whole ? fmt::format("{} x {} texels", size.x, size.y)
                                       : fmt::format("{} texels in nine parts of {} x {}",
                                                     result.texels, size.x, size.y);
    experiment.item = "texel";
    experiment.items = static_cast<double>(result.texels);
    std::vector<Method> measured;
    for (const BumpMeasurement& one : result.measurements) {
        Method& method = measured.emplace_back(described(one.method));
        method.error = known_error(one.error);
        method.work = work_of(one.method, sample, bump);
        method.command = command_of(one.method, bump, options);
        method.nominal_cost = nominal_cost(one.method);
    }
    finish(asset, measured,
           {.reference = is_lossy ? unknown_loss(options) : "the map itself",
            .is_reference_unknown = is_lossy,
            .limited_reference =
                expected_error(reference, result.measurements.front(), options.request.kind).map},
           options);
    return asset;
}

AssetExperiment measure_asset_heights(const Image& height, const BumpOptions& bump,
                                      const AssetOptions& options, std::int64_t max_texels) {
    BumpOptions with_wrap = bump;
    if (!bump.wrap) with_wrap.wrap = detect_tiling(height).wraps();
    return measure_asset_heights(sample_of(height, max_texels), {height.width, height.height},
                                 with_wrap, options);
}

namespace {

/// The angle that rounding to integer codes of `bits` bits adds to a normal, in degrees: uniformly
/// distributed errors of up to half a code on two axes. 0 for floats.
double rounding_degrees(int bits, ErrorKind kind) {
    if (bits >= 32) return 0.0;
    const double code = 2.0 / (std::exp2(bits) - 1.0);
    // The statistics of the distance from the center of a square of side 1.
    const double distance = kind == ErrorKind::mean  ? 0.3825978582
                            : kind == ErrorKind::p99 ? 0.6577577820
                            : kind == ErrorKind::max ? std::sqrt(0.5)
                                                     : std::sqrt(2.0 / 12.0);
    return glm::degrees(code * distance);
}

/// The file itself: without other options, `relief-bake convert` keeps every code.
Method as_it_is(const NormalMapStorage& file, std::size_t texels, const AssetOptions& options) {
    Method method;
    method.name = "as it is";
    method.choices = {
        {"layout", "as it is"}, {"bits", fmt::format("{} bit", file.bits)}, {"rounding", "none"}};
    method.stored_bytes = file.channels * file.bits / 8.0;
    method.error = known_error(error_stats(std::vector<float>(texels, 0.0F)));
    method.note = "Every code is kept; there is no work to time.";
    method.command = fmt::format("relief-bake convert {} OUT{}", options.arguments, file.extension);
    return method;
}

}  // namespace

AssetExperiment measure_asset_normals(const Image& normals, const NormalMapStorage& file,
                                      const AssetOptions& options, std::int64_t max_texels) {
    AssetExperiment asset =
        asset_experiment(Subject::storage, "normal-map", "Storage of the normals", options);
    std::vector<Image> parts;
    for (const ImagePart& part : parts_to_measure(normals.width, normals.height, max_texels))
        parts.push_back(part_of(normals, part));
    Experiment& experiment = asset.experiment;
    for (const Image& part : parts)
        experiment.items += static_cast<double>(part.width) * part.height;
    const bool is_lossy = !options.lossy_compression.empty();
    experiment.question = "In how few bits can these normals be stored?";
    experiment.ground_truth = fmt::format(
        "The normals as stored in the file, in {} bits. {}", file.bits,
        is_lossy ? lossy_note(options)
                 : "The error of the file is unknown, except for its rounding to these bits.");
    if (file.bits < 32 && !is_lossy)
        experiment.reference_error = rounding_degrees(file.bits, ErrorKind::rms);
    experiment.input = fmt::format("{} x {} texels", normals.width, normals.height);
    if (parts.size() > 1) experiment.input += fmt::format(", {:.0f} of them", experiment.items);
    experiment.item = "texel";
    std::vector<Method> methods = {
        as_it_is(file, static_cast<std::size_t>(experiment.items), options)};
    for (const NormalCode& code : normal_codes()) {
        Method method{
            .name = code.name, .choices = code.choices, .stored_bytes = code.stored_bytes};
        std::vector<float> degrees;
        for (const Image& part : parts) {
            const std::vector<float> more =
                inner_angles(stored(code, part), directions_of(part), 0);
            degrees.insert(degrees.end(), more.begin(), more.end());
        }
        method.error = known_error(error_stats(std::move(degrees)));
        method.work = [&parts, code] {
            for (const Image& part : parts)
                stored(code, part);
        };
        if (!code.command.empty())
            method.command =
                fmt::format("relief-bake convert {} {}", options.arguments, code.command);
        methods.push_back(std::move(method));
    }
    finish(asset, methods,
           {.cost = CostKind::bytes,
            .negligible_error = invisible_degrees,
            .reference = is_lossy ? unknown_loss(options) : "the rounding of the file itself",
            .is_reference_unknown = is_lossy,
            .limited_reference = rounding_degrees(file.bits, options.request.kind)},
           options);
    return asset;
}

namespace {

constexpr std::size_t max_bake_texels = std::size_t{1} << 16;

std::string samples_name(const BakeSampling& way) {
    return way.sample_degrees ? fmt::format("auto {:g}", *way.sample_degrees)
                              : fmt::format("{}", way.samples);
}

Method method_of(const BakeSampling& way, const NormalMapFormat& format, int size,
                 const AssetOptions& options) {
    const bool is_dithered = format.dither != Dither::none;
    const std::string depth = fmt::format("{} bit", format.bits);
    Method method;
    method.name = fmt::format("{} {}, {}{}", samples_name(way),
                              samples_name(way) == "1" ? "sample" : "samples", depth,
                              is_dithered ? ", dithered" : "");
    method.choices = {{"samples", samples_name(way)},
                      {"depth", depth},
                      {"dither", is_dithered ? "blue-noise" : "none"}};
    method.stored_bytes = 3.0 * format.bits / 8.0;
    method.command = fmt::format(
        "relief-bake mesh {} OUT.{} --size {} --samples {}{}{}{}", options.arguments,
        format.bits == 32 ? "exr" : "png", size, way.sample_degrees ? "auto" : samples_name(way),
        way.sample_degrees ? fmt::format(" --sample-angle {:g}", *way.sample_degrees) : "",
        format.bits == 32 ? "" : fmt::format(" --bits {}", format.bits),
        is_dithered ? " --dither blue-noise" : "");
    return method;
}

}  // namespace

AssetExperiment measure_asset_bake(const Baker& baker, int size, const AssetOptions& options) {
    AssetExperiment asset = asset_experiment(Subject::bake, "bake", "Baked normals", options);
    BakeMapOptions map;
    map.width = size;
    map.height = size;
    const auto bakes = std::make_shared<TimedBakes>(
        std::make_shared<const BakeReference>(baker, map, max_bake_texels),
        default_bake_samplings(), default_map_formats({}));
    const BakeReference& reference = bakes->reference();
    Experiment& experiment = asset.experiment;
    experiment.question = "How many samples and bits does a map of these meshes need?";
    experiment.ground_truth = fmt::format(
        "The mean of {} samples per texel of the normals of the high mesh, in the tangent space of "
        "the low mesh. This is the best result that a map of this size can have. It does not show "
        "the effect of a larger map, nor whether the rays hit the intended surface.",
        reference.samples());
    experiment.input =
        fmt::format("{} x {} texels{}; {} triangles of the low mesh", size, size,
                    reference.is_whole() ? "" : fmt::format(", {} of them", reference.texels()),
                    baker.low().triangles.size());
    experiment.item = "texel";
    experiment.items = static_cast<double>(reference.texels());
    const std::vector<Method> methods =
        methods_of(bakes, [&](const BakeSampling& way, const NormalMapFormat& format) {
            return method_of(way, format, size, options);
        });
    AssetOptions timed = options;
    timed.costs = {.one_thread = false, .memory = false};
    timed.run.repeats.warm_up = 0;
    finish(asset, methods, {.negligible_error = invisible_degrees}, timed);
    return asset;
}

}  // namespace relief::accuracy
