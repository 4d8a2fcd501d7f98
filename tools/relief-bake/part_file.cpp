// SPDX-License-Identifier: Apache-2.0
// The format of part files: chunks of texels, a description, and hashes of both. part_json.cpp has
// the description. Tests: tests/tools/relief_bake_shards_test.cpp.
#include "part_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "common/content_hash.h"

namespace relief::tools {
namespace {

constexpr std::string_view part_magic = "relief part 1\n";
constexpr std::string_view part_end = "end part";
constexpr std::size_t trailer_bytes = 32;
constexpr std::uint64_t max_json_bytes = 64'000'000;

static_assert(std::endian::native == std::endian::little, "floats are stored as they are");

std::string bytes_of(std::uint64_t number) {
    std::string bytes(8, '\0');
    for (char& byte : bytes) {
        byte = static_cast<char>(number & 0xFF);
        number >>= 8;
    }
    return bytes;
}

std::uint64_t number_of(std::string_view bytes) {
    std::uint64_t number = 0;
    for (std::size_t i = 8; i-- > 0;)
        number = number << 8 | static_cast<unsigned char>(bytes[i]);
    return number;
}

std::string read_text(const relief::detail::RandomAccessFile& file, std::uint64_t offset,
                      std::size_t size) {
    std::string bytes(size, '\0');
    file.read(offset, std::as_writable_bytes(std::span(bytes)));
    return bytes;
}

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& problem) {
    throw failure(file, problem, "repeat its shard");
}

}  // namespace

PartWriter::PartWriter(const std::filesystem::path& file)
    : replacement_(file), stream_(replacement_.written_path(), std::ios::binary) {
    put(part_magic);
}

void PartWriter::put(std::string_view bytes) {
    stream_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (!stream_) throw FileError(replacement_.file(), "cannot be written; the disk may be full");
    offset_ += bytes.size();
}

void PartWriter::write(const BakedRows& rows) {
    const std::size_t width = rows.states.size() / static_cast<std::size_t>(rows.row_count);
    for (int first = 0; first < rows.row_count; first += part_chunk_rows) {
        const auto begin = static_cast<std::size_t>(first) * width;
        const std::size_t texels =
            static_cast<std::size_t>(std::min(part_chunk_rows, rows.row_count - first)) * width;
        std::string chunk;
        for (const TexelState state : rows.states.subspan(begin, texels))
            chunk.push_back(static_cast<char>(state));
        for (const auto& [layer, channels, is_requested] : row_layers()) {
            const std::span<const float> values = rows.*layer;
            if (values.empty()) continue;
            for (std::size_t i = begin; i < begin + texels; ++i) {
                if (rows.states[i] != TexelState::baked) continue;
                const auto bytes = std::as_bytes(values.subspan(channels * i, channels));
                chunk.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
            }
        }
        ContentHash hash;
        hash.add(chunk);
        put(bytes_of(chunk.size()) + bytes_of(hash.value()));
        put(chunk);
    }
}

void PartWriter::finish(const Part& part) {
    const std::string json = part_json(part).dump();
    ContentHash hash;
    hash.add(json);
    const std::uint64_t offset = offset_;
    put(json);
    put(bytes_of(offset) + bytes_of(json.size()) + bytes_of(hash.value()));
    put(part_end);
    stream_.close();
    if (!stream_) throw FileError(replacement_.file(), "cannot be written; the disk may be full");
    replacement_.commit();
}

PartFile::PartFile(const std::filesystem::path& file) : file_(file) {
    if (file_.size() < part_magic.size() + trailer_bytes ||
        read_text(file_, 0, part_magic.size()) != part_magic)
        throw failure(file, "is not a part of a bake", "relief-bake mesh --shard writes parts");
    const std::string trailer = read_text(file_, file_.size() - trailer_bytes, trailer_bytes);
    const std::uint64_t offset = number_of(std::string_view(trailer).substr(0, 8));
    const std::uint64_t size = number_of(std::string_view(trailer).substr(8, 8));
    const std::uint64_t end = file_.size() - trailer_bytes;
    if (!trailer.ends_with(part_end) || offset < part_magic.size() || offset > end ||
        size != end - offset || size > max_json_bytes)
        refuse(file, "is damaged: its end is missing");
    const std::string json = read_text(file_, offset, static_cast<std::size_t>(size));
    ContentHash hash;
    hash.add(json);
    if (hash.value() != number_of(std::string_view(trailer).substr(16, 8)))
        refuse(file, "is damaged: the hash of its description differs");
    try {
        part_ = parse_part(json);
    } catch (const InvalidInput& error) {
        refuse(file, std::string("is damaged: ") + error.what());
    }
}

void PartFile::read(const BakedRows& rows, std::uint64_t& offset, std::size_t ids) const {
    const std::size_t texels = rows.states.size();
    constexpr std::size_t head_bytes = 16;
    const std::string head = read_text(file_, offset, head_bytes);
    const std::uint64_t size = number_of(std::string_view(head).substr(0, 8));
    std::size_t values = 0;  // Of a texel.
    for (const auto& [layer, channels, is_requested] : row_layers())
        values += (rows.*layer).empty() ? 0 : channels;
    const std::string name =
        fmt::format("rows {} to {}", rows.first_row, rows.first_row + rows.row_count);
    if (size < texels || size > texels * (1 + sizeof(float) * values))
        refuse(path(), fmt::format("is damaged: the size of {} is impossible", name));
    const std::string chunk = read_text(file_, offset + head_bytes, static_cast<std::size_t>(size));
    ContentHash hash;
    hash.add(chunk);
    if (hash.value() != number_of(std::string_view(head).substr(8, 8)))
        refuse(path(), fmt::format("is damaged: the hash of {} differs", name));
    std::size_t baked = 0;
    for (std::size_t i = 0; i < texels; ++i) {
        const auto state = static_cast<unsigned char>(chunk[i]);
        if (state > static_cast<unsigned char>(TexelState::baked))
            refuse(path(), fmt::format("is damaged: {} have an unknown state", name));
        rows.states[i] = static_cast<TexelState>(state);
        baked += rows.states[i] == TexelState::baked ? 1 : 0;
    }
    if (size != texels + sizeof(float) * values * baked)
        refuse(path(), fmt::format("is damaged: the size of {} is impossible", name));
    const char* from = chunk.data() + texels;
    for (const auto& [layer, channels, is_requested] : row_layers()) {
        const std::span<float> target = rows.*layer;
        if (target.empty()) continue;
        for (std::size_t i = 0; i < texels; ++i) {
            if (rows.states[i] != TexelState::baked) continue;
            std::memcpy(&target[channels * i], from, channels * sizeof(float));
            from += channels * sizeof(float);
        }
    }
    const bool has_ids = std::ranges::all_of(rows.ids, [&](float id) {
        return id == -1.0F || (id >= 0.0F && id < static_cast<float>(ids) && id == std::floor(id));
    });
    if (!has_ids) refuse(path(), fmt::format("is damaged: {} have an unknown id", name));
    offset += head_bytes + size;
}

}  // namespace relief::tools
