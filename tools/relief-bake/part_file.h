// SPDX-License-Identifier: Apache-2.0
/// \file
/// Part files: what a shard of a bake found, as `relief-bake mesh --shard K/N` writes it and
/// `relief-bake merge` reads it.
///
/// A file has "relief part 1\n", the texels, a JSON object, and 32 bytes: the offset, the length
/// and the FNV-1a hash of the JSON, and "end part". Numbers are little-endian. The texels are
/// chunks of at most 64 rows: a byte for the state of each texel, then for each layer the floats of
/// the baked texels. Each chunk follows its length and its hash. The JSON states the rows of the
/// chunks. Hashes find damaged files; every number is checked as well, so that no file does harm.
/// Tests: tests/tools/relief_bake_shards_test.cpp.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/material_maps.h"
#include "file_replacement.h"
#include "files.h"
#include "mesh_bake.h"
#include "relief/mesh/bake_shards.h"

namespace relief::tools {

/// 64-bit FNV-1a, for damaged and changed files; no protection against forged ones.
class ContentHash {
  public:
    void add(std::string_view bytes) {
        for (const char byte : bytes)
            hash_ = (hash_ ^ static_cast<unsigned char>(byte)) * 0x100000001B3ULL;
    }
    /// Adds a text and its end, so that "a", "bc" and "ab", "c" differ.
    void add_text(std::string_view text);
    /// \throws FileError
    void add_file(const std::filesystem::path& file);

    [[nodiscard]] std::uint64_t value() const { return hash_; }
    /// 16 hexadecimal digits.
    [[nodiscard]] std::string text() const;

  private:
    std::uint64_t hash_ = 0xCBF29CE484222325ULL;
};

/// What all parts of a bake have in common, and distinguishes them from those of others.
struct PartJob {
    std::string version;                 ///< Of the program.
    std::size_t count = 0;               ///< Of shards.
    std::vector<std::string> arguments;  ///< "--size=512", without those of the process.
    std::vector<std::string> files;      ///< HIGH... LOW OUT, as given.
    std::vector<std::pair<std::string, std::string>> inputs;  ///< Names and hashes.

    friend bool operator==(const PartJob&, const PartJob&) = default;

    /// The hash of all of it.
    [[nodiscard]] std::string hash() const;
};

/// The rows of a part.
struct PartRows {
    std::size_t map = 0;
    BakeShard found;
    std::uint64_t offset = 0;  ///< Of the first chunk in the file.
};

/// All of a part but its texels.
struct Part {
    PartJob job;
    std::size_t shard = 0;
    BakeFacts facts;
    MeshBake bake;               ///< Without maps and findings of maps.
    std::vector<MapPlan> plans;  ///< Without triangles and output.
    std::vector<PartRows> rows;
    double milliseconds = 0.0;  ///< Of the bake.
};

/// A layer of a chunk.
struct PartLayer {
    std::span<float> BakedRows::*values;
    std::size_t channels;
    bool (*is_requested)(const BakeLayers& layers);
};

/// The layers that a chunk may hold, in its order.
inline constexpr std::array part_layers = {
    PartLayer{&BakedRows::normals, 3, [](const BakeLayers& l) { return l.normals; }},
    PartLayer{&BakedRows::heights, 1, [](const BakeLayers& l) { return l.heights; }},
    PartLayer{&BakedRows::occlusion, 1,
              [](const BakeLayers& l) { return l.occlusion.has_value(); }},
    PartLayer{&BakedRows::curvature, 1, [](const BakeLayers& l) { return l.curvature; }},
    PartLayer{&BakedRows::positions, 3, [](const BakeLayers& l) { return l.positions; }},
    PartLayer{&BakedRows::colors, 3, [](const BakeLayers& l) { return l.colors; }},
    PartLayer{&BakedRows::opacity, 1, [](const BakeLayers& l) { return l.opacity; }},
    PartLayer{&BakedRows::surface, 3, [](const BakeLayers& l) { return l.surface; }},
    PartLayer{&BakedRows::emission, 3, [](const BakeLayers& l) { return l.emission; }},
    PartLayer{&BakedRows::bent_normals, 3,
              [](const BakeLayers& l) { return l.bent_normals.has_value(); }},
    PartLayer{&BakedRows::thickness, 1,
              [](const BakeLayers& l) { return l.thickness.has_value(); }},
    PartLayer{&BakedRows::ids, 1, [](const BakeLayers& l) { return l.ids; }}};

/// Writes a part. Without finish(), no file is left.
class PartWriter {
  public:
    /// \throws FileError
    explicit PartWriter(const std::filesystem::path& file);

    /// Begins the rows of a map, and returns their offset.
    std::uint64_t offset() const { return offset_; }

    /// Writes rows. \throws FileError
    void write(const BakedRows& rows);

    /// Writes the rest and replaces the file. \throws FileError
    void finish(const Part& part);

  private:
    void put(std::string_view bytes);

    relief::detail::FileReplacement replacement_;
    std::ofstream stream_;
    std::uint64_t offset_ = 0;
};

/// A part that is opened for reading.
class PartFile {
  public:
    /// Reads all but the texels. \throws FileError if the file is no part, damaged, or not possible
    explicit PartFile(const std::filesystem::path& file);

    [[nodiscard]] const Part& part() const { return part_; }
    [[nodiscard]] const std::filesystem::path& path() const { return file_.path(); }

    /// Reads the chunk at an offset: the states and the baked texels of its rows.
    /// \param rows    of the chunk
    /// \param offset  becomes that of the next chunk
    /// \param ids     the number of ids
    /// \throws FileError if it is damaged, or not possible
    void read(const BakedRows& rows, std::uint64_t& offset, std::size_t ids) const;

  private:
    relief::detail::RandomAccessFile file_;
    Part part_;
};

/// The number of rows of a chunk.
inline constexpr int part_chunk_rows = 64;

}  // namespace relief::tools
