// SPDX-License-Identifier: Apache-2.0
// zlib streams by libdeflate. Memory is touched only as far as a stream really fills it, so that
// a size that lies costs nothing. Tests: tests/mesh/io/image/png_test.cpp.
#include "io/image/deflate.h"

#include <libdeflate.h>

#include <new>

namespace relief {
namespace {

struct Free {
    void operator()(libdeflate_compressor* all) const { libdeflate_free_compressor(all); }
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

Packed deflate(std::span<const std::byte> from, int level) {
    const std::unique_ptr<libdeflate_compressor, Free> compressor(
        libdeflate_alloc_compressor(level));
    if (!compressor) throw std::bad_alloc();
    const std::size_t bound = libdeflate_zlib_compress_bound(compressor.get(), from.size());
    Packed packed{std::make_unique_for_overwrite<std::byte[]>(bound), 0};
    packed.size = libdeflate_zlib_compress(compressor.get(), from.data(), from.size(),
                                           packed.bytes.get(), bound);
    return packed;
}

std::uint32_t crc32(std::span<const std::byte> bytes) {
    return libdeflate_crc32(0, bytes.data(), bytes.size());
}

}  // namespace relief
