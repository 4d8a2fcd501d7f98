// SPDX-License-Identifier: Apache-2.0
// Windows 7 and later. Files are opened such that other handles may rename and remove them, as on
// other systems.
#if !defined(NOMINMAX)
#define NOMINMAX
#endif
#include <fcntl.h>
#include <io.h>
#include <windows.h>

#include <algorithm>
#include <system_error>

#include "operating_system.h"
#include "relief/mesh/execution.h"

namespace relief {

FileStamp stamp_of(const std::filesystem::path& file) {
    WIN32_FILE_ATTRIBUTE_DATA facts{};
    if (::GetFileAttributesExW(file.c_str(), GetFileExInfoStandard, &facts) == 0) return {};
    const auto joined = [](DWORD high, DWORD low) { return std::uint64_t{high} << 32 | low; };
    const FILETIME& changed = facts.ftLastWriteTime;
    // The number of a file is known only for an open one: an existing file has 1.
    return {static_cast<std::int64_t>(joined(changed.dwHighDateTime, changed.dwLowDateTime)),
            joined(facts.nFileSizeHigh, facts.nFileSizeLow), 1};
}

namespace detail {
namespace {

constexpr DWORD share_all = FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE;

int last_error() {
    return static_cast<int>(::GetLastError());
}

HANDLE handle_of(int descriptor) {
    return reinterpret_cast<HANDLE>(::_get_osfhandle(descriptor));
}

OpenFile open_file(const std::filesystem::path& file, DWORD access, DWORD creation, int flags) {
    const HANDLE handle = ::CreateFileW(file.c_str(), access, share_all, nullptr, creation,
                                        FILE_ATTRIBUTE_NORMAL, nullptr);
    if (handle == INVALID_HANDLE_VALUE) return {-1, last_error()};
    const int descriptor = ::_open_osfhandle(reinterpret_cast<std::intptr_t>(handle),
                                             flags | _O_BINARY | _O_NOINHERIT);
    if (descriptor >= 0) return {descriptor, 0};
    ::CloseHandle(handle);
    return {-1, ERROR_TOO_MANY_OPEN_FILES};
}

}  // namespace

std::string error_text(int error) {
    return std::system_category().message(error);
}

std::uint64_t memory_of_machine() {
    constexpr std::uint64_t unknown = std::uint64_t{1} << 33;
    MEMORYSTATUSEX status{};
    status.dwLength = sizeof status;
    return ::GlobalMemoryStatusEx(&status) != 0 ? status.ullTotalPhys : unknown;
}

// Open files.

OpenFile open_to_read(const std::filesystem::path& file) {
    return open_file(file, GENERIC_READ, OPEN_EXISTING, _O_RDONLY);
}

OpenFile create_exclusively(const std::filesystem::path& file) {
    return open_file(file, GENERIC_READ | GENERIC_WRITE, CREATE_NEW, _O_RDWR);
}

bool is_name_in_use(int error) {
    return error == ERROR_FILE_EXISTS || error == ERROR_ALREADY_EXISTS;
}

void close_descriptor(int descriptor) noexcept {
    ::_close(descriptor);
}

std::uint64_t size_of(int descriptor) {
    return static_cast<std::uint64_t>(std::max<std::int64_t>(::_filelengthi64(descriptor), 0));
}

ReadResult read_at(int descriptor, std::span<std::byte> to, std::uint64_t offset) {
    OVERLAPPED at{};
    at.Offset = static_cast<DWORD>(offset);
    at.OffsetHigh = static_cast<DWORD>(offset >> 32);
    constexpr std::size_t max_size = std::size_t{1} << 30;
    DWORD size = 0;
    const auto wanted = static_cast<DWORD>(std::min(to.size(), max_size));
    if (::ReadFile(handle_of(descriptor), to.data(), wanted, &size, &at) != 0) return {size, 0};
    const int error = last_error();
    return {0, error == ERROR_HANDLE_EOF ? 0 : error};
}

int synchronize(int descriptor) noexcept {
    if (::FlushFileBuffers(handle_of(descriptor)) != 0) return 0;
    const int error = last_error();
    return error == ERROR_INVALID_FUNCTION || error == ERROR_NOT_SUPPORTED ? 0 : error;
}

std::optional<std::filesystem::path> path_of_descriptor(int) {
    return std::nullopt;
}

void copy_mode_and_owner(const std::filesystem::path&, int) {}

bool is_same_file(const std::filesystem::path& name, int descriptor) noexcept {
    const HANDLE named =
        ::CreateFileW(name.c_str(), 0, share_all, nullptr, OPEN_EXISTING,
                      FILE_FLAG_BACKUP_SEMANTICS | FILE_FLAG_OPEN_REPARSE_POINT, nullptr);
    if (named == INVALID_HANDLE_VALUE) return false;
    BY_HANDLE_FILE_INFORMATION of_name{};
    BY_HANDLE_FILE_INFORMATION of_open{};
    const bool are_known = ::GetFileInformationByHandle(named, &of_name) != 0 &&
                           ::GetFileInformationByHandle(handle_of(descriptor), &of_open) != 0;
    ::CloseHandle(named);
    return are_known && of_name.dwVolumeSerialNumber == of_open.dwVolumeSerialNumber &&
           of_name.nFileIndexHigh == of_open.nFileIndexHigh &&
           of_name.nFileIndexLow == of_open.nFileIndexLow;
}

// Names of files.

int rename_file(const std::filesystem::path& from, const std::filesystem::path& to) noexcept {
    return ::MoveFileExW(from.c_str(), to.c_str(), MOVEFILE_REPLACE_EXISTING) != 0 ? 0
                                                                                   : last_error();
}

int link_file(const std::filesystem::path& file, const std::filesystem::path& second) noexcept {
    return ::CreateHardLinkW(second.c_str(), file.c_str(), nullptr) != 0 ? 0 : last_error();
}

bool is_missing(int error) {
    return error == ERROR_FILE_NOT_FOUND;
}

int remove_file(const std::filesystem::path& file) noexcept {
    return ::DeleteFileW(file.c_str()) != 0 ? 0 : last_error();
}

int require_no_folder(const std::filesystem::path& entry) noexcept {
    const DWORD attributes = ::GetFileAttributesW(entry.c_str());
    if (attributes == INVALID_FILE_ATTRIBUTES) return last_error();
    return (attributes & FILE_ATTRIBUTE_DIRECTORY) != 0 ? ERROR_ACCESS_DENIED : 0;
}

// Signals.

SignalMask block_ending_signals() noexcept {
    return {};
}

void restore_signals(const SignalMask&) noexcept {}

namespace {

void (*clean_before_end)() = nullptr;

/// \return whether the event was handled: the system then does not end the program
BOOL WINAPI handle_event(DWORD) {
    clean_before_end();
    return FALSE;
}

}  // namespace

void call_before_end(void (*clean)()) {
    clean_before_end = clean;
    ::SetConsoleCtrlHandler(handle_event, TRUE);
}

void sleep_one_millisecond() noexcept {
    ::Sleep(1);
}

}  // namespace detail
}  // namespace relief
