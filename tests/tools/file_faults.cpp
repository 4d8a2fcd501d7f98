// SPDX-License-Identifier: Apache-2.0
#include "tools/file_faults.h"

#include <fcntl.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <stdexcept>
#include <string_view>
#include <system_error>

namespace relief::test {
namespace {

enum class Kind { named, opened, descriptor };

struct Call {
    int number;
    const char* name;
    Kind kind;
};

/// Calls that change files. Those of `opened` count if they may create a file, those of
/// `descriptor` if the descriptor is a file in the folder.
constexpr Call calls[] = {
#ifdef __NR_rename
    {__NR_creat, "creat", Kind::named},
    {__NR_rename, "rename", Kind::named},
    {__NR_link, "link", Kind::named},
    {__NR_symlink, "symlink", Kind::named},
    {__NR_unlink, "unlink", Kind::named},
    {__NR_mkdir, "mkdir", Kind::named},
    {__NR_rmdir, "rmdir", Kind::named},
    {__NR_chmod, "chmod", Kind::named},
    {__NR_chown, "chown", Kind::named},
#endif
    {__NR_renameat, "renameat", Kind::named},
    {__NR_renameat2, "renameat2", Kind::named},
    {__NR_linkat, "linkat", Kind::named},
    {__NR_symlinkat, "symlinkat", Kind::named},
    {__NR_unlinkat, "unlinkat", Kind::named},
    {__NR_mkdirat, "mkdirat", Kind::named},
    {__NR_fchmodat, "fchmodat", Kind::named},
    {__NR_fchownat, "fchownat", Kind::named},
    {__NR_truncate, "truncate", Kind::named},
    {__NR_openat, "openat", Kind::opened},
    {__NR_write, "write", Kind::descriptor},
    {__NR_writev, "writev", Kind::descriptor},
    {__NR_pwrite64, "pwrite64", Kind::descriptor},
    {__NR_pwritev, "pwritev", Kind::descriptor},
    {__NR_ftruncate, "ftruncate", Kind::descriptor},
    {__NR_fallocate, "fallocate", Kind::descriptor},
    {__NR_fchmod, "fchmod", Kind::descriptor},
    {__NR_fchown, "fchown", Kind::descriptor},
    {__NR_fsync, "fsync", Kind::descriptor},
    {__NR_fdatasync, "fdatasync", Kind::descriptor},
};

const Call& call_of(int number) {
    for (const Call& call : calls) {
        if (call.number == number) return call;
    }
    throw std::logic_error("a system call that the filter does not name");
}

[[noreturn]] void fail(const char* what) {
    throw std::system_error(errno, std::generic_category(), what);
}

/// Asks the supervisor about the calls above. \return the descriptor for the questions; negative if
/// the kernel cannot ask
int install_filter() {
    constexpr auto argument = [](std::size_t index) {
        return static_cast<std::uint32_t>(offsetof(seccomp_data, args) + 8 * index);
    };
    std::array<sock_filter, 1 + 5 * std::size(calls) + 1> filter{};
    std::size_t size = 0;
    const auto append = [&](std::initializer_list<sock_filter> more) {
        for (const sock_filter& one : more)
            filter[size++] = one;
    };
    const sock_filter ask = BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_USER_NOTIF);
    const sock_filter allow = BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW);
    append({BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr))});
    for (const Call& call : calls) {
        const auto number = static_cast<std::uint32_t>(call.number);
        if (call.kind == Kind::named) {
            append({BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, number, 0, 1), ask});
        } else if (call.kind == Kind::opened) {
            append({BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, number, 0, 4),
                    BPF_STMT(BPF_LD | BPF_W | BPF_ABS, argument(2)),
                    BPF_JUMP(BPF_JMP | BPF_JSET | BPF_K, O_CREAT | O_TRUNC, 0, 1), ask, allow});
        } else {
            append({BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, number, 0, 4),
                    BPF_STMT(BPF_LD | BPF_W | BPF_ABS, argument(0)),
                    BPF_JUMP(BPF_JMP | BPF_JGT | BPF_K, STDERR_FILENO, 0, 1), ask, allow});
        }
    }
    append({allow});
    const sock_fprog program{static_cast<unsigned short>(size), filter.data()};
    if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return -1;
    return static_cast<int>(::syscall(__NR_seccomp, SECCOMP_SET_MODE_FILTER,
                                      SECCOMP_FILTER_FLAG_NEW_LISTENER, &program));
}

/// Sends a descriptor, or receives one if `descriptor` is negative. \return it; negative if none
/// came
int exchange_descriptor(int socket, int descriptor) {
    char byte = 0;
    iovec piece{&byte, 1};
    alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> control{};
    msghdr message{};
    message.msg_iov = &piece;
    message.msg_iovlen = 1;
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    if (descriptor >= 0) {
        cmsghdr* const header = CMSG_FIRSTHDR(&message);
        header->cmsg_level = SOL_SOCKET;
        header->cmsg_type = SCM_RIGHTS;
        header->cmsg_len = CMSG_LEN(sizeof(int));
        std::memcpy(CMSG_DATA(header), &descriptor, sizeof descriptor);
        return ::sendmsg(socket, &message, 0) == 1 ? descriptor : -1;
    }
    if (::recvmsg(socket, &message, MSG_CMSG_CLOEXEC) != 1) return -1;
    const cmsghdr* const header = CMSG_FIRSTHDR(&message);
    if (header == nullptr || header->cmsg_type != SCM_RIGHTS) return -1;
    std::memcpy(&descriptor, CMSG_DATA(header), sizeof descriptor);
    return descriptor;
}

/// The program, whose calls wait until this process has decided about them.
class Supervised {
  public:
    /// Calls only functions that are safe after fork().
    Supervised(std::vector<std::string> words, const std::filesystem::path& folder) {
        std::vector<char*> arguments;
        for (std::string& word : words)
            arguments.push_back(word.data());
        arguments.push_back(nullptr);
        std::array<int, 2> ends{};
        if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
            fail("socketpair");
        child_ = ::fork();
        if (child_ < 0) fail("fork");
        if (child_ == 0) become_program(arguments, folder.c_str(), ends[1]);
        ::close(ends[1]);
        questions_ = exchange_descriptor(ends[0], -1);
        ::close(ends[0]);
        ended_ = static_cast<int>(::syscall(__NR_pidfd_open, child_, 0));
    }
    ~Supervised() {
        for (const int descriptor : {questions_, ended_}) {
            if (descriptor >= 0) ::close(descriptor);
        }
        if (child_ <= 0) return;
        ::kill(child_, SIGKILL);
        ::waitpid(child_, nullptr, 0);
    }
    Supervised(const Supervised&) = delete;
    Supervised& operator=(const Supervised&) = delete;

    [[nodiscard]] bool has_filter() const { return questions_ >= 0 && ended_ >= 0; }
    [[nodiscard]] pid_t id() const { return child_; }

    /// Waits for the next question. \return false when the program has ended
    bool next(seccomp_notif& question) const {
        for (;;) {
            std::array<pollfd, 2> states{{{questions_, POLLIN, 0}, {ended_, POLLIN, 0}}};
            if (::poll(states.data(), states.size(), -1) < 0 && errno != EINTR) fail("poll");
            if ((states[0].revents & POLLIN) != 0) {
                question = {};
                if (::ioctl(questions_, SECCOMP_IOCTL_NOTIF_RECV, &question) == 0) return true;
            }
            if ((states[1].revents & POLLIN) != 0) return false;
        }
    }

    /// Lets the call fail, or be made if `error` is 0. A call that a signal interrupted needs no
    /// answer.
    void answer(const seccomp_notif& question, int error) const {
        seccomp_notif_resp response{};
        response.id = question.id;
        response.error = -error;
        response.flags = error == 0 ? SECCOMP_USER_NOTIF_FLAG_CONTINUE : 0;
        ::ioctl(questions_, SECCOMP_IOCTL_NOTIF_SEND, &response);
    }

    int exit_code() {
        int status = 0;
        ::waitpid(child_, &status, 0);
        child_ = 0;
        return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    }

  private:
    [[noreturn]] static void become_program(const std::vector<char*>& arguments, const char* folder,
                                            int socket) {
        const rlimit none{};
        ::setrlimit(RLIMIT_CORE, &none);  // SIGQUIT would leave a core file.
        const int nowhere = ::open("/dev/null", O_RDWR);
        for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
            ::dup2(nowhere, stream);
        // A shell may start these tests with signals ignored, which programs inherit.
        for (const int signal : {SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGXCPU})
            ::signal(signal, SIG_DFL);
        if (::chdir(folder) != 0) ::_exit(127);
        const int questions = install_filter();
        if (questions < 0 || exchange_descriptor(socket, questions) < 0) ::_exit(127);
        ::close(questions);
        ::execv(arguments.front(), arguments.data());
        ::_exit(127);
    }

    pid_t child_ = 0;
    int questions_ = -1;
    int ended_ = -1;
};

/// Returns whether a call changes a file in the folder.
bool counts(const seccomp_notif& question, const Call& call, const std::string& folder) {
    if (call.kind != Kind::descriptor) return true;
    std::error_code error;
    const std::filesystem::path file = std::filesystem::read_symlink(
        "/proc/" + std::to_string(question.pid) + "/fd/" + std::to_string(question.data.args[0]),
        error);
    return !error && file.string().starts_with(folder);
}

bool makes_link(const Call& call) {
    return std::string_view(call.name).starts_with("link");
}

}  // namespace

bool can_inject_faults() {
    return Supervised({"/bin/true"}, "/").has_filter();
}

FaultResult run_with_fault(const std::vector<std::string>& words,
                           const std::filesystem::path& folder,
                           const std::filesystem::path& changed, const Fault& fault) {
    Supervised program(words, folder);
    if (!program.has_filter()) throw std::runtime_error("the kernel cannot ask about calls");
    const std::string real_folder = std::filesystem::canonical(changed).string();
    FaultResult result;
    seccomp_notif question{};
    while (program.next(question)) {
        const Call& call = call_of(question.data.nr);
        int error = 0;
        if (counts(question, call, real_folder)) {
            if (fault.has_no_links && makes_link(call)) error = EPERM;
            if (result.calls == fault.call && (fault.error != 0 || fault.signal != 0)) {
                result.call_name = call.name;
                if (fault.error != 0) error = fault.error;
                if (fault.signal != 0) ::kill(program.id(), fault.signal);
            }
            ++result.calls;
        }
        program.answer(question, error);
    }
    result.exit_code = program.exit_code();
    return result;
}

}  // namespace relief::test
