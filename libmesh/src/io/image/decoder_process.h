// SPDX-License-Identifier: Apache-2.0
/// \file
/// Image decoding in another process, so that a reader of OpenImageIO that crashes, never returns
/// or allocates too much ends that process and not this one; and the messages of both, over a
/// socket.
///
/// The program sends one request at a time, and the decoder sends one reply. Both have the same
/// build, so messages are plain structures. The first reply comes without a request: it tells
/// whether the image module was loaded. The program does not trust the numbers in replies, and
/// limits the memory and time of the decoder from outside.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>

#include "io/image/image_module.h"

namespace relief::detail {

// In the program

class DecoderProcess;

/// The time that is left for an image. All requests for the image share it.
struct DecoderTime {
    std::chrono::nanoseconds computing{0};  ///< Processor time of the decoder.
    std::chrono::nanoseconds waiting{0};    ///< For replies.

    /// Adds the time for so many bytes, and some seconds for a whole image.
    void add(std::uint64_t bytes, bool is_image);
};

/// For tests: the most time in milliseconds that an image gets. 0 means that the size decides.
extern constinit std::atomic<int> max_decoder_milliseconds;

/// An image that a decoder process decodes.
///
/// A process is started by the first image that needs one. It serves further images after this one
/// is closed, and ends with this program. Images that are open at the same time have a process
/// each.
class DecodedImage {
  public:
    /// Decodes encoded bytes, which are copied. `format` is OpenImageIO's name for the format.
    /// \param name  for messages
    /// \throws FileError if the decoder is not found, refuses the image, crashes, or exceeds its
    ///         limits of memory and time
    DecodedImage(const char* format, std::span<const std::byte> bytes, std::filesystem::path name);

    /// Decodes an open file of `size` bytes; the descriptor is used by the constructor only.
    DecodedImage(const char* format, int descriptor, std::uint64_t size,
                 std::filesystem::path name);
    ~DecodedImage();
    DecodedImage(const DecodedImage&) = delete;
    DecodedImage& operator=(const DecodedImage&) = delete;

    /// The header as the decoder sent it. Width, height and channels are 0 to the largest int, and
    /// `bits` is 8, 16 or 32.
    [[nodiscard]] const ImageModuleHeader& header() const { return header_; }
    /// The height of a tile, or 1.
    [[nodiscard]] std::int64_t row_grain() const { return row_grain_; }
    [[nodiscard]] const std::map<std::string, std::string>& text() const { return text_; }

    /// Decodes rows [first, end), as ImageModule::read() does. The header must have been checked.
    /// \throws FileError
    void read(std::size_t first, std::size_t end, std::span<std::byte> samples);

  private:
    void open(const char* format, int descriptor, bool in_memory, std::uint64_t size);

    std::filesystem::path name_;
    std::unique_ptr<DecoderProcess> process_;  ///< Null after a failure.
    DecoderTime time_;
    bool has_time_to_decode_ = false;
    std::uint64_t encoded_size_ = 0;
    ImageModuleHeader header_;
    std::int64_t row_grain_ = 1;
    std::map<std::string, std::string> text_;
};

// Messages

/// The file name of the decoder; it is in the folder of the image module.
inline constexpr const char* decoder_name = "relief-image-decoder";

enum class DecoderAction : std::uint32_t { open, read, close };

struct DecoderRequest {
    DecoderAction action = DecoderAction::open;
    /// open: whether the descriptor, which is sent with the request, is memory that can be mapped.
    std::uint32_t in_memory = 0;
    char format[16] = {};    ///< open: OpenImageIO's name.
    std::uint64_t size = 0;  ///< open: encoded bytes in memory.
    std::int64_t first = 0;  ///< read: the first row.
    std::int64_t end = 0;    ///< read: the row after the last one.
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

}  // namespace relief::detail
