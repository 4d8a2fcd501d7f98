// SPDX-License-Identifier: Apache-2.0
// Animated PNG: every frame is encoded as a PNG of its own, and its chunks are put in a row with
// those that say when each is shown. Bad frames throw InvalidInput, bad files FileError.
// Source: [PNG 3], section 11.3.6. Tests: tests/mesh/io/png/animated_png_test.cpp.
#include "relief/mesh/animated_png.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>

#include "file_replacement.h"
#include "io/png/png_chunk.h"
#include "io/png/png_encoder.h"
#include "relief/mesh/error.h"

namespace relief {

namespace {

constexpr std::size_t signature_size = 8;

std::uint32_t read_u32(std::string_view text) {
    std::uint32_t value = 0;
    for (const char c : text.substr(0, 4))
        value = value << 8U | static_cast<unsigned char>(c);
    return value;
}

/// Calls visit(name, content, whole chunk) for each chunk of a PNG file.
template <typename Visit>
void for_each_chunk(std::string_view png, Visit visit) {
    for (std::size_t at = signature_size; at < png.size();) {
        const std::size_t length = read_u32(png.substr(at));
        visit(png.substr(at + 4, 4), png.substr(at + 8, length), png.substr(at, length + 12));
        at += length + 12;
    }
}

}  // namespace

struct AnimatedPng::Implementation {
    FileReplacement replacement;
    std::filesystem::path file;
    std::ofstream out;
    std::uint32_t frames;
    std::uint32_t milliseconds;
    std::uint32_t added = 0;
    std::uint32_t sequence = 0;
    std::optional<Image> shape;  ///< The first frame without its samples.

    void write(std::string_view bytes) {
        out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        if (!out) throw FileError(file, "cannot be written");
    }

    /// When and where the next frame is shown.
    std::string frame_control(const Image& frame) {
        std::string content;
        append_big32(content, sequence++);
        append_big32(content, static_cast<std::uint32_t>(frame.width));
        append_big32(content, static_cast<std::uint32_t>(frame.height));
        append_big32(content, 0);
        append_big32(content, 0);
        append_big16(content, milliseconds);
        append_big16(content, 1000);
        append_big16(content, 0);  // Left as it is, and the next one takes its place.
        std::string control;
        append_chunk(control, "fcTL", content);
        return control;
    }

    /// The first frame: also what readers show that know nothing of animation.
    void write_first(const Image& frame, std::string_view png) {
        std::string counts;
        append_big32(counts, frames);
        append_big32(counts, 0);  // Without end.
        write(png.substr(0, signature_size));
        bool in_data = false;
        for_each_chunk(png, [&](std::string_view name, std::string_view, std::string_view whole) {
            if (name == "IEND") return;
            if (name == "IDAT" && !in_data) {
                std::string animation;
                append_chunk(animation, "acTL", counts);
                write(animation);
                write(frame_control(frame));
                in_data = true;
            }
            write(whole);
        });
    }

    void write_further(const Image& frame, std::string_view png) {
        write(frame_control(frame));
        for_each_chunk(png, [&](std::string_view name, std::string_view content, std::string_view) {
            if (name != "IDAT") return;
            std::string numbered;
            append_big32(numbered, sequence++);
            numbered += content;
            std::string data;
            append_chunk(data, "fdAT", numbered);
            write(data);
        });
    }
};

AnimatedPng::AnimatedPng(const std::filesystem::path& file, std::uint32_t frames, double seconds) {
    if (frames == 0) throw InvalidInput("an animation of 0 frames");
    if (!(seconds >= 0.0 && seconds <= 65.0)) {
        throw InvalidInput(
            fmt::format("a frame is shown for {} seconds, but 0 to 65 can be", seconds));
    }
    implementation_.reset(
        new Implementation{FileReplacement(file),
                           file,
                           {},
                           frames,
                           static_cast<std::uint32_t>(std::lround(1000.0 * seconds)),
                           0,
                           0,
                           {}});
    implementation_->out.open(implementation_->replacement.temporary(), std::ios::binary);
    if (!implementation_->out) throw FileError(file, "cannot be written");
}

AnimatedPng::~AnimatedPng() = default;

void AnimatedPng::add(const Image& frame) {
    Implementation& self = *implementation_;
    if (self.added == self.frames) {
        throw InvalidInput(fmt::format("one frame more than the {} that were said", self.frames));
    }
    if (self.shape &&
        (frame.width != self.shape->width || frame.height != self.shape->height ||
         frame.channels != self.shape->channels || frame.bits() != self.shape->bits() ||
         frame.color_space != self.shape->color_space)) {
        throw InvalidInput(fmt::format("frame {} is not of the first one's shape", self.added));
    }
    if (frame.bits() == 32) throw InvalidInput("PNG holds no float samples");
    const std::string png = encode_png(frame, {});
    if (self.added == 0) {
        self.shape = make_image(1, 1, frame.channels, frame.bits(), frame.color_space);
        self.shape->width = frame.width;
        self.shape->height = frame.height;
        self.write_first(frame, png);
    } else {
        self.write_further(frame, png);
    }
    ++self.added;
}

void AnimatedPng::finish() {
    Implementation& self = *implementation_;
    if (self.added < self.frames) {
        throw InvalidInput(
            fmt::format("{} frames of {} are missing", self.frames - self.added, self.frames));
    }
    std::string end;
    append_chunk(end, "IEND", "");
    self.write(end);
    self.out.close();
    if (!self.out) throw FileError(self.file, "cannot be written");
    self.replacement.commit();
}

}  // namespace relief
