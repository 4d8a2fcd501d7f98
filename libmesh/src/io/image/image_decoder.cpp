// SPDX-License-Identifier: Apache-2.0
// The program relief-image-decoder: decodes images with the image module for a program that sends
// requests over the socket at descriptor 0. It ends with that program.
//
// OpenImageIO's readers crash, loop or allocate gigabytes on some damaged files. Here this ends
// only the decoder. The program limits its memory and processor time for each request
// (decoder_process.cpp). A seccomp filter permits only the system calls that decoding needs: no
// file can be opened, no program, process or thread can be started, no other process can be
// signaled, no limit can be changed, and there is no network.
#include <dlfcn.h>
#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <malloc.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <climits>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <initializer_list>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "io/image/decoder_process.h"

namespace relief {
using namespace relief::detail;

namespace {

constexpr int socket_descriptor = 0;

// --- System calls ---

#if defined __x86_64__
constexpr std::uint32_t architecture = AUDIT_ARCH_X86_64;
#elif defined __aarch64__
constexpr std::uint32_t architecture = AUDIT_ARCH_AARCH64;
#else
constexpr std::uint32_t architecture = 0;
#endif

constexpr unsigned permitted_calls[] = {
    // Memory, and locks of the only thread.
    __NR_brk, __NR_mmap, __NR_munmap, __NR_mremap, __NR_mprotect, __NR_madvise, __NR_futex,
    __NR_set_robust_list, __NR_rseq, __NR_sched_yield, __NR_sched_getaffinity, __NR_membarrier,
    __NR_gettid, __NR_getpid, __NR_exit, __NR_exit_group, __NR_sigaltstack, __NR_rt_sigaction,
    __NR_rt_sigprocmask, __NR_rt_sigreturn, __NR_restart_syscall,
    // Descriptors that are open already.
    __NR_read, __NR_pread64, __NR_lseek, __NR_fstat, __NR_close, __NR_sendto, __NR_recvmsg,
    __NR_recvfrom, __NR_write,
    // Clocks, limits and numbers.
    __NR_clock_gettime, __NR_clock_getres, __NR_clock_nanosleep, __NR_nanosleep, __NR_gettimeofday,
    __NR_getrusage, __NR_getrandom, __NR_sysinfo, __NR_uname, __NR_getrlimit};

/// Commands of fcntl that concern the descriptor only. Others change the open file, which the
/// program shares, or make the kernel send signals to any process of the user.
constexpr std::uint32_t permitted_fcntl_commands[] = {F_GETFD, F_SETFD, F_GETFL, F_DUPFD,
                                                      F_DUPFD_CLOEXEC};

constexpr std::uint32_t field(std::size_t offset) {
    return static_cast<std::uint32_t>(offset);
}

/// The low half of an argument of a system call. Both architectures are little-endian.
constexpr std::uint32_t argument(std::size_t index) {
    return field(offsetof(seccomp_data, args) + index * sizeof(std::uint64_t));
}
constexpr std::uint32_t high_half_of_argument(std::size_t index) {
    return argument(index) + field(sizeof(std::uint32_t));
}

sock_filter load(std::uint32_t offset) {
    return BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offset);
}
sock_filter give(std::uint32_t result) {
    return BPF_STMT(BPF_RET | BPF_K, result);
}
/// Continues with the next instruction if the loaded value is `value`; otherwise skips `count`.
sock_filter unless_equal(std::uint32_t value, std::uint8_t count) {
    return BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, value, 0, count);
}

/// Installs the filter. Kernels without seccomp continue without it.
void forbid_system_calls() {
    if (architecture == 0) return;
    constexpr std::uint32_t refused = SECCOMP_RET_ERRNO | EPERM;
    std::vector<sock_filter> filter{load(field(offsetof(seccomp_data, arch))),
                                    unless_equal(architecture, 1), BPF_STMT(BPF_JMP | BPF_JA, 1),
                                    give(SECCOMP_RET_KILL_PROCESS),
                                    load(field(offsetof(seccomp_data, nr)))};
    const auto append = [&](std::initializer_list<sock_filter> more) {
        filter.insert(filter.end(), more);
    };
    for (const unsigned call : permitted_calls)
        append({unless_equal(call, 1), give(SECCOMP_RET_ALLOW)});
    append(
        {unless_equal(__NR_fcntl, 2 * std::size(permitted_fcntl_commands) + 2), load(argument(1))});
    for (const std::uint32_t command : permitted_fcntl_commands)
        append({unless_equal(command, 1), give(SECCOMP_RET_ALLOW)});
    append({give(refused)});
    // Signals to this process only: abort() sends one.
    append({unless_equal(__NR_tgkill, 4), load(argument(0)),
            unless_equal(static_cast<std::uint32_t>(::getpid()), 1), give(SECCOMP_RET_ALLOW),
            give(refused)});
    // Limits of this process can be read, but not changed: the new limit must be null.
    append({unless_equal(__NR_prlimit64, 8), load(argument(0)), unless_equal(0, 5),
            load(argument(2)), unless_equal(0, 3), load(high_half_of_argument(2)),
            unless_equal(0, 1), give(SECCOMP_RET_ALLOW), give(refused)});
    append({give(refused)});
    const sock_fprog program{static_cast<unsigned short>(filter.size()), filter.data()};
    if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return;
    ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program);
}

// --- Messages ---

void send_all(const void* bytes, std::size_t size) {
    const char* at = static_cast<const char*>(bytes);
    while (size > 0) {
        const ssize_t sent = ::send(socket_descriptor, at, size, MSG_NOSIGNAL);
        if (sent < 0 && errno == EINTR) continue;
        if (sent <= 0) ::_exit(0);  // The program has ended.
        at += sent;
        size -= static_cast<std::size_t>(sent);
    }
}

void reply(DecoderReply message, std::string_view bytes) {
    message.size = bytes.size();
    send_all(&message, sizeof message);
    send_all(bytes.data(), bytes.size());
}

void reply_failure(std::string_view reason) {
    reply({}, reason);
}

/// Receives a request, and a descriptor if one comes with it. Ends the process with the program.
DecoderRequest receive(int& descriptor) {
    DecoderRequest request;
    char* at = reinterpret_cast<char*>(&request);
    std::size_t left = sizeof request;
    while (left > 0) {
        iovec piece{at, left};
        alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> control{};
        msghdr message{};
        message.msg_iov = &piece;
        message.msg_iovlen = 1;
        message.msg_control = control.data();
        message.msg_controllen = control.size();
        const ssize_t got = ::recvmsg(socket_descriptor, &message, MSG_CMSG_CLOEXEC);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) ::_exit(0);
        const cmsghdr* header = CMSG_FIRSTHDR(&message);
        if (header != nullptr && header->cmsg_type == SCM_RIGHTS)
            std::memcpy(&descriptor, CMSG_DATA(header), sizeof descriptor);
        at += got;
        left -= static_cast<std::size_t>(got);
    }
    return request;
}

// --- Decoding ---

class Decoder {
  public:
    explicit Decoder(const ImageModule& module) : module_(module) {}

    void open(const DecoderRequest& request, int descriptor) {
        close();
        descriptor_ = descriptor;
        DecoderReply message;
        std::string text, reason;
        const ImageModuleText entries{&text,
                                      [](void* receiver, const char* key, const char* value) {
                                          auto& all = *static_cast<std::string*>(receiver);
                                          all.append(key).push_back('\0');
                                          all.append(value).push_back('\0');
                                      }};
        const ImageModuleFailure failure{&reason, [](void* receiver, const char* why) {
                                             static_cast<std::string*>(receiver)->assign(why);
                                         }};
        if (request.in_memory != 0) {
            size_ = request.size;
            mapped_ = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, descriptor_, 0);
            if (mapped_ == MAP_FAILED) return reply_failure(memory_failure);
            reader_ =
                module_.open(request.format, mapped_, size_, &message.header, entries, failure);
        } else {
            reader_ = module_.open_descriptor(request.format, descriptor_, &message.header, entries,
                                              failure);
        }
        if (reader_ == nullptr) return reply_failure(reason);
        header_ = message.header;
        message.succeeded = 1;
        message.row_grain = module_.row_grain(reader_);
        reply(message, text);
    }

    void read(const DecoderRequest& request) {
        std::string reason;
        const auto row = static_cast<std::size_t>(header_.width) *
                         static_cast<std::size_t>(header_.channels * (header_.bits / 8));
        samples_.resize(row * static_cast<std::size_t>(request.end - request.first));
        const ImageModuleFailure failure{&reason, [](void* receiver, const char* why) {
                                             static_cast<std::string*>(receiver)->assign(why);
                                         }};
        if (reader_ == nullptr ||
            !module_.read(reader_, request.first, request.end, samples_.data(), failure)) {
            return reply_failure(reason);
        }
        DecoderReply message;
        message.succeeded = 1;
        reply(message, samples_);
    }

    void close() {
        if (reader_ != nullptr) module_.close(reader_);
        if (mapped_ != MAP_FAILED) ::munmap(mapped_, size_);
        if (descriptor_ >= 0) ::close(descriptor_);
        reader_ = nullptr;
        mapped_ = MAP_FAILED;
        descriptor_ = -1;
        samples_ = {};
        ::malloc_trim(0);
    }

    /// Closes the image at the program's request.
    void finish() {
        close();
        DecoderReply message;
        message.succeeded = 1;
        reply(message, {});
    }

    static constexpr const char* memory_failure = "takes more memory than is permitted";

  private:
    const ImageModule& module_;
    ImageModuleReader* reader_ = nullptr;
    ImageModuleHeader header_;
    int descriptor_ = -1;
    void* mapped_ = MAP_FAILED;
    std::size_t size_ = 0;
    std::string samples_;
};

/// Loads the image module from the folder of this program.
const ImageModule* load_module(std::string& reason) {
    std::array<char, PATH_MAX> self{};
    const ssize_t length = ::readlink("/proc/self/exe", self.data(), self.size());
    std::string place(self.data(), length < 0 ? 0 : static_cast<std::size_t>(length));
    place.resize(place.rfind('/') + 1);
    place += image_module_name;
    void* const library = ::dlopen(place.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) return reason = ::dlerror(), nullptr;
    using Entry = const ImageModule* (*)();
    const auto entry = reinterpret_cast<Entry>(::dlsym(library, image_module_entry));
    const ImageModule* const module = entry == nullptr ? nullptr : entry();
    if (module != nullptr && module->version == image_module_version) return module;
    reason = place + " belongs to another version of relief";
    return nullptr;
}

[[noreturn]] void serve() {
    std::string reason;
    const ImageModule* const module = load_module(reason);
    if (module == nullptr) {
        reply_failure(reason);
        ::_exit(1);
    }
    module->use_one_thread();
    forbid_system_calls();
    DecoderReply ready;
    ready.succeeded = 1;
    reply(ready, {});
    Decoder decoder(*module);
    for (;;) {
        int descriptor = -1;
        const DecoderRequest request = receive(descriptor);
        try {
            if (request.action == DecoderAction::open)
                decoder.open(request, descriptor);
            else if (request.action == DecoderAction::read)
                decoder.read(request);
            else
                decoder.finish();
        } catch (const std::exception&) {
            reply_failure(Decoder::memory_failure);
        }
    }
}

}  // namespace
}  // namespace relief

int main() {
    ::close_range(1, 2, 0);  // Decoders of OpenImageIO print.
    ::open("/dev/null", O_WRONLY);
    ::open("/dev/null", O_WRONLY);
    ::close_range(3, ~0U, 0);
    ::setenv("OPENIMAGEIO_THREADS", "1", 1);  // Read when the module is loaded.
    relief::serve();
}
