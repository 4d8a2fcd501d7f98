// SPDX-License-Identifier: Apache-2.0
#include "picture_sink.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <memory>

#include "common/text.h"
#include "file_replacement.h"
#include "relief/mesh/image.h"
#include "relief/mesh/image_file.h"
#include "view_options.h"

namespace relief::tools {

bool is_video(const std::filesystem::path& output) {
    return extension_of(output) == ".mp4" || extension_of(output) == ".webm";
}

bool is_animation(const std::filesystem::path& output) {
    return is_video(output) || extension_of(output) == ".apng";
}

namespace {

constexpr std::size_t default_digits = 4;

}  // namespace

std::filesystem::path numbered_file(const std::filesystem::path& output, int index) {
    std::string name = output.filename().string();
    const std::size_t first = name.find('#');
    if (first == std::string::npos) {
        return output.parent_path() / fmt::format("{}-{:0{}}{}", output.stem().string(), index,
                                                  default_digits, output.extension().string());
    }
    const std::size_t end = std::min(name.find_first_not_of('#', first), name.size());
    name.replace(first, end - first, fmt::format("{:0{}}", index, end - first));
    return output.parent_path() / name;
}

namespace {

constexpr double default_frames_per_second = 25.0;

class OneFile : public PictureSink {
  public:
    explicit OneFile(std::filesystem::path file) : file_(std::move(file)) {}
    void take(const Image& picture) override { write_image(file_, picture); }

  private:
    std::filesystem::path file_;
};

class NumberedFiles : public PictureSink {
  public:
    explicit NumberedFiles(std::filesystem::path output) : output_(std::move(output)) {}
    void take(const Image& picture) override {
        write_image(numbered_file(output_, ++index_), picture);
    }

  private:
    std::filesystem::path output_;
    int index_ = 0;
};

class AnimationSink : public PictureSink {
  public:
    AnimationSink(const std::filesystem::path& file, int frames, double seconds)
        : animation_(file, static_cast<std::uint32_t>(frames), seconds) {}
    void take(const Image& picture) override { animation_.add(picture); }
    void finish() override { animation_.finish(); }

  private:
    AnimatedPng animation_;
};

/// Multiplies the color by alpha, because a video has no transparent pixels.
void append_opaque(std::vector<std::byte>& rgb, const std::uint8_t* texel, int channels) {
    constexpr std::uint8_t opaque = 255;
    const std::uint8_t alpha = channels == 4 ? texel[3] : opaque;
    for (int i = 0; i < 3; ++i) {
        const std::uint8_t code = texel[i];
        if (alpha == opaque) {
            rgb.push_back(static_cast<std::byte>(code));
            continue;
        }
        const float linear = linear_from_srgb(static_cast<float>(code) / 255.0F);
        const float coded = srgb_from_linear(linear * static_cast<float>(alpha) / 255.0F);
        rgb.push_back(static_cast<std::byte>(std::lround(coded * 255.0F)));
    }
}

/// Sends the pictures to the program ffmpeg, which compresses them: H.264 for .mp4, VP9 for .webm.
/// The video replaces an existing file when it is complete.
class VideoSink : public PictureSink {
  public:
    VideoSink(const std::filesystem::path& file, double frames_per_second)
        : file_(file), rate_(frames_per_second) {}
    VideoSink(const VideoSink&) = delete;
    VideoSink& operator=(const VideoSink&) = delete;
    ~VideoSink() override {
        if (process_ <= 0) return;
        ::close(socket_);
        ::kill(process_, SIGKILL);
        ::waitpid(process_, nullptr, 0);
    }

    void take(const Image& picture) override {
        if (process_ <= 0) start(picture.width, picture.height);
        rgb_.clear();
        const std::span<const std::uint8_t> samples = picture.as<std::uint8_t>();
        const auto channels = static_cast<std::size_t>(picture.channels);
        for (std::size_t i = 0; i + channels <= samples.size(); i += channels)
            append_opaque(rgb_, &samples[i], picture.channels);
        std::size_t sent = 0;
        while (sent < rgb_.size()) {
            const ssize_t count =
                ::send(socket_, rgb_.data() + sent, rgb_.size() - sent, MSG_NOSIGNAL);
            if (count < 0 && errno == EINTR) continue;
            if (count <= 0) fail("ffmpeg ended early");
            sent += static_cast<std::size_t>(count);
        }
    }

    void finish() override {
        ::shutdown(socket_, SHUT_WR);
        int status = 0;
        while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
        }
        ::close(socket_);
        process_ = 0;
        if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) fail("ffmpeg failed");
        file_.commit();
    }

  private:
    [[noreturn]] void fail(const std::string& problem) const {
        throw FileError(file_.file(), problem);
    }

    void start(int width, int height) {
        std::vector<std::string> words = {
            "ffmpeg", "-loglevel", "error", "-y",
            // The input: raw pictures from the socket.
            "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", fmt::format("{}x{}", width, height), "-r",
            fmt::format("{}", rate_), "-i", "pipe:0",
            // The colors of HD video.
            "-vf", "scale=out_color_matrix=bt709:out_range=tv", "-pix_fmt", "yuv420p",
            "-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709"};
        const std::vector<std::string> mp4 = {"-c:v", "libx264", "-crf",      "16",
                                              "-f",   "mp4",     "-movflags", "+faststart"};
        const std::vector<std::string> webm = {"-c:v", "libvpx-vp9", "-crf", "20", "-b:v",
                                               "0",    "-row-mt",    "1",    "-f", "webm"};
        const std::vector<std::string>& format = extension_of(file_.file()) == ".mp4" ? mp4 : webm;
        words.insert(words.end(), format.begin(), format.end());
        words.push_back("file:" + file_.temporary().string());
        std::vector<char*> arguments;
        for (std::string& word : words)
            arguments.push_back(word.data());
        arguments.push_back(nullptr);

        std::array<int, 2> ends{};
        if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
            fail("cannot start ffmpeg");
        posix_spawn_file_actions_t actions;
        ::posix_spawn_file_actions_init(&actions);
        ::posix_spawn_file_actions_adddup2(&actions, ends[1], STDIN_FILENO);
        const int error =
            ::posix_spawnp(&process_, "ffmpeg", &actions, nullptr, arguments.data(), environ);
        ::posix_spawn_file_actions_destroy(&actions);
        ::close(ends[1]);
        socket_ = ends[0];
        if (error == 0) return;
        ::close(socket_);
        process_ = 0;
        fail("needs the program ffmpeg, which is not installed");
    }

    relief::detail::FileReplacement file_;
    double rate_;
    pid_t process_ = 0;
    int socket_ = -1;
    std::vector<std::byte> rgb_;
};

}  // namespace

std::unique_ptr<PictureSink> make_sink(const ViewOptions& options) {
    const std::filesystem::path& output = *options.output;
    const int count = picture_count(options);
    const double rate = options.frames_per_second.value_or(default_frames_per_second);
    if (is_video(output)) return std::make_unique<VideoSink>(output, rate);
    if (extension_of(output) == ".apng") {
        return std::make_unique<AnimationSink>(output, count, 1.0 / rate);
    }
    if (options.turntable || options.frames) return std::make_unique<NumberedFiles>(output);
    return std::make_unique<OneFile>(output);
}

}  // namespace relief::tools
