// SPDX-License-Identifier: Apache-2.0
/// \file
/// The messages between a program and its image decoder process, over a socket.
///
/// The program sends one request at a time, and the decoder sends one reply. Both have the same
/// build, so messages are plain structures. The first reply comes without a request: it tells
/// whether the image module was loaded. The program does not trust the numbers in replies.
#pragma once

#include <cstddef>
#include <cstdint>

#include "io/image/image_module.h"

namespace relief {

/// The file name of the decoder; it is in the folder of the image module.
inline constexpr const char* decoder_name = "relief-image-decoder";

enum class DecoderAction : std::uint32_t { open, read, close };

struct DecoderRequest {
    DecoderAction action = DecoderAction::open;
    /// open: whether the descriptor, which is sent with the request, is memory that can be mapped.
    std::uint32_t in_memory = 0;
    char format[16] = {};       ///< open: OpenImageIO's name.
    std::uint64_t size = 0;     ///< open: encoded bytes in memory.
    std::int64_t first = 0;     ///< read: the first row.
    std::int64_t end = 0;       ///< read: the row after the last one.
    std::uint64_t memory = 0;   ///< Bytes that the decoder may allocate for this request.
    std::uint64_t seconds = 0;  ///< Processor time that it may use for this request.
};

struct DecoderReply {
    std::uint32_t version = image_module_version;
    std::uint32_t succeeded = 0;
    ImageModuleHeader header;    ///< open.
    std::int64_t row_grain = 1;  ///< open.
    /// Bytes that follow. After a failure: its reason. open: text entries, each a key and a value
    /// that end with a zero byte. read: samples.
    std::uint64_t size = 0;
};

}  // namespace relief
