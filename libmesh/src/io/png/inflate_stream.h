// SPDX-License-Identifier: Apache-2.0
/// \file
/// zlib streams read piece by piece, so that neither the stream nor what is in it is ever held
/// whole. ISA-L's only home: it is twice as fast as zlib, and nearly as fast as libdeflate, which
/// knows whole blocks of memory only. Source: [RFC 1950]. Tests:
/// tests/mesh/io/png/inflate_stream_test.cpp.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>

namespace relief {

class InflateStream {
  public:
    /// Gives the next bytes of the stream, which stay until it is asked again; none at its end.
    using Feed = std::function<std::span<const std::byte>()>;

    explicit InflateStream(Feed feed);
    ~InflateStream();
    InflateStream(const InflateStream&) = delete;
    InflateStream& operator=(const InflateStream&) = delete;

    /// Fills `to` with what comes next.
    /// \return false where the stream is damaged, or ends before
    bool fill(std::span<std::byte> to);

    /// Whether all has been had, and its checksum is right. To be asked once, at the end.
    bool is_complete();

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace relief
