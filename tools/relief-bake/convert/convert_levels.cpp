// SPDX-License-Identifier: Apache-2.0
// Encoding and writing of a map and its levels. Tests: tests/tools/convert_test.cpp.
#include "convert/convert_levels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/text.h"
#include "relief/mesh/image_channels.h"
#include "relief/mesh/mip_levels.h"
#include "relief/mesh/normal_mips.h"

namespace relief::tools {
namespace {

/// Lengths of a map's own normals.
Image ones(int width, int height) {
    Image image = make_image(width, height, 1, 32, ColorSpace::data);
    std::fill(image.as<float>().begin(), image.as<float>().end(), 1.0F);
    return image;
}

double mean_of(const Image& image) {
    double sum = 0.0;
    for (const float value : image.as<float>())
        sum += static_cast<double>(value);
    return sum / static_cast<double>(image.sample_count());
}

std::string level_words(std::size_t count, const MipChoice& choice) {
    std::string words = fmt::format("{} of mean vectors below it", counted(count, "mip level"));
    if (choice.lengths) words += ", lengths in alpha";
    if (choice.roughness) words += fmt::format(", roughness {:g} made up for", *choice.roughness);
    return words;
}

/// One channel in the depth of the map.
Image coded(const Image& values, int bits) {
    if (bits == 32) return values;
    Image result = make_image(values.width, values.height, 1, bits, ColorSpace::data);
    const std::span<const float> from = values.as<float>();
    std::visit(
        [&]<typename Sample>(std::vector<Sample>& samples) {
            const float largest = bits == 8 ? 255.0F : 65535.0F;
            for (std::size_t i = 0; i < samples.size(); ++i)
                samples[i] = static_cast<Sample>(std::lround(from[i] * largest));
        },
        result.samples);
    return result;
}

}  // namespace

std::filesystem::path level_file(const std::filesystem::path& output, std::size_t level,
                                 bool is_roughness) {
    std::string name = output.stem().string();
    if (is_roughness) name += "-roughness";
    if (level > 0) name += fmt::format("-mip{:02}", level);
    return output.parent_path() / (name + output.extension().string());
}

std::vector<std::filesystem::path> files_of(const std::filesystem::path& output,
                                            const MipChoice& mips) {
    std::vector<std::filesystem::path> files = {output};
    constexpr std::size_t most_levels = 31;  // Of a side that an int can hold.
    for (std::size_t level = 0; mips.wanted && level <= most_levels; ++level) {
        if (level > 0) files.push_back(level_file(output, level, false));
        if (mips.roughness) files.push_back(level_file(output, level, true));
    }
    return files;
}

LevelWriter::LevelWriter(const Job& job, const ConvertRequest& request,
                         const std::map<std::string, std::string>& input_metadata, Converted& done)
    : job_(job), request_(request), kept_(kept_metadata(input_metadata)), done_(done) {}

/// What the input said, but for what is no longer so.
std::map<std::string, std::string> LevelWriter::metadata() const {
    NormalMapFormat format = done_.format;
    format.green = done_.green.value_or(Green::up);
    std::map<std::string, std::string> entries = normal_map_metadata(format);
    if (!done_.green) entries.erase("relief:green");
    if (done_.content) entries["relief:content"] = *done_.content;
    for (const auto& [key, value] : kept_) {
        if (key == "relief:content")
            entries[key] = done_.content.value_or(value);
        else if (key != "relief:green" && key != "relief:flat")
            entries.emplace(key, value);
    }
    return entries;
}

void LevelWriter::write(const std::filesystem::path& file, const Image& image,
                        const std::map<std::string, std::string>& metadata, Report& report) const {
    write_image(file, image, metadata, write_options_of(request_.output, file), report);
}

void LevelWriter::write_codes(const Image& codes, Report& report) {
    write(job_.output, codes, metadata(), report);
    done_.levels.push_back({job_.output, codes.width, codes.height, 1.0, 1.0, {}, {}});
}

void LevelWriter::write_roughness(WrittenLevel& written, std::size_t level, const Image& lengths,
                                  Stages& stages, Report& report) {
    const double base = *request_.mips.roughness;
    const std::filesystem::path file = level_file(job_.output, level, true);
    const Image roughness =
        stages.run("convert", [&] { return roughness_from_lengths(lengths, base); });
    written.roughness_file = file;
    written.mean_roughness = mean_of(roughness);
    stages.run("write", [&] {
        write(file, coded(roughness, done_.format.bits),
              {{"relief:content", "roughness"}, {"relief:roughness", fmt::format("{:g}", base)}},
              report);
    });
}

Image LevelWriter::coded_level(const Image& normals, const std::optional<Image>& alpha,
                               Report& report) const {
    NormalMapFormat as_stored = done_.format;
    as_stored.green = Green::up;
    Image codes = encode_normal_map(normals, as_stored, report);
    return alpha ? with_alpha(codes, *alpha) : codes;
}

void LevelWriter::write_level(std::size_t level, const Image& codes, const Image& lengths,
                              Stages& stages, Report& report) {
    const std::filesystem::path file =
        level == 0 ? job_.output : level_file(job_.output, level, false);
    const auto all = lengths.as<float>();
    const auto least = static_cast<double>(*std::min_element(all.begin(), all.end()));
    WrittenLevel written{file, codes.width, codes.height, mean_of(lengths), least, {}, {}};
    stages.run("write", [&] { write(file, codes, metadata(), report); });
    if (request_.mips.roughness) write_roughness(written, level, lengths, stages, report);
    done_.levels.push_back(std::move(written));
}

/// The map and all levels below it.
void LevelWriter::write_all_levels(NormalField& field, Stages& stages, Report& report) {
    const auto code_and_write = [&](std::size_t level, const Image& normals, const Image& lengths,
                                    const std::optional<Image>& alpha) {
        const Image codes = stages.run("convert", [&] {
            return request_.mips.lengths ? coded_level(normals, lengths, report)
                                         : coded_level(normals, alpha, report);
        });
        write_level(level, codes, lengths, stages, report);
    };
    code_and_write(0, field.normals, ones(field.normals.width, field.normals.height), field.alpha);
    std::vector<Image> levels =
        stages.run("convert", [&] { return normal_mip_levels(field.normals); });
    field.normals = Image{};
    done_.steps.push_back(level_words(levels.size(), request_.mips));
    const std::vector<Image> alphas = field.alpha ? mip_levels(*field.alpha) : std::vector<Image>{};
    for (std::size_t i = 0; i < levels.size(); ++i) {
        const Image lengths =
            stages.run("convert", [&] { return split_lengths(levels[i], report); });
        code_and_write(i + 1, levels[i], lengths,
                       alphas.empty() ? std::nullopt : std::optional<Image>(alphas[i]));
    }
}

void LevelWriter::write_levels(NormalField& field, Stages& stages, Report& report) {
    if (request_.mips.lengths && field.alpha) {
        throw UsageError(
            fmt::format("--mip-lengths: {} has an alpha of its own", job_.input.string()),
            "--alpha drop makes room");
    }
    if (request_.mips.wanted) return write_all_levels(field, stages, report);
    const Image codes =
        stages.run("convert", [&] { return coded_level(field.normals, field.alpha, report); });
    field = NormalField{};  // Before writing, which takes memory itself.
    stages.run("write", [&] { write_codes(codes, report); });
}

}  // namespace relief::tools
