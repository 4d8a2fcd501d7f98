// SPDX-License-Identifier: Apache-2.0
// TIFF, EXR, HDR and JPEG files by rows, through the image module. Rows go to it in bands of a
// fixed height, because what it makes of them may depend on how many come at once. Half floats are
// rounded by the module, to nearest; what would become infinite is changed here, and counted.
// Tests: tests/mesh/io/image/image_rows_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <string_view>
#include <vector>

#include "io/image/image_file_module.h"
#include "io/image/row_sink.h"
#include "relief/mesh/error.h"

namespace relief {
namespace {

using Metadata = std::map<std::string, std::string>;

/// Bands are of whole strips of TIFF and blocks of EXR, whichever heights the module gives them.
constexpr std::size_t band_grain = 64;

constexpr float largest_half = 65504.0F;
/// Halfway to the number that would follow, were there one: rounds to infinity.
constexpr float rounds_to_infinity = 65520.0F;

std::string folded_description(const Metadata& metadata) {
    std::string description;
    for (const auto& [key, value] : metadata)
        description += fmt::format("{}={}\n", key, value);
    return description;
}

/// The metadata in the form that the format can hold.
Metadata entries_for(std::string_view format, const Metadata& metadata) {
    if (format == "openexr") return metadata;
    if (format == "tiff" && !metadata.empty())
        return {{"ImageDescription", folded_description(metadata)}};
    return {};
}

int zip_quality(WriteEffort effort) {
    // 1 is twice as fast as zlib's default, and within 1 % of its size on 16-bit normal maps.
    return effort == WriteEffort::small ? 9 : 1;
}

struct ReleaseWriter {
    const ImageModule* module = nullptr;
    void operator()(ImageModuleWriter* writer) const { module->release(writer); }
};

class ModuleSink final : public RowSink {
  public:
    explicit ModuleSink(const RowSinkPlan& plan)
        : plan_(plan),
          row_bytes_(plan.row_bytes()),
          band_rows_(std::max<std::size_t>(module_bytes_per_band / row_bytes_ / band_grain, 1) *
                     band_grain) {
        const Metadata entries = entries_for(plan.format, plan.metadata);
        std::vector<const char*> keys, values;
        for (const auto& [key, value] : entries) {
            keys.push_back(key.c_str());
            values.push_back(value.c_str());
        }
        const ImageShape& shape = plan.shape;
        std::vector<const char*> names;
        for (const std::string& name : shape.channel_names)
            names.push_back(name.c_str());
        const ImageModulePicture picture{{shape.width, shape.height, shape.channels, shape.bits},
                                         shape.color_space == ColorSpace::srgb,
                                         plan.options.half,
                                         zip_quality(plan.options.effort),
                                         names.empty() ? nullptr : names.data(),
                                         keys.data(),
                                         values.data(),
                                         entries.size()};
        const ImageModule& module = image_module(plan.file);
        std::string reason;
        writer_ = {module.create(plan.format, plan.written.c_str(), &picture, failure_into(reason)),
                   ReleaseWriter{&module}};
        if (!writer_) fail(reason);
    }

    void write(const std::byte* rows, int count) override {
        auto left = static_cast<std::size_t>(count);
        while (left > 0) {
            const std::size_t taken = std::min(left, band_rows_ - pending_.size() / row_bytes_);
            const std::size_t size = taken * row_bytes_;
            if (taken == band_rows_ && !plan_.options.half) {
                pass_on(rows, band_rows_);
            } else {
                pending_.insert(pending_.end(), rows, rows + size);
                if (pending_.size() == band_rows_ * row_bytes_) pass_on_pending();
            }
            rows += size;
            left -= taken;
        }
    }

    void finish() override {
        if (!pending_.empty()) pass_on_pending();
        std::string reason;
        if (!writer_.get_deleter().module->finish(writer_.get(), failure_into(reason)))
            fail(reason);
    }

    void report(Report& report) const override {
        if (beyond_half_.count > 0) report.add(beyond_half_);
    }

  private:
    [[noreturn]] void fail(const std::string& reason) const {
        throw FileError(plan_.file, "cannot be written: " + reason);
    }

    void pass_on_pending() {
        if (plan_.options.half) bring_into_half_range();
        pass_on(pending_.data(), pending_.size() / row_bytes_);
        pending_.clear();
    }

    void pass_on(const std::byte* rows, std::size_t count) {
        std::string reason;
        const auto first = static_cast<std::int64_t>(next_);
        const auto end = first + static_cast<std::int64_t>(count);
        if (!writer_.get_deleter().module->write(writer_.get(), first, end, rows,
                                                 failure_into(reason)))
            fail(reason);
        next_ += count;
    }

    void bring_into_half_range() {
        constexpr std::size_t most_named = 8;
        for (std::size_t at = 0; at < pending_.size(); at += sizeof(float)) {
            float value = 0.0F;
            std::memcpy(&value, &pending_[at], sizeof value);
            if (!(std::abs(value) >= rounds_to_infinity) || std::isinf(value)) continue;
            value = std::copysign(largest_half, value);
            std::memcpy(&pending_[at], &value, sizeof value);
            const auto texel = (next_ * row_bytes_ + at) / sizeof(float) /
                               static_cast<std::size_t>(plan_.shape.channels);
            if (beyond_half_.count > 0 && texel == last_beyond_half_) continue;
            ++beyond_half_.count;
            last_beyond_half_ = texel;
            if (beyond_half_.first.size() < most_named) beyond_half_.first.push_back(texel);
        }
    }

    RowSinkPlan plan_;
    std::size_t row_bytes_;
    std::size_t band_rows_;
    std::unique_ptr<ImageModuleWriter, ReleaseWriter> writer_;
    std::vector<std::byte> pending_;  ///< Rows of a band that is not full.
    std::size_t next_ = 0;            ///< The row that is passed on next.
    std::size_t last_beyond_half_ = 0;
    Finding beyond_half_{
        "texel beyond half's range", "texel", "is written as 65504 with its sign", 0, {}};
};

}  // namespace

std::unique_ptr<RowSink> make_module_sink(const RowSinkPlan& plan) {
    return std::make_unique<ModuleSink>(plan);
}

}  // namespace relief
