// SPDX-License-Identifier: Apache-2.0
// zlib streams by libdeflate. Memory is touched only as far as a stream really fills it, so that
// a size that lies costs nothing. Tests: tests/mesh/io/png/png_test.cpp.
#include "io/png/deflate.h"

#include <libdeflate.h>

#include <memory>
#include <new>

namespace relief {
namespace {

struct Free {
    void operator()(libdeflate_decompressor* all) const { libdeflate_free_decompressor(all); }
};

}  // namespace

bool inflate(std::span<const std::byte> stream, std::span<std::byte> to) {
    const std::unique_ptr<libdeflate_decompressor, Free> decompressor(
        libdeflate_alloc_decompressor());
    if (!decompressor) throw std::bad_alloc();
    // Without a place for the size that came out, another size than asked for is an error.
    return libdeflate_zlib_decompress(decompressor.get(), stream.data(), stream.size(), to.data(),
                                      to.size(), nullptr) == LIBDEFLATE_SUCCESS;
}

std::uint32_t crc32(std::span<const std::byte> bytes) {
    return crc32_of_more(0, bytes);
}

std::uint32_t crc32_of_more(std::uint32_t before, std::span<const std::byte> bytes) {
    return libdeflate_crc32(before, bytes.data(), bytes.size());
}

std::uint32_t adler32(std::span<const std::byte> bytes) {
    return libdeflate_adler32(1, bytes.data(), bytes.size());
}

std::uint32_t adler32_of_both(std::uint32_t first, std::uint32_t second, std::size_t second_size) {
    // The low half is 1 plus the sum of all bytes; the high half is the sum of the low half after
    // each byte, so that what the first bytes add to the low half counts once for each of the
    // second.
    constexpr std::uint64_t modulus = 65521;
    const std::uint64_t low_first = first & 0xFFFFU, low_second = second & 0xFFFFU;
    const std::uint64_t low = (low_first + low_second + modulus - 1) % modulus;
    const std::uint64_t carried = (low_first + modulus - 1) % modulus * (second_size % modulus);
    const std::uint64_t high = ((first >> 16) + (second >> 16) + carried) % modulus;
    return static_cast<std::uint32_t>(high << 16 | low);
}

}  // namespace relief
