// SPDX-License-Identifier: Apache-2.0
// Rows are kept one behind the other and moved to the front as the window moves on. A map that
// repeats has its last rows read first, by a reader of their own.
// Tests: tests/mesh/io/maps/bump_file_test.cpp.
#include "io/maps/height_window.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "relief/mesh/error.h"

namespace relief {
namespace {

int whole_height(const HeightMapFile& file) {
    return file.info().height;
}

/// The last rows of a map.
HeightMap last_rows(const HeightMapFile& file, int count) {
    HeightBandReader reader(file);
    reader.skip(whole_height(file) - count);
    return reader.read(count);
}

}  // namespace

HeightBandReader::HeightBandReader(const HeightMapFile& file) : file_(file), reader_(file.path()) {}

HeightMap HeightBandReader::read(int rows) {
    const ImageInfo& info = reader_.info();
    const int first = reader_.next_row();
    const int count = std::min(rows, info.height - first);
    Image band = make_image(info.width, count, info.channels, info.bits, ColorSpace::data);
    std::visit([&](auto& samples) { reader_.read(std::as_writable_bytes(std::span(samples))); },
               band.samples);
    HeightMap map = height_map(std::move(band), file_.choice().channel);
    if (file_.choice().ignore_alpha) map.transparent.clear();
    const auto hole = std::find(map.transparent.begin(), map.transparent.end(), 1);
    if (hole != map.transparent.end()) {
        const auto texel = hole - map.transparent.begin();
        throw FileError(
            file_.path(),
            fmt::format("the texel ({}, {}) is transparent, which is understood only in "
                        "maps that fit into {} MiB",
                        texel % info.width, first + texel / info.width,
                        file_.choice().most_memory >> 20));
    }
    return map;
}

void KeptRows::append(const Image& rows) {
    bits_ = rows.bits();
    row_bytes_ = static_cast<std::size_t>(rows.width) * static_cast<std::size_t>(bits_ / 8);
    std::visit(
        [&](const auto& samples) {
            const auto bytes = std::as_bytes(std::span(samples));
            bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
        },
        rows.samples);
}

void KeptRows::drop(int count) {
    bytes_.erase(
        bytes_.begin(),
        bytes_.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(count) * row_bytes_));
}

int KeptRows::count() const {
    return static_cast<int>(bytes_.size() / row_bytes_);
}

const void* KeptRows::at(int index) const {
    return bytes_.data() + static_cast<std::size_t>(index) * row_bytes_;
}

HeightWindow::HeightWindow(const HeightMapFile& file, int radius, const Wraps& wrap)
    : reader_(file), height_(whole_height(file)), radius_(radius) {
    if (wrap.y != Wrap::repeat) return;
    const int count = std::min(radius, height_);
    tail_.append(last_rows(file, count).heights);
    head_.append(HeightBandReader(file).read(count).heights);
}

int HeightWindow::needed_end(int last) const {
    return std::min(last + radius_, height_);
}

void HeightWindow::append(const HeightMap& rows) {
    heights_.append(rows.heights);
    if (!rows.alpha.empty()) alpha_.append(rows.alpha);
}

void HeightWindow::read_ahead(int last) {
    const int end = begin_ + heights_.count();
    ahead_ = end < needed_end(last) ? reader_.read(needed_end(last) - end) : HeightMap{};
}

void HeightWindow::move_to(int first, int last) {
    const int gone = std::max(first - radius_ - begin_, 0);
    heights_.drop(gone);
    if (has_alpha()) alpha_.drop(gone);
    begin_ += gone;
    if (!ahead_.heights.empty()) append(ahead_);
    ahead_ = {};
    read_ahead(last);
    if (!ahead_.heights.empty()) append(ahead_);
    ahead_ = {};
}

const void* HeightWindow::row(int place) const {
    if (place >= begin_ && place < begin_ + heights_.count()) return heights_.at(place - begin_);
    if (place < head_.count()) return head_.at(place);
    return tail_.at(place - (height_ - tail_.count()));
}

}  // namespace relief
