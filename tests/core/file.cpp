// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/message.hpp"
#include "support/test.hpp"

#include <duet/core/text/file.hpp>

#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sys/resource.h>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>

namespace test_core_file {
namespace {

namespace fs = std::filesystem;
using duet::write_file, duet::detail::temporary_file;

/// A separate folder, created empty and removed at the end.
class playground {
public:
  explicit playground(const char* name)
      : path_(fs::absolute(std::string("test_core_file_") + name)) {
    fs::remove_all(path_);
    fs::create_directories(path_);
  }
  ~playground() { fs::remove_all(path_); }
  [[nodiscard]] std::string at(const std::string& name) const { return path_ / name; }
  /// Number of entries in the folder, temporary files included.
  [[nodiscard]] auto count() const {
    return std::distance(fs::directory_iterator(path_), fs::directory_iterator());
  }

private:
  fs::path path_;
};

std::string content_of(const std::string& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string message(const std::string& path) {
  return duet_test::message_of<duet::file_error>([&] { write_file(path, "x"); });
}

TEST_CASE("write_file: replaces the complete file and keeps its permissions") {
  const playground folder("whole");
  const std::string path = folder.at("a.csv");
  write_file(path, "first\n");
  CHECK(content_of(path) == "first\n");
  fs::permissions(path, fs::perms(0600));
  write_file(path, std::string(100000, 'x'));
  CHECK(content_of(path) == std::string(100000, 'x'));
  CHECK(fs::status(path).permissions() == fs::perms(0600));
  write_file(path, "");
  CHECK(content_of(path).empty());
  CHECK(folder.count() == 1);
}

TEST_CASE("temporary_file: has the permissions of the target, so nobody else may read it") {
  const playground folder("private");
  const std::string path = folder.at("a.csv");
  write_file(path, "first\n");
  for (const auto permissions : {fs::perms(0600), fs::perms(0666)}) {
    fs::permissions(path, permissions);
    temporary_file temporary(path);
    CHECK(fs::status(temporary.name()).permissions() == permissions);
    temporary.write("second\n");
    temporary.replace_target();
    CHECK(fs::status(path).permissions() == permissions);
  }
}

TEST_CASE("write_file: text printed to a pipe precedes text written to it by name") {
  if (!fs::exists("/dev/stdout")) {
    MESSAGE("not tested: standard output has no name");
    return;
  }
  std::fflush(stdout);
  std::array<int, 2> ends{};
  const int before = dup(STDOUT_FILENO);
  REQUIRE(before >= 0);
  REQUIRE(pipe(ends.data()) == 0);
  REQUIRE(dup2(ends[1], STDOUT_FILENO) >= 0);
  std::printf("printed ");
  const std::string error = message("/dev/stdout");
  std::fflush(stdout);
  dup2(before, STDOUT_FILENO);
  close(before);
  close(ends[1]);
  std::array<char, 64> text{};
  CHECK(read(ends[0], text.data(), text.size() - 1) > 0);
  close(ends[0]);
  CHECK(error.empty());
  CHECK(std::string(text.data()) == "printed x");
}

TEST_CASE("temporary_file: not renamed, it is removed and the target keeps its content") {
  const playground folder("temporary");
  const std::string path = folder.at("a.csv");
  write_file(path, "first\n");
  {
    temporary_file temporary(path);
    temporary.write("second\n");
    CHECK(folder.count() == 2);
    CHECK(content_of(temporary.name()) == "second\n");
  }
  CHECK(folder.count() == 1);
  // Somebody else removes it before it is renamed.
  temporary_file temporary(path);
  temporary.write("second\n");
  fs::remove(temporary.name());
  CHECK_THROWS_AS(temporary.replace_target(), duet::file_error);
  CHECK(content_of(path) == "first\n");
}

TEST_CASE("temporary_file: a target that becomes a folder is an error and leaves no other file") {
  const playground folder("late");
  const std::string path = folder.at("late.csv");
  {
    temporary_file temporary(path);
    temporary.write("1\n");
    fs::create_directory(path);
    CHECK(duet_test::message_of<duet::file_error>([&] { temporary.replace_target(); }) ==
          "duet: " + path + ": cannot be written: Is a directory");
  }
  CHECK(fs::is_directory(path));
  CHECK(folder.count() == 1);
}

TEST_CASE("write_file: content that does not fit leaves the previous file and no other") {
  const playground folder("large");
  const std::string path = folder.at("a.csv");
  write_file(path, "first\n");
  rlimit before{};
  REQUIRE(getrlimit(RLIMIT_FSIZE, &before) == 0);
  rlimit limit = before;
  limit.rlim_cur = 4096;
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  REQUIRE(setrlimit(RLIMIT_FSIZE, &limit) == 0);
  const std::string error =
      duet_test::message_of<duet::file_error>([&] { write_file(path, std::string(100000, 'x')); });
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  CHECK(error == "duet: " + path + ": cannot be written: File too large");
  CHECK(content_of(path) == "first\n");
  CHECK(folder.count() == 1);
}

TEST_CASE("write_file: concurrent writers of one file do not mix their contents") {
  const playground folder("writers");
  const std::string path = folder.at("a.csv");
  const std::string a(200000, 'a'), b(100000, 'b');
  const auto write_often = [&](const std::string& text) {
    for (int i = 0; i < 20; ++i) {
      write_file(path, text);
    }
  };
  std::thread other([&] { write_often(a); });
  write_often(b);
  const std::string content = content_of(path);
  CHECK((content == a || content == b));
  other.join();
  CHECK(folder.count() == 1);
}

TEST_CASE("write_file: links are followed and stay links") {
  const playground folder("links");
  fs::create_directory(folder.at("far"));
  write_file(folder.at("far/a.csv"), "first\n");
  fs::create_symlink("a.csv", folder.at("far/second"));
  fs::create_symlink("far/second", folder.at("link"));
  write_file(folder.at("link"), "second\n");
  CHECK(fs::is_symlink(folder.at("link")));
  CHECK(fs::is_symlink(folder.at("far/second")));
  CHECK(content_of(folder.at("far/a.csv")) == "second\n");
  // A link to a file that does not exist yet.
  fs::create_symlink(folder.at("far/new.csv"), folder.at("dangling"));
  duet::require_writable(folder.at("dangling"));
  CHECK(!fs::exists(folder.at("far/new.csv")));
  write_file(folder.at("dangling"), "new\n");
  CHECK(fs::is_symlink(folder.at("dangling")));
  CHECK(content_of(folder.at("far/new.csv")) == "new\n");
  CHECK(folder.count() == 3);
  // A link into a missing folder, and a circular link.
  fs::create_symlink("none/new.csv", folder.at("nowhere"));
  CHECK(message(folder.at("nowhere")) ==
        "duet: " + folder.at("nowhere") + ": cannot be written: No such file or directory");
  fs::create_symlink("round", folder.at("round"));
  CHECK(message(folder.at("round")).find("round: cannot be written: ") != std::string::npos);
}

TEST_CASE("write_file: devices and pipes are written to directly and remain") {
  const playground folder("special");
  const std::string pipe = folder.at("pipe");
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  duet::require_writable(pipe); // does not wait for a reader
  std::string received;
  std::thread reader([&] { received = content_of(pipe); });
  write_file(pipe, "through\n");
  reader.join();
  CHECK(received == "through\n");
  CHECK(fs::is_fifo(pipe));
  CHECK(folder.count() == 1);

  if (fs::is_character_file("/dev/full") && fs::is_character_file("/dev/null")) {
    write_file("/dev/null", "gone\n");
    CHECK(message("/dev/full") == "duet: /dev/full: cannot be written: No space left on device");
    fs::create_symlink("/dev/full", folder.at("full"));
    CHECK(message(folder.at("full")) ==
          "duet: " + folder.at("full") + ": cannot be written: No space left on device");
    CHECK(fs::is_character_file("/dev/full"));
    CHECK(fs::is_character_file("/dev/null"));
  }
}

TEST_CASE("require_writable: reports the error that write_file would report, without any change") {
  const playground folder("errors");
  const auto check_message = [](const std::string& path) {
    return duet_test::message_of<duet::file_error>([&] { duet::require_writable(path); });
  };
  CHECK(check_message(folder.at("a.csv")).empty());
  for (const auto& [path, reason] :
       {std::pair(folder.at("none/a.csv"), "No such file or directory"),
        std::pair(folder.at(std::string(300, 'x')), "File name too long")}) {
    CHECK(check_message(path) == message(path));
    CHECK(message(path) == "duet: " + path + ": cannot be written: " + reason);
  }
  CHECK(check_message(folder.at("")) == "duet: " + folder.at("") + ": is a folder, not a file");
  CHECK(message(folder.at("")) == check_message(folder.at("")));
  CHECK(folder.count() == 0);
  CHECK(message(folder.at("none\n\x1b[2J/a.csv")) ==
        "duet: " + folder.at("none\\n\\x1b[2J/a.csv") +
            ": cannot be written: No such file or directory");
}

TEST_CASE("write_file: missing permissions for files and folders are errors") {
  if (geteuid() == 0) {
    MESSAGE("not tested: root may write everywhere");
    return;
  }
  const playground folder("permissions");
  const std::string path = folder.at("a.csv");
  write_file(path, "first\n");
  fs::permissions(path, fs::perms(0400));
  CHECK(message(path) == "duet: " + path + ": cannot be written: Permission denied");
  fs::permissions(path, fs::perms(0600));
  fs::permissions(folder.at(""), fs::perms(0500));
  CHECK(message(path) == "duet: " + path + ": cannot be written: Permission denied");
  CHECK(message(folder.at("new.csv")).find("Permission denied") != std::string::npos);
  fs::permissions(folder.at(""), fs::perms(0700));
  CHECK(content_of(path) == "first\n");
  CHECK(folder.count() == 1);
}

} // namespace
} // namespace test_core_file
