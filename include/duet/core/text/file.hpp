// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/text/file_error.hpp>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <utility>

/// \file
/// Files written as a whole or not at all.

namespace duet {

namespace detail {

/// `path: cannot be written: reason`
[[nodiscard]] inline file_error cannot_write(const std::string& path, int error) {
  return {path, "cannot be written: " + std::generic_category().message(error)};
}

struct closing {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
/// A stream of C, closed by the destructor.
using c_file = std::unique_ptr<std::FILE, closing>;
[[nodiscard]] inline c_file opened(const std::string& path, const char* mode) {
  return c_file(std::fopen(path.c_str(), mode));
}

/// \param path  name for messages
/// \throws file_error if the stream is not open or not everything can be written
inline void write_and_close(const std::string& path, c_file file, const std::string& content) {
  if (!file || std::fwrite(content.data(), 1, content.size(), file.get()) != content.size() ||
      std::fflush(file.get()) != 0 || std::fclose(file.release()) != 0) {
    raise(cannot_write(path, errno));
  }
}

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

/// True if replacing a file by another one is impossible, or would lose the rest of the output.
[[nodiscard]] inline bool is_written_directly(const std::string& path) {
  return is_special_file(path) || is_standard_output(path);
}

/// The file that a path leads to over all links, existing or not.
///
/// \throws file_error if it exists and is not a file, or may not be written
[[nodiscard]] inline std::filesystem::path link_target(const std::string& path) {
  constexpr int max_links = 40; // `status` reports longer and circular sequences
  std::filesystem::path result(path);
  std::error_code error;
  for (int links = 0; links < max_links && is_symlink(symlink_status(result, error)); ++links) {
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
    if (!opened(result.string(), "r+b")) { // changes nothing
      raise(cannot_write(path, errno));
    }
  }
  return result;
}

/// A new file beside a target, with the permissions of an existing target: who may not read the
/// target may not read the new content. The destructor removes it unless it has replaced the
/// target.
class temporary_file {
public:
  /// Creates the empty file.
  ///
  /// \throws file_error if the target cannot be written
  explicit temporary_file(const std::string& path) : path_(path), target_(link_target(path)) {
    const auto time = std::chrono::system_clock::now().time_since_epoch().count();
    for (int number = 0; !file_; ++number) {
      name_ = (target_.parent_path() /
               (".duet-" + std::to_string(time) + "-" + std::to_string(number) + ".part"))
                  .string();
      file_ = opened(name_, "wbx"); // fails if another writer has this name
      if (!file_ && (errno != EEXIST || number == 1000)) {
        raise(cannot_write(path, errno));
      }
    }
    if (const auto error = copy_permissions()) {
      remove();
      raise(cannot_write(path, error.value()));
    }
  }
  temporary_file(const temporary_file&) = delete;
  temporary_file& operator=(const temporary_file&) = delete;
  ~temporary_file() {
    if (!name_.empty()) {
      remove();
    }
  }

  [[nodiscard]] const std::string& name() const { return name_; }

  /// Writes the content and closes the file.
  ///
  /// \throws file_error
  void write(const std::string& content) { write_and_close(path_, std::move(file_), content); }

  /// Renames the written file to its target.
  ///
  /// \throws file_error
  void replace_target() {
    std::error_code error;
    std::filesystem::rename(name_, target_, error);
    if (error) {
      raise(cannot_write(path_, error.value()));
    }
    name_.clear();
  }

private:
  [[nodiscard]] std::error_code copy_permissions() const {
    std::error_code error;
    const auto wanted = std::filesystem::status(target_, error);
    if (!exists(wanted)) {
      return {};
    }
    const auto now = std::filesystem::status(name_, error);
    if (!error && now.permissions() != wanted.permissions()) { // equal on some file systems
      std::filesystem::permissions(name_, wanted.permissions(), error);
    }
    return error;
  }
  void remove() {
    file_.reset();
    std::remove(name_.c_str());
  }

  std::string path_;
  std::filesystem::path target_;
  std::string name_; ///< empty after the file has replaced its target
  c_file file_;
};

} // namespace detail

/// Checks before a computation that `write_file` could write its result; changes nothing.
///
/// \throws file_error
inline void require_writable(const std::string& path) {
  if (!detail::is_written_directly(path)) {
    detail::temporary_file{path};
  }
}

/// Writes a whole file or nothing: a temporary file in the same folder, with the permissions of the
/// previous file, replaces it when complete. Links are followed; a device, a pipe or standard
/// output is written directly. If the program is killed, the temporary file `.duet-….part` may
/// remain.
///
/// \throws file_error with the path and the reason; the previous file is then unchanged
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
    detail::write_and_close(path, detail::opened(path, "wb"), content);
    return;
  }
  detail::temporary_file temporary(path);
  temporary.write(content);
  temporary.replace_target();
}

} // namespace duet
