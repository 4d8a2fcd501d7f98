// SPDX-License-Identifier: Apache-2.0
// Normal maps written to and read from PNG files with each effort, interleaved with the writer and
// reader of OpenImageIO with default settings: `relief-image-files-bench [SIDE [ROUNDS
// [HEIGHT-MAP...]]]` prints a table in Markdown. Without files, the inputs are smooth, noisy and
// quantized fields of waves.
#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "base/files.h"
#include "bench_support.h"
#include "io/image/image_module_client.h"
#include "relief/accuracy/ground_truth.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/report.h"

namespace relief::bench {
using namespace relief::accuracy;
using namespace relief::detail;

namespace {

namespace fs = std::filesystem;

struct Map {
    std::string name;
    Image normals;
};

Image normals_of(const Image& heights, double strength) {
    Report report;
    BumpOptions options{Kernel::sobel3, Wrap::repeat};
    options.strength = strength;
    return normal_map_from_height(heights, options, {}, report);
}

std::vector<Map> made_maps(int side) {
    const BumpField field = wave_heights(side, side, tiling_waves(side, side, 40, 24.0, 0.4, 1));
    std::vector<Map> maps;
    const CodedHeights words = coded_heights(field.heights, 16);
    maps.push_back({"smooth, from 16 bits", normals_of(words.codes, words.strength)});
    const CodedHeights bytes = coded_heights(field.heights, 8);
    maps.push_back({"in steps, from 8 bits", normals_of(bytes.codes, bytes.strength)});
    Image noisy = words.codes;
    std::uint32_t state = 1;
    for (std::uint16_t& code : noisy.as<std::uint16_t>()) {
        state = state * 1664525U + 1013904223U;
        code = static_cast<std::uint16_t>(code / 2 + (state >> 26));
    }
    maps.push_back({"noisy, 64 of 65536", normals_of(noisy, words.strength * 2)});
    return maps;
}

[[noreturn]] void fail(const std::string& what) {
    throw Error("OpenImageIO: " + what);
}

const ImageModuleFailure failure{nullptr, [](void*, const char* text) { fail(text); }};

/// Writes by OpenImageIO with default settings.
void write_by_module(const fs::path& file, const Image& image) {
    const ImageModule& module = image_module(file);
    ImageModulePicture picture;
    picture.header = {image.width, image.height, image.channels, image.bits()};
    ImageModuleWriter* writer = module.create("png", file.c_str(), &picture, failure);
    std::visit([&](const auto& all) { module.write(writer, 0, image.height, all.data(), failure); },
               image.samples);
    module.finish(writer, failure);
    module.release(writer);
}

using relief::detail::read_by_module;

void read_by_module(const fs::path& file, Image& image) {
    const ImageModule& module = image_module(file);
    ImageModuleHeader header;
    const ImageModuleText none{nullptr, [](void*, const char*, const char*) {}};
    const RandomAccessFile opened(file);
    ImageModuleReader* reader =
        module.open_descriptor("png", opened.descriptor(), &header, none, failure);
    std::visit([&](auto& all) { module.read(reader, 0, header.height, all.data(), failure); },
               image.samples);
    module.close(reader);
}

struct Way {
    const char* name;
    WriteEffort effort;
    unsigned threads;
};

void compare(const Map& map, const fs::path& folder, std::size_t rounds) {
    constexpr Way ways[] = {{"relief, fast", WriteEffort::fast, 0},
                            {"relief, normal", WriteEffort::normal, 0},
                            {"relief, normal, one thread", WriteEffort::normal, 1},
                            {"relief, small", WriteEffort::small, 0}};
    const fs::path theirs = folder / "theirs.png";
    Image room = map.normals;
    std::vector<Contender> all;
    all.push_back({"OpenImageIO", [&] { write_by_module(theirs, map.normals); }});
    all.push_back({"", [&] { read_by_module(theirs, room); }});
    std::vector<fs::path> files{theirs};
    for (const Way& way : ways) {
        const fs::path file = folder / fmt::format("{}.png", files.size());
        files.push_back(file);
        all.push_back({way.name, [&map, file, way] {
                           set_thread_limit(way.threads);
                           write_image(file, map.normals, {}, {.effort = way.effort});
                       }});
        all.push_back({"", [file, way] {
                           set_thread_limit(way.threads);
                           read_image(file, ImageUse::data);
                       }});
    }
    measure(all, rounds, 1);
    set_thread_limit(0);
    const double raw = static_cast<double>(map.normals.sample_count()) * map.normals.bits() / 8;
    const auto least = static_cast<double>(fs::file_size(theirs));
    for (std::size_t i = 0; i < files.size(); ++i) {
        const auto size = static_cast<double>(fs::file_size(files[i]));
        fmt::print("| {} | {} | {:.3f} | {:.3f} | {:.1f} % | {:.2f} |\n", map.name, all[2 * i].name,
                   time_statistics(all[2 * i].nanoseconds).median / 1e9,
                   time_statistics(all[2 * i + 1].nanoseconds).median / 1e9, 100 * size / raw,
                   size / least);
    }
}

int run(int argc, char** argv) {
    const int side = argc > 1 ? std::atoi(argv[1]) : 2048;
    const std::size_t rounds = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 3;
    std::vector<Map> maps;
    for (int at = 3; at < argc; ++at) {
        const fs::path file = argv[at];
        maps.push_back({file.stem().string(), normals_of(read_image(file, ImageUse::data), 64.0)});
    }
    if (maps.empty()) maps = made_maps(side);
    const fs::path folder =
        fs::temp_directory_path() / fmt::format("relief-image-files-bench-{}", side);
    fs::create_directories(folder);
    fmt::print("| normal map | who | write, s | read, s | of the samples | of OpenImageIO's |\n");
    fmt::print("|---|---|---|---|---|---|\n");
    for (const Map& map : maps)
        compare(map, folder, rounds);
    fs::remove_all(folder);
    return 0;
}

}  // namespace
}  // namespace relief::bench

int main(int argc, char** argv) {
    return relief::bench::run(argc, argv);
}
