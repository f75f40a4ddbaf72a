// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/text/file.hpp>

#include <filesystem>
#include <string>
#include <system_error>

/// \file
/// Two files written together.

namespace duet {
namespace detail {

/// Replaces two targets by their drafts. If the second cannot be replaced, the previous file of the
/// first, at `path`, is restored.
///
/// \throws file_error
inline void commit_both(const std::string& path, file_draft& first, file_draft& second) {
  namespace fs = std::filesystem;
  const fs::path target = link_target(path);
  file_draft before(path);
  std::error_code error;
  const bool existed = exists(fs::status(target, error));
  if (existed) {
    fs::copy_file(target, before.name(), fs::copy_options::overwrite_existing, error);
    if (error) {
      raise(cannot_write(path, error.value()));
    }
  }
  first.commit();
  catching<void>([&] { second.commit(); },
                 [&] {
                   if (existed) {
                     before.commit();
                   } else {
                     fs::remove(target, error);
                   }
                   raise_again();
                 });
}

} // namespace detail

/// Writes two files, each as a whole, or neither of them. (Output to devices and pipes cannot be
/// taken back: it is written after the drafts of others, and of two of them the first before the
/// second.)
///
/// \throws file_error, also for two names of one file
inline void write_files(const std::string& first, const std::string& first_content,
                        const std::string& second, const std::string& second_content) {
  const auto is_direct = [](const std::string& path) {
    return detail::is_special_file(path) || detail::is_standard_output(path);
  };
  if (is_direct(first)) {
    if (is_direct(second)) {
      write_file(first, first_content);
      write_file(second, second_content);
    } else {
      write_files(second, second_content, first, first_content);
    }
    return;
  }
  file_draft draft(first);
  draft.write(first_content);
  if (is_direct(second)) {
    write_file(second, second_content);
    draft.commit();
    return;
  }
  const auto real_path = [](const std::string& path) {
    return std::filesystem::weakly_canonical(detail::link_target(path));
  };
  file_draft other(second);
  if (real_path(first) == real_path(second)) {
    detail::raise(file_error(second, "is the same file as " + first));
  }
  other.write(second_content);
  detail::commit_both(first, draft, other);
}

} // namespace duet
