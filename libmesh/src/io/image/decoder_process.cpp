// SPDX-License-Identifier: Apache-2.0
// Starts decoder processes, keeps idle ones, and exchanges messages with them.
//
// The program is started with posix_spawn(), which is safe with threads. Each process decodes one
// image at a time, so requests need no numbers.
#include "io/image/decoder_process.h"

#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <mutex>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "io/image/image_module_client.h"
#include "relief/mesh/report.h"

#if defined __SANITIZE_ADDRESS__ || defined __SANITIZE_THREAD__
#define RELIEF_SANITIZED 1
#elif defined __has_feature
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define RELIEF_SANITIZED 1
#endif
#endif

extern char** environ;  // NOLINT: POSIX declares it in no header.

namespace relief {
namespace {

constexpr std::uint64_t mebibyte = std::uint64_t{1} << 20;

// The limits of a request. Valid files need less than a tenth of them: readers hold the encoded
// file and the decoded image at most a few times, and decode more than 16 MiB per second.
constexpr std::uint64_t basic_memory = 512 * mebibyte;
constexpr std::uint64_t memory_per_encoded_byte = 16;
constexpr std::uint64_t memory_per_decoded_byte = 4;
constexpr std::uint64_t basic_seconds = 5;
constexpr std::uint64_t bytes_per_second = 16 * mebibyte;

#ifdef RELIEF_SANITIZED
constexpr std::uint64_t slower = 20;
#else
constexpr std::uint64_t slower = 1;
#endif

/// A process that computes is ended by its limit of processor time. The limit of waiting time is
/// longer, because other programs may occupy the processors.
constexpr std::uint64_t waiting_per_processor_second = 10;

/// The reason that a request has no reply.
struct DecoderLost {
    std::string reason;
};

}  // namespace

/// A running decoder.
class DecoderProcess {
  public:
    /// Returns an idle process, or starts one.
    static std::unique_ptr<DecoderProcess> take(const std::filesystem::path& file);

    /// Ends the process.
    ~DecoderProcess() { end(); }
    DecoderProcess(const DecoderProcess&) = delete;
    DecoderProcess& operator=(const DecoderProcess&) = delete;

    /// Makes the process available for the next image.
    static void give_back(std::unique_ptr<DecoderProcess> process);

    /// Sends a request with an optional descriptor. \throws DecoderLost
    void send(const DecoderRequest& request, int descriptor);

    /// Receives bytes within a number of seconds without any. \throws DecoderLost
    void receive(void* bytes, std::size_t size, std::uint64_t seconds);

  private:
    DecoderProcess(pid_t id, int socket) : id_(id), socket_(socket), owner_(::getpid()) {}

    static std::unique_ptr<DecoderProcess> start(const std::filesystem::path& program,
                                                 const std::filesystem::path& file);
    /// Returns false if the process has ended, or belongs to the process that forked this one.
    [[nodiscard]] bool is_usable() const;
    [[noreturn]] void lose(bool too_late);
    int end();

    pid_t id_;
    int socket_;
    pid_t owner_;
};

namespace {

/// The processes that wait for images. They are not destroyed at the end of the program: decoders
/// end when their sockets are closed.
struct IdleProcesses {
    std::mutex mutex;
    std::vector<std::unique_ptr<DecoderProcess>> all;
};

IdleProcesses& idle_processes() {
    static auto* const processes = new IdleProcesses;
    return *processes;
}

/// Finds the program. \throws FileError
std::filesystem::path find_decoder(const std::filesystem::path& file) {
    std::string places;
    for (const std::filesystem::path& folder : image_module_folders()) {
        std::filesystem::path program = folder / decoder_name;
        if (::access(program.c_str(), X_OK) == 0) return program;
        places += fmt::format("; not at {}", program.string());
    }
    throw FileError(file, fmt::format("relief's image decoder {} was not found{}; set "
                                      "RELIEF_MODULE_DIR to its folder",
                                      decoder_name, places));
}

std::string describe_end(int status) {
    if (!WIFSIGNALED(status)) return "its decoder ended without an answer";
    const int signal = WTERMSIG(status);
    if (signal == SIGXCPU) return "decoding it takes too long";
    return fmt::format("its decoder crashed ({}); the file is damaged", ::strsignal(signal));
}

}  // namespace

std::unique_ptr<DecoderProcess> DecoderProcess::take(const std::filesystem::path& file) {
    IdleProcesses& idle = idle_processes();
    for (;;) {
        std::unique_ptr<DecoderProcess> process;
        {
            const std::lock_guard lock(idle.mutex);
            if (idle.all.empty()) break;
            process = std::move(idle.all.back());
            idle.all.pop_back();
        }
        if (process->is_usable()) return process;
    }
    return start(find_decoder(file), file);
}

void DecoderProcess::give_back(std::unique_ptr<DecoderProcess> process) {
    IdleProcesses& idle = idle_processes();
    const std::lock_guard lock(idle.mutex);
    idle.all.push_back(std::move(process));
}

std::unique_ptr<DecoderProcess> DecoderProcess::start(const std::filesystem::path& program,
                                                      const std::filesystem::path& file) {
    const auto fail = [&](const std::string& reason) {
        throw FileError(file, fmt::format("relief's image decoder {} cannot be started: {}",
                                          program.string(), reason));
    };
    int ends[2] = {-1, -1};
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) fail(std::strerror(errno));
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_adddup2(&actions, ends[1], STDIN_FILENO);
    // Keys and hang-ups at the terminal are for this program, which ends the decoder.
    posix_spawnattr_t attributes;
    ::posix_spawnattr_init(&attributes);
    sigset_t none;
    ::sigemptyset(&none);
    ::posix_spawnattr_setsigmask(&attributes, &none);
    ::posix_spawnattr_setpgroup(&attributes, 0);
    ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETPGROUP);
    std::string name = decoder_name;
    char* const arguments[] = {name.data(), nullptr};
    pid_t id = 0;
    const int error =
        ::posix_spawn(&id, program.c_str(), &actions, &attributes, arguments, environ);
    ::posix_spawn_file_actions_destroy(&actions);
    ::posix_spawnattr_destroy(&attributes);
    ::close(ends[1]);
    if (error != 0) {
        ::close(ends[0]);
        fail(std::strerror(error));
    }
    std::unique_ptr<DecoderProcess> process(new DecoderProcess(id, ends[0]));
    try {
        constexpr std::uint64_t loading_seconds = 120;
        DecoderReply ready;
        process->receive(&ready, sizeof ready, loading_seconds);
        if (ready.version != image_module_version) fail("it belongs to another version of relief");
        if (ready.succeeded == 0) {
            std::string reason(std::min<std::uint64_t>(ready.size, 4096), ' ');
            process->receive(reason.data(), reason.size(), loading_seconds);
            fail(reason);
        }
    } catch (const DecoderLost&) {
        fail("it ended at once");
    }
    return process;
}

bool DecoderProcess::is_usable() const {
    pollfd state{socket_, POLLIN, 0};
    return owner_ == ::getpid() && ::poll(&state, 1, 0) == 0;
}

int DecoderProcess::end() {
    int status = 0;
    if (socket_ < 0) return status;
    ::close(socket_);
    socket_ = -1;
    if (owner_ != ::getpid()) return status;
    ::kill(id_, SIGKILL);
    while (::waitpid(id_, &status, 0) < 0 && errno == EINTR) {
    }
    return status;
}

void DecoderProcess::lose(bool too_late) {
    // The kernel closes the socket of a process that ends before its status is known.
    for (int attempt = 0; attempt < 100 && !too_late; ++attempt) {
        siginfo_t info{};
        const int error =
            ::waitid(P_PID, static_cast<id_t>(id_), &info, WEXITED | WNOWAIT | WNOHANG);
        if (error != 0 || info.si_pid != 0) break;
        ::poll(nullptr, 0, 10);
    }
    const int status = end();
    throw DecoderLost{too_late ? "decoding it takes too long" : describe_end(status)};
}

void DecoderProcess::send(const DecoderRequest& request, int descriptor) {
    iovec piece{const_cast<DecoderRequest*>(&request), sizeof request};
    alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int))] = {};
    msghdr message{};
    message.msg_iov = &piece;
    message.msg_iovlen = 1;
    if (descriptor >= 0) {
        message.msg_control = control;
        message.msg_controllen = sizeof control;
        cmsghdr* const header = CMSG_FIRSTHDR(&message);
        header->cmsg_level = SOL_SOCKET;
        header->cmsg_type = SCM_RIGHTS;
        header->cmsg_len = CMSG_LEN(sizeof(int));
        std::memcpy(CMSG_DATA(header), &descriptor, sizeof descriptor);
    }
    // The message is smaller than the buffer of the socket, which is empty between requests.
    ssize_t sent = 0;
    while ((sent = ::sendmsg(socket_, &message, MSG_NOSIGNAL)) < 0 && errno == EINTR) {
    }
    if (sent != static_cast<ssize_t>(sizeof request)) lose(false);
}

void DecoderProcess::receive(void* bytes, std::size_t size, std::uint64_t seconds) {
    char* at = static_cast<char*>(bytes);
    std::uint64_t waited = 0;
    while (size > 0) {
        // Time is counted in slices, so that a program that was stopped does not give up.
        pollfd state{socket_, POLLIN, 0};
        const int ready = ::poll(&state, 1, 1000);
        if (ready == 0 && ++waited >= seconds) lose(true);
        if (ready <= 0) continue;
        const ssize_t got = ::recv(socket_, at, size, 0);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) lose(false);
        at += got;
        size -= static_cast<std::size_t>(got);
    }
}

namespace {

/// Sends a request with its limits, and receives the reply with its bytes in `samples`, or in
/// `text` if that is absent. If the request failed, `text` is the decoder's reason. \throws
/// DecoderLost
DecoderReply exchange(DecoderProcess& process, DecoderRequest request, int descriptor,
                      std::uint64_t decoded_size, std::optional<std::span<std::byte>> samples,
                      std::string& text) {
    request.memory = basic_memory + memory_per_encoded_byte * request.size +
                     memory_per_decoded_byte * decoded_size;
    request.seconds = slower * (basic_seconds + (request.size + decoded_size) / bytes_per_second);
    const std::uint64_t waiting = waiting_per_processor_second * request.seconds;
    process.send(request, descriptor);
    DecoderReply reply;
    process.receive(&reply, sizeof reply, waiting);
    constexpr std::uint64_t max_text = 16 * mebibyte;
    const bool has_samples = reply.succeeded != 0 && samples;
    if (has_samples ? reply.size != samples->size() : reply.size > max_text)
        throw DecoderLost{"its decoder sent a wrong answer; the file is damaged"};
    if (has_samples) {
        process.receive(samples->data(), samples->size(), waiting);
        return reply;
    }
    text.resize(reply.size);
    process.receive(text.data(), text.size(), waiting);
    if (reply.succeeded == 0) text.resize(std::min(text.size(), text.find('\n')));
    return reply;
}

/// A file in memory.
class MemoryFile {
  public:
    explicit MemoryFile(std::span<const std::byte> bytes, const std::filesystem::path& name)
        : descriptor_(::memfd_create("image", MFD_CLOEXEC)) {
        while (descriptor_ >= 0 && !bytes.empty()) {
            const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
            if (written < 0 && errno == EINTR) continue;
            if (written <= 0) break;
            bytes = bytes.subspan(static_cast<std::size_t>(written));
        }
        if (descriptor_ >= 0 && bytes.empty()) return;
        const std::string reason = std::strerror(errno);
        if (descriptor_ >= 0) ::close(descriptor_);
        throw FileError(name, "cannot be passed to its decoder: " + reason);
    }
    ~MemoryFile() { ::close(descriptor_); }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;
    [[nodiscard]] int descriptor() const { return descriptor_; }

  private:
    int descriptor_;
};

}  // namespace

DecodedImage::DecodedImage(const char* format, std::span<const std::byte> bytes,
                           std::filesystem::path name)
    : name_(std::move(name)) {
    const MemoryFile copy(bytes, name_);
    open(format, copy.descriptor(), true, bytes.size());
}

DecodedImage::DecodedImage(const char* format, int descriptor, std::uint64_t size,
                           std::filesystem::path name)
    : name_(std::move(name)) {
    open(format, descriptor, false, size);
}

void DecodedImage::open(const char* format, int descriptor, bool in_memory, std::uint64_t size) {
    encoded_size_ = size;
    DecoderRequest request;
    request.action = DecoderAction::open;
    request.in_memory = in_memory ? 1 : 0;
    request.size = size;
    std::strncpy(request.format, format, sizeof request.format - 1);
    process_ = DecoderProcess::take(name_);
    std::string text;
    try {
        const DecoderReply reply = exchange(*process_, request, descriptor, 0, std::nullopt, text);
        if (reply.succeeded == 0) {
            DecoderProcess::give_back(std::move(process_));
            throw FileError(name_, text);
        }
        header_ = reply.header;
        row_grain_ = reply.row_grain;
    } catch (const DecoderLost& lost) {
        process_.reset();
        throw FileError(name_, lost.reason);
    }
    const bool known_bits = header_.bits == 8 || header_.bits == 16 || header_.bits == 32;
    if (!known_bits || row_grain_ < 1) {
        process_.reset();
        throw FileError(name_, "its decoder sent a wrong answer; the file is damaged");
    }
    std::string_view rest = text;
    const auto next = [&] {
        const std::string_view string = rest.substr(0, rest.find('\0'));
        rest.remove_prefix(std::min(rest.size(), string.size() + 1));
        return string;
    };
    while (!rest.empty()) {
        const std::string_view key = next();
        text_.emplace(key, next());
    }
}

void DecodedImage::read(std::size_t first, std::size_t end, std::span<std::byte> samples) {
    const auto row = static_cast<std::uint64_t>(header_.width) *
                     static_cast<std::uint64_t>(header_.channels * (header_.bits / 8));
    DecoderRequest request;
    request.action = DecoderAction::read;
    request.size = encoded_size_;
    request.first = static_cast<std::int64_t>(first);
    request.end = static_cast<std::int64_t>(end);
    std::string text;
    if (!process_) throw FileError(name_, "cannot be read any further");
    try {
        const DecoderReply reply =
            exchange(*process_, request, -1, row * static_cast<std::uint64_t>(header_.height),
                     samples, text);
        if (reply.succeeded == 0) {
            throw FileError(name_, fmt::format("rows {} to {} of {} are damaged: {}", first,
                                               end - 1, header_.height, text));
        }
    } catch (const DecoderLost& lost) {
        process_.reset();
        throw FileError(name_, lost.reason);
    }
}

DecodedImage::~DecodedImage() {
    if (!process_) return;
    try {
        // A process whose reader fails here must not receive the next image.
        DecoderRequest request;
        request.action = DecoderAction::close;
        request.size = encoded_size_;
        std::string text;
        exchange(*process_, request, -1, 0, std::nullopt, text);
        DecoderProcess::give_back(std::move(process_));
    } catch (const DecoderLost&) {
        process_.reset();
    } catch (const std::bad_alloc&) {
        process_.reset();
    }
}

}  // namespace relief
