// SPDX-License-Identifier: Apache-2.0
// Temporary files are in a list for the signal handler, which can neither lock nor allocate. All
// changes of the list and of names of files happen within a SignalDelay, and the handler waits
// until there is none, so it never sees a change that is half done.
// Tests: tests/mesh/base/file_replacement_test.cpp, tests/tools/file_faults_test.cpp.
#include "file_replacement.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <optional>
#include <random>
#include <string>
#include <utility>

#include "operating_system.h"
#include "relief/mesh/report.h"

namespace relief::detail {

constinit thread_local FileSet* current_file_set = nullptr;

namespace {

std::atomic<int> delay_count = 0;
std::atomic<bool> is_ending = false;
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

std::atomic<std::size_t> replaced_count = 0;

}  // namespace

SignalDelay::SignalDelay() : before_(block_ending_signals()) {
    ++delay_count;
    if (!is_ending) return;
    // The handler runs in another thread and ends the program.
    --delay_count;
    for (;;)
        sleep_one_millisecond();
}

SignalDelay::~SignalDelay() {
    --delay_count;
    restore_signals(before_);
}

namespace {

/// Returns the file that is replaced: `file`, or the file that it links to, which need not exist.
/// No value if a link leads back to itself.
std::optional<std::filesystem::path> target_of(const std::filesystem::path& file) {
    constexpr int max_links = 40;
    std::filesystem::path target = file;
    std::error_code error;
    for (int links = 0; std::filesystem::is_symlink(target, error); ++links) {
        if (links == max_links) return std::nullopt;
        // An absolute link replaces the folder.
        target = target.parent_path() / std::filesystem::read_symlink(target, error);
    }
    return target;
}

std::filesystem::path folder_of(const std::filesystem::path& target) {
    return target.has_parent_path() ? target.parent_path() : std::filesystem::path(".");
}

/// Returns the same path for all names of a file that need not exist.
std::filesystem::path identity_of(const std::filesystem::path& target) {
    std::error_code error;
    const std::filesystem::path folder = std::filesystem::canonical(folder_of(target), error);
    return error ? target : folder / target.filename();
}

/// Returns a number that no other program can predict.
std::uint64_t random_number() {
    std::random_device random;  // The generator of the operating system or the processor.
    const std::uint64_t high = random();
    return high << 32 | random();
}

/// Returns a random name in the folder of the target, with its extension.
std::filesystem::path random_name_beside(const std::filesystem::path& target) {
    constexpr std::size_t max_extension = 16;
    std::filesystem::path extension = target.extension();
    if (extension.native().size() > max_extension) extension.clear();
    return std::filesystem::path(target)
        .replace_filename(fmt::format(".relief-{:016x}", random_number()))
        .concat(extension.native());
}

}  // namespace

/// A temporary file and the file that it replaces.
class StagedFile {
  public:
    explicit StagedFile(std::filesystem::path file);
    ~StagedFile();
    StagedFile(const StagedFile&) = delete;
    StagedFile& operator=(const StagedFile&) = delete;

    [[nodiscard]] const std::filesystem::path& file() const { return file_; }
    [[nodiscard]] const std::filesystem::path& temporary() const { return temporary_; }
    [[nodiscard]] const std::filesystem::path& identity() const { return identity_; }
    [[nodiscard]] int descriptor() const { return descriptor_; }
    [[nodiscard]] const StagedFile* next() const { return next_; }

    /// Waits until the temporary file is on the disk. \throws FileError
    void complete();

    // The steps of commit_together(), within a SignalDelay. They allocate no memory.

    /// Renames the temporary file. \param keeps_old  whether restore() may follow
    /// \return 0 or the error
    int replace(bool keeps_old) noexcept;
    /// Gives the old file its name back after replace(), or removes the new file if there was none.
    void restore() noexcept;
    /// Removes the old file.
    void forget_old() noexcept;

    /// Returns what restore() left undone, for a message; empty if nothing.
    [[nodiscard]] std::string rest_of_failure() const;

    /// The error of replace() if another program replaced the temporary file.
    static constexpr int foreign_file = -1;

  private:
    int keep_old() noexcept;
    void add_to_list() noexcept;
    void remove_from_list() noexcept;

    enum class Old { none, linked, renamed };

    std::filesystem::path file_;
    std::filesystem::path target_;  ///< `file_`, or the file that the link `file_` names.
    std::filesystem::path identity_;
    std::filesystem::path temporary_;
    std::filesystem::path old_;
    Old old_state_ = Old::none;
    bool is_left_new_ = false;
    int descriptor_ = -1;
    bool is_listed_ = false;  ///< Whether the temporary name exists.
    StagedFile* previous_ = nullptr;
    StagedFile* next_ = nullptr;
};

namespace {

StagedFile* first_staged = nullptr;

/// Protects the list. It is locked within a SignalDelay only.
std::mutex list_mutex;

/// Runs in the signal handler; it calls only async-signal-safe functions.
void remove_temporaries() {
    is_ending = true;
    while (delay_count > 0)
        sleep_one_millisecond();
    for (const StagedFile* file = first_staged; file != nullptr; file = file->next())
        remove_file(file->temporary());
}

}  // namespace

void remove_temporaries_on_signals() {
    call_before_end(remove_temporaries);
}

std::size_t replaced_file_count() {
    return replaced_count;
}

void StagedFile::add_to_list() noexcept {
    const std::lock_guard lock(list_mutex);
    next_ = first_staged;
    if (next_ != nullptr) next_->previous_ = this;
    first_staged = this;
    is_listed_ = true;
}

void StagedFile::remove_from_list() noexcept {
    const std::lock_guard lock(list_mutex);
    if (next_ != nullptr) next_->previous_ = previous_;
    (previous_ != nullptr ? previous_->next_ : first_staged) = next_;
    is_listed_ = false;
}

StagedFile::StagedFile(std::filesystem::path file) : file_(std::move(file)) {
    const auto target = target_of(file_);
    if (!target) throw FileError(file_, "is a link that leads back to itself");
    target_ = *target;
    const std::filesystem::path folder = folder_of(target_);
    std::error_code unknown;
    if (!std::filesystem::is_directory(folder, unknown)) {
        throw FileError(file_, fmt::format("the folder {} does not exist", folder.string()));
    }
    const std::filesystem::file_status status = std::filesystem::status(target_, unknown);
    if (std::filesystem::is_directory(status)) throw FileError(file_, "is a folder");
    // Renaming would replace /dev/null, or the pipe behind /dev/stdout, by a file.
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
        throw FileError(file_, "is a device or a pipe, which would be replaced by a file");
    identity_ = identity_of(target_);
    old_ = random_name_beside(target_);
    constexpr int max_attempts = 100;
    for (int attempt = 0; attempt < max_attempts; ++attempt) {
        temporary_ = random_name_beside(target_);
        int error = 0;
        {
            const SignalDelay delay;
            const OpenFile created = create_exclusively(temporary_);
            descriptor_ = created.descriptor;
            error = created.error;
            if (descriptor_ >= 0) add_to_list();
        }
        if (descriptor_ >= 0) return;
        if (!is_name_in_use(error))
            throw FileError(file_, fmt::format("cannot be written: {}", error_text(error)));
    }
    throw FileError(file_, "cannot be written: no temporary file can be made beside it");
}

StagedFile::~StagedFile() {
    if (is_listed_) {
        const SignalDelay delay;
        if (is_same_file(temporary_, descriptor_)) remove_file(temporary_);
        remove_from_list();
    }
    if (descriptor_ >= 0) close_descriptor(descriptor_);
}

void StagedFile::complete() {
    copy_mode_and_owner(target_, descriptor_);
    const int error = synchronize(descriptor_);
    if (error != 0) throw FileError(file_, fmt::format("cannot be written: {}", error_text(error)));
}

/// Gives the old file a second name, or on file systems without hard links another name. \return 0
/// or the error
int StagedFile::keep_old() noexcept {
    const int link_error = link_file(target_, old_);
    if (link_error == 0) {
        old_state_ = Old::linked;
        return 0;
    }
    if (is_missing(link_error)) return 0;
    if (const int error = require_no_folder(target_); error != 0) return error;
    if (const int error = rename_file(target_, old_); error != 0) return error;
    old_state_ = Old::renamed;
    return 0;
}

int StagedFile::replace(bool keeps_old) noexcept {
    if (!is_same_file(temporary_, descriptor_)) return foreign_file;
    int error = keeps_old ? keep_old() : 0;
    if (error != 0) return error;
    error = rename_file(temporary_, target_);
    if (error == 0) {
        remove_from_list();
        // Windows replaces no file that is open, as restore() may have to.
        close_descriptor(std::exchange(descriptor_, -1));
        return 0;
    }
    // A rename between two names of one file would do nothing.
    if (old_state_ == Old::linked) forget_old();
    if (old_state_ == Old::renamed && rename_file(old_, target_) == 0) old_state_ = Old::none;
    return error;
}

void StagedFile::restore() noexcept {
    const int error = old_state_ == Old::none ? remove_file(target_) : rename_file(old_, target_);
    if (error == 0)
        old_state_ = Old::none;
    else
        is_left_new_ = true;
}

void StagedFile::forget_old() noexcept {
    if (old_state_ != Old::none) remove_file(old_);
    old_state_ = Old::none;
}

std::string StagedFile::rest_of_failure() const {
    std::string text;
    if (is_left_new_) text = fmt::format("; the new {} could not be removed", file_.string());
    if (old_state_ != Old::none)
        text += fmt::format("; the old {} is now {}", file_.string(), old_.string());
    return text;
}

namespace {

/// Replaces all files or none. \throws FileError
void commit_together(const std::vector<std::shared_ptr<StagedFile>>& files) {
    std::size_t done = 0;
    int error = 0;
    {
        const SignalDelay delay;
        for (; done < files.size(); ++done) {
            error = files[done]->replace(done + 1 < files.size());
            if (error != 0) break;
        }
        for (std::size_t i = 0; i < done; ++i) {
            if (error == 0)
                files[i]->forget_old();
            else
                files[done - 1 - i]->restore();
        }
    }
    if (error == 0) {
        replaced_count += files.size();
        return;
    }
    std::string problem = "cannot be written: ";
    problem += error == StagedFile::foreign_file ? "another program replaced the temporary file"
                                                 : error_text(error);
    for (const std::shared_ptr<StagedFile>& file : files)
        problem += file->rest_of_failure();
    throw FileError(files[done]->file(), problem);
}

}  // namespace

FileReplacement::FileReplacement(std::filesystem::path file)
    : staged_(std::make_shared<StagedFile>(std::move(file))) {}

FileReplacement::~FileReplacement() = default;

const std::filesystem::path& FileReplacement::file() const {
    return staged_->file();
}

const std::filesystem::path& FileReplacement::temporary() const {
    return staged_->temporary();
}

std::filesystem::path FileReplacement::written_path() const {
    return path_of_descriptor(staged_->descriptor()).value_or(staged_->temporary());
}

void FileReplacement::commit() {
    staged_->complete();
    if (current_file_set != nullptr)
        current_file_set->add(staged_);
    else
        commit_together({staged_});
}

FileSet::FileSet() : outer_(std::exchange(current_file_set, this)) {}

FileSet::~FileSet() {
    if (is_open_) current_file_set = outer_;
}

void FileSet::add(std::shared_ptr<StagedFile> file) {
    const std::lock_guard lock(mutex_);
    std::erase_if(files_, [&](const auto& other) { return other->identity() == file->identity(); });
    files_.push_back(std::move(file));
}

void FileSet::commit() {
    current_file_set = outer_;
    is_open_ = false;
    if (outer_ == nullptr) return commit_together(files_);
    for (std::shared_ptr<StagedFile>& file : files_)
        outer_->add(std::move(file));
    files_.clear();
}

std::filesystem::path staged_file(const std::filesystem::path& file) {
    if (current_file_set == nullptr) return file;
    const std::filesystem::path identity = identity_of(target_of(file).value_or(file));
    for (FileSet* set = current_file_set; set != nullptr; set = set->outer_) {
        const std::lock_guard lock(set->mutex_);
        for (const std::shared_ptr<StagedFile>& staged : set->files_) {
            if (staged->identity() == identity) return staged->temporary();
        }
    }
    return file;
}

void write_all(const FileReplacement& replacement, std::span<const std::byte> bytes) {
    std::ofstream stream(replacement.written_path(), std::ios::binary);
    stream.write(reinterpret_cast<const char*>(bytes.data()),
                 static_cast<std::streamsize>(bytes.size()));
    stream.close();
    if (!stream) {
        throw FileError(replacement.file(),
                        fmt::format("cannot be written: {}", std::strerror(errno)));
    }
}

void replace_file(const std::filesystem::path& file, std::span<const std::byte> bytes) {
    FileReplacement replacement(file);
    write_all(replacement, bytes);
    replacement.commit();
}

}  // namespace relief::detail
