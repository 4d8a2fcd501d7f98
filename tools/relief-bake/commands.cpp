// SPDX-License-Identifier: Apache-2.0
// Code that the commands of relief-bake share: the list of commands, the conversion of one map or
// many, and the storage of normal maps. Tests: tests/tools/relief_bake_bump_test.cpp,
// relief_bake_convert_test.cpp.
#include "commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/options.h"
#include "common/summary.h"
#include "relief/mesh/execution.h"

namespace relief::tools {
namespace {

/// The name of an output file in a folder: the extension changes only if it cannot store normals.
std::filesystem::path name_in_folder(const std::filesystem::path& input) {
    std::filesystem::path name = input.filename();
    const bool is_kept = !depths_of(name).empty() && !is_texture(name);
    return is_kept ? name : name.replace_extension(".png");
}

/// Checks everything that the command line shows before any file is read.
void check_jobs(const MapFiles& files, const MapWork& work, const JobList& list) {
    std::vector<std::filesystem::path> used;
    for (const Job& job : list.jobs) {
        work.check(job);
        used.insert(used.end(), {job.input, job.output});
    }
    if (list.folder) make_folder(*list.folder);
    check(files.report, used);
    require_folder_of(list.jobs.front().output);
}

/// Returns whether converting several maps at once would need too much memory. Each conversion uses
/// all threads anyway; only the reading of small files gains from concurrency.
bool are_large(const std::vector<Job>& jobs) {
    constexpr std::uintmax_t large_file = 32'000'000;
    return std::any_of(jobs.begin(), jobs.end(), [](const Job& job) {
        std::error_code error;
        const std::uintmax_t size = std::filesystem::file_size(job.input, error);
        return !error && size > large_file;
    });
}

ExitCode run_one(const CLI::App& app, const MapFiles& files, const MapWork& work, const Job& job) {
    Stages stages(files.general.quiet);
    const FileOutcome outcome = work.work(job, stages);
    if (!files.general.quiet) outcome.summary.print();
    Json report = work.head;
    report["input"] = job.input.string();
    report["output"] = job.output.string();
    report.update(outcome.summary.json());
    return finish(app, files.report, job.input, outcome.findings, report);
}

ExitCode run_all(const CLI::App& app, const MapFiles& files, const MapWork& work,
                 const JobList& list) {
    Batch batch;
    batch.jobs = list.jobs;
    batch.head = work.head;
    batch.one_by_one = are_large(list.jobs);
    batch.work = [&](std::size_t index) {
        Stages stages(true);
        return work.work(list.jobs[index], stages);
    };
    return run_batch(app, batch, files.report, files.general);
}

/// "zero at 127.5 of 255 (the glTF decoding; flat texels have an error of 0.32 degrees)"
std::string describe_zero_code(const NormalMapFormat& format) {
    const double largest = format.bits == 8 ? 255.0 : 65535.0;
    // The error is half a code in x and in y.
    const std::string degrees =
        fmt::format("{:.2g}", std::atan(std::numbers::sqrt2 / largest) * 180.0 / std::numbers::pi);
    if (format.flat == FlatCode::middle) {
        return fmt::format(
            "zero at {:g} of {:g} (glTF and engines decode zero at {:g}, which tilts normals by {} "
            "degrees)",
            (largest + 1.0) / 2.0, largest, largest / 2.0, degrees);
    }
    const std::string flat = format.dither == Dither::none
                                 ? fmt::format("; flat texels have an error of {} degrees", degrees)
                                 : "";
    return fmt::format("zero at {:g} of {:g} (the decoding of glTF and engines{})", largest / 2.0,
                       largest, flat);
}

[[noreturn]] void refuse_format(const std::filesystem::path& output) {
    const std::string extension = extension_of(output);
    std::string problem = "the format cannot store a normal map";
    if (extension == ".jpg" || extension == ".jpeg") problem = "JPEG compression distorts normals";
    if (extension == ".hdr") problem = "HDR stores normals with only 8 bits and without a sign";
    throw UsageError(output.string() + ": " + problem, "use .png, .tif, .exr, .ktx2 or .dds");
}

/// Textures are encoded from exact normals.
NormalMapFormat texture_input_format(const MapOutputOptions& options,
                                     const MapOutputDefaults& defaults) {
    // --for sets the bits and the code of zero of images.
    const bool sets_codes = !options.engine && (options.bits || options.flat);
    if (sets_codes || options.dither) {
        throw UsageError("--bits, --zero-code, --dither: have no effect on textures",
                         "relief-bake convert --format chooses their format");
    }
    return {.bits = 32,
            .green = options.green.value_or(defaults.green),
            .flat = FlatCode::half,
            .dither = Dither::none};
}

}  // namespace

bool is_texture(const std::filesystem::path& file) {
    const std::string extension = extension_of(file);
    return extension == ".ktx2" || extension == ".dds";
}

Tool relief_bake() {
    return {"relief-bake",
            "Makes normal maps and textures.",
            {add_bump_command, add_mesh_command, add_merge_command, add_convert_command,
             add_map_check_command, add_heights_command, add_pack_command, add_textures_command}};
}

void add_map_files(CLI::App& app, MapFiles& files, const std::string& input,
                   const std::string& details, const std::string& output) {
    add_files(app, "FILE...", files.words.files,
              fmt::format("IN OUT: the {} to read and the {} to write (.png .tif .exr .ktx2 .dds). "
                          "With -o: one or more {}s to read. <UDIM> in a file name means all "
                          "tiles that exist. {}",
                          input, output, input, details));
}

void add_map_folder(CLI::App& app, MapFiles& files) {
    add_value(app, "-o,--output", "PATH",
              "Output folder, or the output file of a single map. A path that ends in / or names "
              "an existing folder is a folder. In a folder, each map keeps its file name. If a map "
              "fails, the others are still converted.",
              [&files](const std::string&, const std::string& text) { files.words.output = text; })
        .group("Output");
}

void refuse_to_replace(const std::filesystem::path& file, const std::string& kind, const Job& job) {
    std::error_code error;
    if (!std::filesystem::equivalent(file, job.output, error)) return;
    throw UsageError(fmt::format("{}: would replace the {}", job.output.string(), kind),
                     "choose another output file or folder");
}

ExitCode run_map_jobs(const CLI::App& app, const MapFiles& files, const MapWork& work) {
    const JobList list = jobs_of(files.words, "map", name_in_folder);
    check_jobs(files, work, list);
    set_thread_limit(files.general.threads);
    return list.is_single() ? run_one(app, files, work, list.jobs.front())
                            : run_all(app, files, work, list);
}

std::vector<int> depths_of(const std::filesystem::path& output) {
    const std::string extension = extension_of(output);
    if (extension == ".png") return {16, 8};
    if (extension == ".tif" || extension == ".tiff") return {16, 8, 32};
    if (extension == ".exr") return {32};
    if (is_texture(output)) return {16, 8, 32};
    return {};
}

void check_depth(const char* option, int bits, const std::filesystem::path& output,
                 const std::vector<int>& depths, const std::string& remedy) {
    if (std::ranges::count(depths, bits) > 0) return;
    throw UsageError(fmt::format("{} {}: {} holds {} bits", option, bits, extension_of(output),
                                 fmt::join(depths, " or ")),
                     remedy);
}

void add_map_output_options(CLI::App& app, MapOutputOptions& options, bool follows_input) {
    const std::string group = "Output";
    const auto default_text = [&](const std::string& otherwise) {
        return " Default: " + (follows_input ? std::string("as in the input.") : otherwise);
    };
    const Choices<int> depths = {{"8", 8}, {"16", 16}, {"32", 32}};
    add_choice(app, "--for", options.engine, enum_choices<Engine>(),
               "Write what an engine reads: green up for gltf, godot and unity, down for unreal; 8 "
               "bits unless --bits is given; zero at 127.5.")
        .group(group);
    add_choice(app, "--green", options.green, enum_choices<Green>(),
               "Direction of the green channel: up (OpenGL, glTF) or down (DirectX)." +
                   default_text("up."))
        .group(group);
    add_choice(app, "--bits", options.bits, depths,
               "Bits per channel: 8 or 16 for .png; 8, 16 or 32 (float) for .tif; 32 for .exr." +
                   default_text("16, and 32 for .exr."))
        .group(group);
    add_choice(app, "--zero-code", options.flat, enum_choices<FlatCode>(),
               "The code of 255 that represents zero; in 16 bits, the corresponding code of 65535. "
               "127.5: glTF and engines decode maps this way; no code is exactly zero. 128: flat "
               "texels are exactly flat for readers that use this convention, but engines decode "
               "all normals with an error of 0.32 degrees (8 bits) or 0.0012 degrees (16 bits)." +
                   default_text("127.5."))
        .group(group);
    add_choice(app, "--dither", options.dither, enum_choices<Dither>(),
               "Rounding to codes: none rounds to the nearest code; ordered (a short repeated "
               "pattern) and blue-noise (the least visible pattern) keep the mean over a few "
               "texels correct. Default: none.")
        .group(group);
    add_switch(app, "--half", options.half,
               "Store .exr as 16-bit half floats (11 significant bits), which halves the size.")
        .group(group);
    add_switch(app, "--fast", options.fast, "Compress for speed; the file is larger.").group(group);
    add_switch(
        app, "--small", options.small,
        "Compress for size; writing takes up to ten times as long. A 16-bit map of bricks is "
        "5 % smaller in twice the time, and noise is not smaller at all.")
        .group(group);
}

void apply_engine(MapOutputOptions& options) {
    if (!options.engine) return;
    const EngineRules& rules = rules_of(*options.engine);
    const std::string engine = enum_name(*options.engine);
    if (options.green && *options.green != rules.green) {
        throw UsageError(fmt::format("--green {}, --for {}: contradict each other",
                                     enum_name(*options.green), engine));
    }
    if (options.flat == FlatCode::middle) {
        throw UsageError(fmt::format("--zero-code 128, --for {}: contradict each other", engine),
                         "engines decode zero at 127.5");
    }
    options.green = rules.green;
    if (!options.bits) options.bits = rules.bits;
    if (options.bits != 32) options.flat = FlatCode::half;
}

NormalMapFormat format_of(const MapOutputOptions& options, const std::filesystem::path& output,
                          const MapOutputDefaults& defaults) {
    const std::vector<int> depths = depths_of(output);
    if (depths.empty()) refuse_format(output);
    if (is_texture(output)) return texture_input_format(options, defaults);
    const bool has_default = defaults.bits && std::ranges::count(depths, *defaults.bits) > 0;
    const int bits = options.bits.value_or(has_default ? *defaults.bits : depths.front());
    const bool suggests_half = bits == 16 && extension_of(output) == ".exr";
    check_depth("--bits", bits, output, depths, suggests_half ? "--half stores half floats" : "");
    if (bits == 32 && options.flat)
        throw UsageError("--zero-code: has no effect on 32-bit output, where zero is exact");
    if (bits == 32 && options.dither)
        throw UsageError("--dither: has no effect on 32-bit output, which is not rounded to codes");
    return {.bits = bits,
            .green = options.green.value_or(defaults.green),
            .flat = options.flat.value_or(defaults.flat),
            .dither = options.dither.value_or(Dither::none)};
}

ImageWriteOptions write_options_of(const MapOutputOptions& options,
                                   const std::filesystem::path& output) {
    if (options.fast && options.small) throw UsageError("--fast, --small: contradict each other");
    if ((options.fast || options.small) && is_texture(output))
        throw UsageError("--fast, --small: have no effect on textures");
    if (options.half && extension_of(output) != ".exr")
        throw UsageError("--half: is for .exr, not " + output.filename().string());
    ImageWriteOptions result;
    result.half = options.half;
    if (options.fast) result.effort = WriteEffort::fast;
    if (options.small) result.effort = WriteEffort::small;
    return result;
}

std::string to_string(const NormalMapFormat& format) {
    const std::string green = std::string("green ") + enum_name(format.green);
    if (format.bits == 32) return "32 bit float, " + green;
    const std::string dither =
        format.dither == Dither::none ? "" : std::string(", dithered ") + enum_name(format.dither);
    return fmt::format("{} bit, {}, {}{}", format.bits, describe_zero_code(format), green, dither);
}

}  // namespace relief::tools
