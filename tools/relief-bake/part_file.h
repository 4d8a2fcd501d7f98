// SPDX-License-Identifier: Apache-2.0
/// \file
/// Part files: what a shard of a bake found, as `relief-bake mesh --shard K/N` writes it and
/// `relief-bake merge` reads it.
///
/// A file has "relief part 1\n", the texels, a JSON object, and 32 bytes: the offset, the length
/// and the FNV-1a hash of the JSON, and "end part". Numbers are little-endian. The texels are
/// chunks of at most 64 rows: a byte for the state of each texel, then for each layer
/// (row_layers()) the floats of the baked texels. Each chunk follows its length and its hash. The
/// JSON states the rows of the chunks. Hashes find damaged files; every number is checked as well,
/// so that no file does harm. Tests: tests/tools/relief_bake_shards_test.cpp.
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
#include "common/part_job.h"
#include "file_replacement.h"
#include "files.h"
#include "mesh_bake.h"
#include "relief/mesh/bake_shards.h"

namespace relief::tools {

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

/// Returns the description of a part.
Json part_json(const Part& part);
/// Reads a description. \throws InvalidInput if it is damaged or inconsistent
Part parse_part(const std::string& json);

/// Writes a part. Without finish(), no file is left.
class PartWriter {
  public:
    /// \throws FileError
    explicit PartWriter(const std::filesystem::path& file);

    /// Returns the offset of the next rows.
    [[nodiscard]] std::uint64_t offset() const { return offset_; }

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
    /// Reads all but the texels. \throws FileError if the file is not a part, or is damaged or
    /// inconsistent
    explicit PartFile(const std::filesystem::path& file);

    [[nodiscard]] const Part& part() const { return part_; }
    [[nodiscard]] const std::filesystem::path& path() const { return file_.path(); }

    /// Reads the chunk at an offset: the states and the baked texels of its rows.
    /// \param rows    of the chunk
    /// \param offset  becomes that of the next chunk
    /// \param ids     the number of ids
    /// \throws FileError if it is damaged or inconsistent
    void read(const BakedRows& rows, std::uint64_t& offset, std::size_t ids) const;

  private:
    relief::detail::RandomAccessFile file_;
    Part part_;
};

/// The number of rows of a chunk.
inline constexpr int part_chunk_rows = 64;

}  // namespace relief::tools
