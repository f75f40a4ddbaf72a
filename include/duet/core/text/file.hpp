// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/text/printable.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>

#if __has_include(<unistd.h>)
#include <unistd.h>
#endif

/// \file
/// Files written as a whole or not at all.

namespace duet {

/// A file that cannot be used: `duet: path:line: reason`, on one line whatever it quotes.
class file_error : public invalid_input {
public:
  file_error(const std::string& path, const std::string& reason)
      : invalid_input(printable("duet: " + path + ": " + reason)) {}
  file_error(const std::string& path, std::size_t line, const std::string& reason)
      : file_error(path + ":" + std::to_string(line), reason) {}
};

namespace detail {

/// `path: cannot be written: reason`
[[nodiscard]] inline file_error cannot_write(const std::string& path, int error) {
  return {path, "cannot be written: " + std::generic_category().message(error)};
}

/// A stream of C, closed by the destructor.
class c_file {
public:
  c_file(const std::string& path, const char* mode) : file_(std::fopen(path.c_str(), mode)) {}
  c_file(const c_file&) = delete;
  c_file& operator=(const c_file&) = delete;
  ~c_file() { close(); }

  [[nodiscard]] bool is_open() const { return file_ != nullptr; }
  /// True if everything was written; otherwise errno gives the reason.
  [[nodiscard]] bool write(const std::string& content) {
    return std::fwrite(content.data(), 1, content.size(), file_) == content.size() &&
           std::fflush(file_) == 0;
  }
  /// \return true if there was no error
  bool close() {
    std::FILE* const file = std::exchange(file_, nullptr);
    return file == nullptr || std::fclose(file) == 0;
  }

private:
  std::FILE* file_;
};

/// True if a path leads to something that is neither a file nor a folder: a device, a pipe, a
/// socket.
[[nodiscard]] inline bool is_special_file(const std::string& path) {
  std::error_code ignored;
  const auto status = std::filesystem::status(path, ignored);
  return exists(status) && !is_regular_file(status) && !is_directory(status);
}

/// True if it is the file that standard output is redirected to, under any name. Replacing it would
/// lose the rest. For terminals and pipes `equivalent` may fail.
[[nodiscard]] inline bool is_standard_output(const std::string& path) {
  std::error_code ignored;
  return std::filesystem::equivalent(path, "/dev/stdout", ignored);
}

/// The file that a path leads to over all links, existing or not.
///
/// \throws file_error if it exists and is not a file, or may not be written
[[nodiscard]] inline std::filesystem::path link_target(const std::string& path) {
  constexpr int max_links = 40;
  std::filesystem::path result(path);
  std::error_code error;
  for (int links = 0; is_symlink(std::filesystem::symlink_status(result, error)); ++links) {
    if (links == max_links) {
      raise(cannot_write(path, ELOOP));
    }
    const std::filesystem::path next = std::filesystem::read_symlink(result, error);
    if (error) {
      raise(cannot_write(path, error.value()));
    }
    result = result.parent_path() / next;
  }
  const auto status = std::filesystem::status(result, error);
  if (!status_known(status)) {
    raise(cannot_write(path, error.value()));
  }
  if (exists(status)) {
    if (!is_regular_file(status)) {
      raise(is_directory(status) ? file_error(path, "is a folder, not a file")
                                 : cannot_write(path, EINVAL));
    }
    if (!c_file(result.string(), "r+b").is_open()) { // changes nothing
      raise(cannot_write(path, errno));
    }
  }
  return result;
}

/// Name of a draft, for signal handlers: these can neither lock nor allocate, and may run while
/// another thread finishes with the draft. Only the thread that has changed `owner` to `busy` uses
/// `name`.
struct registered_temporary {
  static constexpr unsigned long nobody = 0, busy = 1;
  static_assert(std::atomic<unsigned long>::is_always_lock_free);

  std::atomic<unsigned long> owner{nobody};
  std::array<char, 4096> name{}; ///< the maximum length of a path on Linux
};
inline constinit std::array<registered_temporary, 64> listed_drafts{};
inline std::atomic<unsigned long> last_draft{registered_temporary::busy};

} // namespace detail

/// Removes drafts: for the handler of a signal that ends the program. Signal-safe on POSIX.
inline void remove_drafts() noexcept {
  using detail::registered_temporary;
  for (registered_temporary& draft : detail::listed_drafts) {
    unsigned long owner = draft.owner.load();
    if (owner > registered_temporary::busy &&
        draft.owner.compare_exchange_strong(owner, registered_temporary::busy)) {
#if __has_include(<unistd.h>)
      ::unlink(draft.name.data()); // POSIX does not guarantee it for std::remove
#else
      std::remove(draft.name.data());
#endif
      draft.owner.store(registered_temporary::nobody);
    }
  }
}

/// A file under another name, in the same folder, until it is complete: `commit` then replaces the
/// target, with the permissions of the previous file. Without `commit` it is removed.
///
/// Links are followed, so that a link stays one.
class file_draft {
public:
  /// Creates the draft, an empty file.
  ///
  /// \throws file_error if the file cannot be written
  explicit file_draft(const std::string& path) : path_(path), target_(detail::link_target(path)) {
    using enum std::filesystem::perms;
    for (int number = 0;; ++number) {
      // Nobody else has this name: files are created, not opened.
      const auto time = std::chrono::system_clock::now().time_since_epoch().count();
      name_ = (target_.parent_path() /
               (".duet-" + std::to_string(time) + "-" + std::to_string(number) + ".part"))
                  .string();
      enlist(); // before it is created: a signal in between would leave it
      if (detail::c_file(name_, "wbx").is_open()) {
        // Users who may not read the file may not read its draft.
        if (const auto error = take_permissions(owner_read | owner_write)) {
          remove();
          detail::raise(detail::cannot_write(path, error.value()));
        }
        return;
      }
      const int error = errno;
      strike();
      if (error != EEXIST || number == 1000) {
        detail::raise(detail::cannot_write(path, error));
      }
    }
  }
  file_draft(const file_draft&) = delete;
  file_draft& operator=(const file_draft&) = delete;
  ~file_draft() {
    if (!name_.empty()) {
      remove();
    }
  }

  /// Path of the draft until it is committed.
  [[nodiscard]] const std::string& name() const { return name_; }

  /// Writes the whole content.
  ///
  /// \throws file_error
  void write(const std::string& content) const {
    detail::c_file out(name_, "wb");
    if (!out.is_open() || !out.write(content) || !out.close()) {
      detail::raise(detail::cannot_write(path_, errno));
    }
  }

  /// Replaces the target by the draft.
  ///
  /// \throws file_error
  void commit() {
    std::error_code error = take_permissions(std::filesystem::perms::none);
    if (!error) {
      std::filesystem::rename(name_, target_, error);
    }
    if (error) {
      detail::raise(detail::cannot_write(path_, error.value()));
    }
    strike();
    name_.clear();
  }

private:
  /// Sets the permissions of the existing file, if there is one, and these.
  [[nodiscard]] std::error_code take_permissions(std::filesystem::perms also) const {
    std::error_code error;
    const auto before = std::filesystem::status(target_, error);
    if (!exists(before)) {
      return {};
    }
    const auto wanted = before.permissions() | also;
    const auto now = std::filesystem::status(name_, error);
    if (!error && now.permissions() != wanted) { // some file systems have the same for all files
      std::filesystem::permissions(name_, wanted, error);
    }
    return error;
  }

  void enlist() {
    using detail::registered_temporary;
    id_ = ++detail::last_draft;
    for (registered_temporary& draft : detail::listed_drafts) {
      unsigned long owner = registered_temporary::nobody;
      if (name_.size() < draft.name.size() &&
          draft.owner.compare_exchange_strong(owner, registered_temporary::busy)) {
        *std::copy(name_.begin(), name_.end(), draft.name.begin()) = '\0';
        draft.owner.store(id_);
        return;
      }
    }
  }
  void strike() const {
    for (detail::registered_temporary& draft : detail::listed_drafts) {
      unsigned long mine = id_;
      if (draft.owner.compare_exchange_strong(mine, detail::registered_temporary::nobody)) {
        return;
      }
    }
  }
  void remove() const {
    std::remove(name_.c_str());
    strike();
  }

  std::string path_;
  std::filesystem::path target_;
  std::string name_;
  unsigned long id_ = 0; ///< unique number in the list of drafts
};

/// Checks before a computation that `write_file` could write its result; changes nothing.
///
/// \throws file_error
inline void require_writable(const std::string& path) {
  if (!detail::is_special_file(path) && !detail::is_standard_output(path)) {
    file_draft{path};
  }
}

/// Writes a whole file or nothing: a `file_draft`, which then replaces the file. Links are
/// followed; a device, a pipe or standard output is written directly.
///
/// \throws file_error
inline void write_file(const std::string& path, const std::string& content) {
  if (detail::is_standard_output(path)) {
    if (std::fwrite(content.data(), 1, content.size(), stdout) != content.size() ||
        std::fflush(stdout) != 0) {
      detail::raise(detail::cannot_write(path, errno));
    }
    return;
  }
  if (detail::is_special_file(path)) {
    std::fflush(stdout); // it may go there, too: earlier output comes first
    detail::c_file out(path, "wb");
    if (!out.is_open() || !out.write(content) || !out.close()) {
      detail::raise(detail::cannot_write(path, errno));
    }
    return;
  }
  file_draft draft(path);
  draft.write(content);
  draft.commit();
}

} // namespace duet
