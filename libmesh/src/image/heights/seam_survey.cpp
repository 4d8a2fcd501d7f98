// SPDX-License-Identifier: Apache-2.0
// Differences between the two lines of at most 256 pairs inside, evenly spread, and of the seam.
// Tests: tests/mesh/image/heights/height_statistics_test.cpp.
#include "image/heights/seam_survey.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "image/largest_sample.h"

namespace relief {
namespace {

/// The first lines of the pairs among `count` lines, and at the end the last line, whose neighbour
/// across the seam is the first.
template <typename Index>
std::vector<Index> pairs_of(int count) {
    constexpr int most_pairs = 256;
    const int pairs = std::min(count - 1, most_pairs);
    std::vector<Index> first;
    for (int i = 0; i < pairs; ++i)
        first.push_back(static_cast<Index>(static_cast<std::int64_t>(i) * (count - 1) / pairs));
    first.push_back(static_cast<Index>(count - 1));
    return first;
}

}  // namespace

void SeamSurvey::Mean::add(double difference) {
    if (!std::isfinite(difference)) return;
    squares += difference * difference;
    ++count;
}

double SeamSurvey::Mean::root() const {
    return count == 0 ? 0.0 : std::sqrt(squares / static_cast<double>(count));
}

SeamSurvey::SeamSurvey(int width, int height)
    : height_(height),
      columns_(pairs_of<std::size_t>(width)),
      row_pairs_(pairs_of<int>(height)),
      across_columns_(columns_.size()) {}

SeamSurvey::Mean SeamSurvey::change_to(std::span<const double> next) const {
    Mean mean;
    for (std::size_t x = 0; x < next.size(); ++x)
        mean.add(next[x] - previous_[x]);
    return mean;
}

template <typename Sample>
void SeamSurvey::add_row(std::span<const Sample> row) {
    constexpr double largest = largest_sample<Sample>;
    const auto at = [&](std::size_t x) { return static_cast<double>(row[x]) / largest; };
    for (std::size_t i = 0; i < columns_.size(); ++i)
        across_columns_[i].add(at((columns_[i] + 1) % row.size()) - at(columns_[i]));

    // Rows are wanted only where a pair begins or ends, and the first for the seam.
    const std::size_t pair = across_rows_.size();
    const bool ends_pair = pair + 1 < row_pairs_.size() && row_pairs_[pair] == rows_ - 1;
    const std::size_t next = pair + (ends_pair ? 1 : 0);
    const bool begins_pair = row_pairs_[next] == rows_;
    if (ends_pair || begins_pair || rows_ == 0) {
        std::vector<double> heights(row.size());
        for (std::size_t x = 0; x < row.size(); ++x)
            heights[x] = at(x);
        if (ends_pair) across_rows_.push_back(change_to(heights));
        if (rows_ == 0) first_ = heights;
        previous_ = std::move(heights);
    }
    if (++rows_ == height_) across_rows_.push_back(change_to(first_));
}

template void SeamSurvey::add_row(std::span<const std::uint8_t>);
template void SeamSurvey::add_row(std::span<const std::uint16_t>);
template void SeamSurvey::add_row(std::span<const float>);

double SeamSurvey::seam_of(const std::vector<Mean>& lines) {
    const double seam = lines.back().root();
    if (seam == 0.0) return 0.0;
    double inside = 0.0;
    for (std::size_t i = 0; i + 1 < lines.size(); ++i)
        inside = std::max(inside, lines[i].root());
    return inside > 0.0 ? seam / inside : std::numeric_limits<double>::infinity();
}

Tiling SeamSurvey::tiling() const {
    return {seam_of(across_columns_), seam_of(across_rows_)};
}

}  // namespace relief
