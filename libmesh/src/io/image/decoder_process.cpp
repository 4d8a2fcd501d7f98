// SPDX-License-Identifier: Apache-2.0
// Starts decoder processes, keeps idle ones, limits them, and exchanges messages with them.
//
// The program is started with posix_spawn(), which is safe with threads. Each process decodes one
// image at a time, so requests need no numbers. A process that was taken over by a file cannot
// change its limits, because its filter of system calls forbids it. Its processor time is also
// measured from here.
#include "io/image/decoder_process.h"

#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
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

namespace relief::detail {

constinit std::atomic<int> max_decoder_milliseconds = 0;

namespace {

using std::chrono::nanoseconds;

constexpr std::uint64_t mebibyte = std::uint64_t{1} << 20;

// The limits of an image. Valid files need less than a tenth of them: readers hold the encoded
// file and the decoded image at most a few times, and decode more than 16 MiB per second.
constexpr std::uint64_t basic_memory = 512 * mebibyte;
constexpr std::uint64_t memory_per_encoded_byte = 16;
constexpr std::uint64_t memory_per_decoded_byte = 4;
constexpr std::chrono::seconds time_per_image{5};
constexpr std::uint64_t bytes_per_second = 16 * mebibyte;

#ifdef RELIEF_SANITIZED
constexpr bool is_sanitized = true;  // Sanitizers reserve terabytes of addresses.
constexpr int slower = 20;
#else
constexpr bool is_sanitized = false;
constexpr int slower = 1;
#endif

/// The limit of waiting time is longer than that of processor time, because other programs may
/// occupy the processors.
constexpr int waiting_per_computing = 10;

/// The most samples of an image for which decoders get time at once, in bytes.
constexpr std::uint64_t max_decoded_at_once = std::uint64_t{1} << 33;

/// The reason that a request has no reply.
struct DecoderLost {
    std::string reason;
};

[[noreturn]] void refuse_reply() {
    throw DecoderLost{"its decoder sent a wrong answer; the file is damaged"};
}

/// Sets the soft limit of another process, within its hard limit.
void set_limit(pid_t id, decltype(RLIMIT_AS) which, rlim_t wanted) {
    rlimit limit{};
    if (::prlimit(id, which, nullptr, &limit) != 0) return;  // The process has ended.
    limit.rlim_cur = std::min(wanted, limit.rlim_max);
    ::prlimit(id, which, &limit, nullptr);
}

/// Returns the folder of decoders that the environment names; empty if there is none.
std::string named_folder() {
    const char* const folder = std::getenv("RELIEF_MODULE_DIR");
    return folder == nullptr ? "" : folder;
}

/// Returns the bytes of addresses that a process uses; 0 if they are unknown.
std::uint64_t address_bytes(pid_t id) {
    std::ifstream file(fmt::format("/proc/{}/statm", id));
    std::uint64_t pages = 0;
    file >> pages;
    return pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

}  // namespace

void DecoderTime::add(std::uint64_t bytes, bool is_image) {
    using std::chrono::milliseconds;
    const auto for_bytes = milliseconds(1000 * (bytes / bytes_per_second));
    const nanoseconds added = slower * (for_bytes + (is_image ? time_per_image : nanoseconds(0)));
    computing += added;
    waiting += waiting_per_computing * added;
    if (const int most = max_decoder_milliseconds; most > 0) {
        computing = std::min<nanoseconds>(computing, milliseconds(most));
        waiting = std::min<nanoseconds>(waiting, milliseconds(most));
    }
}

/// A running decoder.
class DecoderProcess {
  public:
    /// Returns an idle process of the current RELIEF_MODULE_DIR, or starts one.
    static std::unique_ptr<DecoderProcess> take(const std::filesystem::path& file);

    /// Ends the process.
    ~DecoderProcess() { end(); }
    DecoderProcess(const DecoderProcess&) = delete;
    DecoderProcess& operator=(const DecoderProcess&) = delete;

    /// Makes the process available for the next image.
    static void give_back(std::unique_ptr<DecoderProcess> process);

    /// Sends a request with an optional descriptor, and receives the reply with its bytes in
    /// `samples`, or in `text` if that is absent. If the request failed, `text` is the decoder's
    /// reason. \param memory  that the decoder may use for it \throws DecoderLost
    DecoderReply exchange(const DecoderRequest& request, int descriptor, std::uint64_t memory,
                          DecoderTime& time, std::optional<std::span<std::byte>> samples,
                          std::string& text);

  private:
    DecoderProcess(pid_t id, int socket) : id_(id), socket_(socket), owner_(::getpid()) {
        has_clock_ = ::clock_getcpuclockid(id, &clock_) == 0;
    }

    static std::unique_ptr<DecoderProcess> start(const std::filesystem::path& program,
                                                 const std::filesystem::path& file);
    /// Returns false if the process has ended, or belongs to the process that forked this one.
    [[nodiscard]] bool is_usable() const;
    [[nodiscard]] nanoseconds computed() const;
    void refuse_early_reply();
    void set_limits(std::uint64_t memory, const DecoderTime& time);
    void send(const DecoderRequest& request, int descriptor);
    void receive(void* bytes, std::size_t size, DecoderTime& time);
    DecoderReply receive_reply(std::optional<std::span<std::byte>> samples, std::string& text,
                               DecoderTime& time);
    [[noreturn]] void lose(bool too_late);
    int end();

    pid_t id_;
    int socket_;
    pid_t owner_;
    std::string folder_ = named_folder();
    clockid_t clock_ = 0;  ///< Of the processor time of the process.
    bool has_clock_ = false;
    std::uint64_t idle_addresses_ = 0;  ///< Bytes of addresses before the first request.
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
    throw FileError(file, fmt::format("relief's image decoder {} was not found{}; install the "
                                      "package relief-image-formats, or set RELIEF_MODULE_DIR to "
                                      "its folder",
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
        if (process->is_usable() && process->folder_ == named_folder()) return process;
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
        constexpr std::chrono::seconds loading_time{120};
        DecoderTime time{loading_time, loading_time};
        DecoderReply ready;
        process->receive(&ready, sizeof ready, time);
        if (ready.version != image_module_version) fail("it belongs to another version of relief");
        if (ready.succeeded == 0) {
            std::string reason(std::min<std::uint64_t>(ready.size, 4096), ' ');
            process->receive(reason.data(), reason.size(), time);
            fail(reason);
        }
    } catch (const DecoderLost&) {
        fail("it ended at once");
    }
    // Not earlier: AddressSanitizer reads and sets the limit of core files while it starts.
    for (const auto which : {RLIMIT_CORE, RLIMIT_FSIZE}) {
        constexpr rlimit nothing{};
        ::prlimit(id, which, &nothing, nullptr);
    }
    process->idle_addresses_ = address_bytes(id);
    if (process->idle_addresses_ == 0) fail("its use of memory cannot be read in /proc");
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

nanoseconds DecoderProcess::computed() const {
    timespec now{};
    if (!has_clock_ || ::clock_gettime(clock_, &now) != 0) return nanoseconds(0);
    return std::chrono::seconds(now.tv_sec) + nanoseconds(now.tv_nsec);
}

void DecoderProcess::receive(void* bytes, std::size_t size, DecoderTime& time) {
    using Clock = std::chrono::steady_clock;
    constexpr std::chrono::milliseconds slice{1000};
    char* at = static_cast<char*>(bytes);
    const nanoseconds computing_end = computed() + time.computing;
    while (size > 0) {
        const Clock::time_point begin = Clock::now();
        pollfd state{socket_, POLLIN, 0};
        const auto longest = std::min<nanoseconds>(slice, time.waiting);
        const auto milliseconds = std::chrono::ceil<std::chrono::milliseconds>(longest).count();
        const int ready = ::poll(&state, 1, static_cast<int>(milliseconds));
        // Slices have a limit, so that a program that was stopped does not give up.
        time.waiting -= std::min<nanoseconds>(Clock::now() - begin, slice);
        if (time.waiting <= nanoseconds(0) || computed() > computing_end) lose(true);
        if (ready <= 0) continue;
        const ssize_t got = ::recv(socket_, at, size, 0);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) lose(false);
        at += got;
        size -= static_cast<std::size_t>(got);
    }
    time.computing = computing_end - computed();
}

/// Throws if the decoder has sent data before a request.
void DecoderProcess::refuse_early_reply() {
    char byte = 0;
    const ssize_t got = ::recv(socket_, &byte, 1, MSG_PEEK | MSG_DONTWAIT);
    if (got > 0) refuse_reply();
    if (got == 0 || (errno != EAGAIN && errno != EINTR)) lose(false);
}

/// Limits the memory for the next request, and the processor time until the end of the image. The
/// kernel ends the process also while this program is stopped.
void DecoderProcess::set_limits(std::uint64_t memory, const DecoderTime& time) {
    if (!is_sanitized) set_limit(id_, RLIMIT_AS, idle_addresses_ + memory);
    const auto end = std::chrono::ceil<std::chrono::seconds>(computed() + time.computing);
    set_limit(id_, RLIMIT_CPU, static_cast<rlim_t>(end.count()) + 1);
}

DecoderReply DecoderProcess::receive_reply(std::optional<std::span<std::byte>> samples,
                                           std::string& text, DecoderTime& time) {
    DecoderReply reply;
    receive(&reply, sizeof reply, time);
    if (reply.version != image_module_version || reply.succeeded > 1) refuse_reply();
    const bool has_samples = reply.succeeded == 1 && samples;
    constexpr std::uint64_t max_text = 16 * mebibyte;
    if (has_samples ? reply.size != samples->size() : reply.size > max_text) refuse_reply();
    if (has_samples) {
        receive(samples->data(), samples->size(), time);
        return reply;
    }
    text.resize(static_cast<std::size_t>(reply.size));
    receive(text.data(), text.size(), time);
    if (reply.succeeded == 0) text.resize(std::min(text.size(), text.find('\n')));
    return reply;
}

DecoderReply DecoderProcess::exchange(const DecoderRequest& request, int descriptor,
                                      std::uint64_t memory, DecoderTime& time,
                                      std::optional<std::span<std::byte>> samples,
                                      std::string& text) {
    refuse_early_reply();
    set_limits(memory, time);
    send(request, descriptor);
    return receive_reply(samples, text, time);
}

namespace {

std::uint64_t memory_for(std::uint64_t encoded_size, std::uint64_t decoded_size) {
    return basic_memory + memory_per_encoded_byte * encoded_size +
           memory_per_decoded_byte * decoded_size;
}

/// Checks the numbers of a reply in their full width. \throws DecoderLost
void check_numbers(const DecoderReply& reply) {
    constexpr std::int64_t max_int = std::numeric_limits<int>::max();
    const ImageModuleHeader& header = reply.header;
    for (const std::int64_t number : {header.width, header.height, header.channels}) {
        if (number < 0 || number > max_int) refuse_reply();
    }
    const bool has_known_bits = header.bits == 8 || header.bits == 16 || header.bits == 32;
    if (!has_known_bits || reply.row_grain < 1 || reply.row_grain > max_int) refuse_reply();
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
    time_.add(size, true);
    std::string text;
    try {
        const DecoderReply reply =
            process_->exchange(request, descriptor, memory_for(size, 0), time_, std::nullopt, text);
        if (reply.succeeded == 0) {
            DecoderProcess::give_back(std::move(process_));
            throw FileError(name_, text);
        }
        check_numbers(reply);
        header_ = reply.header;
        row_grain_ = reply.row_grain;
    } catch (const DecoderLost& lost) {
        process_.reset();
        throw FileError(name_, lost.reason);
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
    if (!process_) throw FileError(name_, "cannot be read any further");
    const std::uint64_t all = row * static_cast<std::uint64_t>(header_.height);
    if (!has_time_to_decode_) time_.add(encoded_size_ + std::min(all, max_decoded_at_once), true);
    has_time_to_decode_ = true;
    time_.add(samples.size(), false);
    std::string text;
    try {
        const DecoderReply reply =
            process_->exchange(request, -1, memory_for(encoded_size_, all), time_, samples, text);
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
        time_.add(0, true);
        std::string text;
        const DecoderReply reply = process_->exchange(request, -1, memory_for(encoded_size_, 0),
                                                      time_, std::nullopt, text);
        if (reply.size == 0) DecoderProcess::give_back(std::move(process_));
    } catch (const DecoderLost&) {
        process_.reset();
    } catch (const std::bad_alloc&) {
        process_.reset();
    }
}

}  // namespace relief::detail
