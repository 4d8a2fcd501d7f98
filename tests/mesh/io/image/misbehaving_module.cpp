// SPDX-License-Identifier: Apache-2.0
// An image module that does what a reader of OpenImageIO might do after a hostile file has taken it
// over: forbidden system calls, lies about the image, false replies, silence, endless work. The
// text of the "image" after its signature names the behavior; without a known name it is a good
// image of one texel of value 9. Tests: misbehaving_decoder_test.cpp.
#include <fcntl.h>
#include <pthread.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "io/image/decoder_process.h"
#include "io/image/image_module.h"

namespace relief {
using namespace relief::detail;

struct relief::detail::ImageModuleReader {
    std::string behavior;
};

namespace {

constexpr int program_socket = 0;

// Calls that must fail. Each returns 0 or more if it succeeds.

long call(long number, long a = 0, long b = 0, long c = 0, long d = 0) {
    return ::syscall(number, a, b, c, d);
}

long raise_limit(decltype(RLIMIT_AS) which) {
    const rlimit none{RLIM_INFINITY, RLIM_INFINITY};
    return ::prlimit(0, which, &none, nullptr);
}

long start_thread() {
    pthread_t thread{};
    errno = ::pthread_create(
        &thread, nullptr, [](void*) -> void* { return nullptr; }, nullptr);
    return errno == 0 ? 0 : -1;
}

using Action = long (*)();

const std::map<std::string_view, Action>& forbidden_calls() {
    static const std::map<std::string_view, Action> calls = {
        {"open a file", [] { return static_cast<long>(::open("/etc/passwd", O_RDONLY)); }},
        {"create a file",
         [] { return static_cast<long>(::open("/tmp/x", O_RDWR | O_CREAT, 0600)); }},
        {"open a socket", [] { return static_cast<long>(::socket(AF_INET, SOCK_STREAM, 0)); }},
        {"send a descriptor", [] { return call(__NR_sendmsg, program_socket); }},
        {"signal all", [] { return static_cast<long>(::kill(-1, 0)); }},
        {"trace", [] { return ::ptrace(PTRACE_TRACEME, 0, nullptr, nullptr); }},
        {"choose the receiver of signals",
         [] { return static_cast<long>(::fcntl(program_socket, F_SETOWN, 1)); }},
        {"choose the signal",
         [] { return static_cast<long>(::fcntl(program_socket, F_SETSIG, SIGKILL)); }},
        {"ask for signals",
         [] { return static_cast<long>(::fcntl(program_socket, F_SETFL, O_ASYNC)); }},
        {"lift the limit of memory", [] { return raise_limit(RLIMIT_AS); }},
        {"lift the limit of time", [] { return raise_limit(RLIMIT_CPU); }},
        {"lift a limit by the old call",
         [] {
             const rlimit none{RLIM_INFINITY, RLIM_INFINITY};
             return call(__NR_setrlimit, RLIMIT_FSIZE, reinterpret_cast<long>(&none));
         }},
        {"start a thread", start_thread},
        {"start a process", [] { return call(__NR_clone, SIGCHLD); }},
        {"start a process by the new call", [] { return call(__NR_clone3); }},
        {"start a program", [] { return call(__NR_execve); }},
    };
    return calls;
}

// Behavior instead of a reply.

void send_all(const void* bytes, std::size_t size) {
    ::send(program_socket, bytes, size, MSG_NOSIGNAL);
}

[[noreturn]] void be_silent() {
    for (;;)
        ::usleep(100'000);
}

[[noreturn]] void drip() {
    DecoderReply reply;
    reply.succeeded = 1;
    reply.size = 1'000'000;
    const char* const bytes = reinterpret_cast<const char*>(&reply);
    for (std::size_t i = 0;; ++i) {
        send_all(&bytes[i % sizeof reply], 1);
        ::usleep(20'000);
    }
}

[[noreturn]] void compute_for_ever() {
    sigset_t all;
    ::sigfillset(&all);
    ::sigprocmask(SIG_BLOCK, &all, nullptr);
    std::atomic<unsigned> count = 0;
    for (;;)
        ++count;
}

void allocate_for_ever() {
    static std::vector<std::unique_ptr<char[]>> all;
    for (;;)
        all.push_back(std::make_unique_for_overwrite<char[]>(std::size_t{1} << 24));
}

/// Makes the shared memory of the encoded image larger.
void grow_image() {
    constexpr std::string_view bytes = "12345678";
    for (int descriptor = 3; descriptor < 10; ++descriptor) {
        ::lseek(descriptor, 0, SEEK_END);
        static_cast<void>(::write(descriptor, bytes.data(), bytes.size()));
    }
}

void answer(std::uint64_t size, std::uint32_t succeeded = 1) {
    DecoderReply reply;
    reply.succeeded = succeeded;
    reply.size = size;
    send_all(&reply, sizeof reply);
}

void misbehave(std::string_view behavior) {
    if (behavior == "crash") std::raise(SIGSEGV);
    if (behavior == "abort") std::abort();
    if (behavior == "exit") ::_exit(0);
    if (behavior == "be silent") be_silent();
    if (behavior == "drip") drip();
    if (behavior == "compute") compute_for_ever();
    if (behavior == "allocate") allocate_for_ever();
    if (behavior == "grow the image") grow_image();
    if (behavior == "send noise") send_all("noise noise noise noise", 23);
    if (behavior == "announce much text") answer(std::uint64_t{1} << 60);
    if (behavior == "announce a long reason") answer(~std::uint64_t{0}, 0);
    if (behavior == "succeed twice") answer(0, 2);
    if (behavior == "send half") {
        answer(1000);
        ::_exit(0);
    }
}

// The image.

ImageModuleHeader header_of(std::string_view behavior) {
    constexpr std::int64_t huge = std::int64_t{1} << 40;
    constexpr std::int64_t full_turn = std::int64_t{1} << 32;
    if (behavior == "huge size") return {huge, huge, 1, 8};
    if (behavior == "negative width") return {-1, 1, 1, 8};
    if (behavior == "width that wraps") return {full_turn + 1, 1, 1, 8};
    if (behavior == "height that wraps") return {1, full_turn + 1, 1, 8};
    if (behavior == "channels that wrap") return {1, 1, full_turn + 1, 8};
    if (behavior == "unknown bits") return {1, 1, 1, 7};
    if (behavior == "no texels") return {0, 0, 1, 8};
    return {1, 1, 1, 8};
}

ImageModuleReader* open(const char*, const void* bytes, std::size_t size, ImageModuleHeader* header,
                        ImageModuleText text, ImageModuleFailure failure) {
    const std::string_view all(static_cast<const char*>(bytes), size);
    const std::string behavior(all.substr(all.find(':') + 1));
    if (const auto found = forbidden_calls().find(behavior); found != forbidden_calls().end()) {
        const std::string result =
            found->second() >= 0 ? "was permitted" : std::string(std::strerror(errno));
        return failure.fail(failure.receiver, (behavior + ": " + result).c_str()), nullptr;
    }
    if (behavior == "much text") {
        const std::string value(std::size_t{1} << 20, 'x');
        for (int i = 0; i < 17; ++i)
            text.entry(text.receiver, "key", value.c_str());
    }
    misbehave(behavior);
    *header = header_of(behavior);
    return new ImageModuleReader{behavior};
}

ImageModuleReader* open_descriptor(const char*, int, ImageModuleHeader*, ImageModuleText,
                                   ImageModuleFailure) {
    return nullptr;
}

std::int64_t row_grain(ImageModuleReader* reader) {
    if (reader->behavior == "no rows at once") return 0;
    if (reader->behavior == "rows at once that wrap") return (std::int64_t{1} << 32) + 1;
    return 1;
}

bool read(ImageModuleReader* reader, std::int64_t, std::int64_t, void* samples,
          ImageModuleFailure) {
    *static_cast<unsigned char*>(samples) = 9;
    if (reader->behavior == "too many samples") answer(2);
    if (reader->behavior == "too few samples") answer(0);
    if (reader->behavior == "answer twice") {
        answer(1);
        send_all("\11", 1);
    }
    if (reader->behavior == "crash in a row") std::raise(SIGSEGV);
    if (reader->behavior == "be silent in a row") be_silent();
    return true;
}

void close(ImageModuleReader* reader) {
    if (reader->behavior == "be silent at the end") be_silent();
    if (reader->behavior == "crash at the end") std::raise(SIGSEGV);
    delete reader;
}

constexpr ImageModule table{image_module_version,
                            [] {},
                            open,
                            open_descriptor,
                            row_grain,
                            read,
                            close,
                            nullptr,
                            nullptr,
                            nullptr,
                            nullptr};

}  // namespace
}  // namespace relief

extern "C" __attribute__((visibility("default"))) const relief::detail::ImageModule*
relief_image_module() {
    return &relief::table;
}
