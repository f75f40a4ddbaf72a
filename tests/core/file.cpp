// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/message.hpp"

#include <duet/core/text/file.hpp>
#include <duet/core/text/file_pair.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <sys/stat.h>
#include <unistd.h>

namespace test_core_file {
namespace {

namespace fs = std::filesystem;
using duet::write_file;

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
  /// Number of entries in the folder, drafts included.
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

} // namespace

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

TEST_CASE("file_draft: has the permissions of the file, so nobody else may read it") {
  const playground folder("private");
  const std::string path = folder.at("a.csv");
  write_file(path, "first\n");
  for (const auto permissions : {fs::perms(0600), fs::perms(0666)}) {
    fs::permissions(path, permissions);
    duet::file_draft draft(path);
    CHECK(fs::status(draft.name()).permissions() == permissions);
    draft.write("second\n");
    draft.commit();
    CHECK(fs::status(path).permissions() == permissions);
  }
}

TEST_CASE("remove_drafts: works while another thread creates and removes drafts") {
  const playground folder("many");
  std::thread other([&] {
    for (int i = 0; i < 200; ++i) {
      const duet::file_draft draft(folder.at("a.csv"));
    }
  });
  for (int i = 0; i < 200; ++i) {
    duet::remove_drafts();
  }
  other.join();
  { // more drafts than the list holds; destructors then empty the list
    std::vector<std::unique_ptr<duet::file_draft>> drafts;
    for (int i = 0; i < 100; ++i) {
      drafts.push_back(std::make_unique<duet::file_draft>(folder.at("a.csv")));
    }
    CHECK(folder.count() == 100);
    duet::remove_drafts();
    CHECK(folder.count() == 100 - 64);
  }
  CHECK(folder.count() == 0);
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

TEST_CASE("file_draft: without commit the target keeps its content") {
  const playground folder("draft");
  const std::string path = folder.at("a.csv");
  write_file(path, "first\n");
  {
    const duet::file_draft draft(path);
    draft.write("second\n");
    CHECK(folder.count() == 2);
    CHECK(content_of(draft.name()) == "second\n");
  }
  CHECK(folder.count() == 1);
  // A signal before `commit` also keeps the content of the target.
  duet::file_draft draft(path);
  draft.write("second\n");
  duet::remove_drafts();
  CHECK(folder.count() == 1);
  CHECK_THROWS_AS(draft.commit(), duet::file_error);
  CHECK(content_of(path) == "first\n");
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

TEST_CASE("write_files: writes both files or neither") {
  const playground folder("pair");
  const std::string a = folder.at("a.csv"), b = folder.at("b.csv");
  const auto error_message = [](const std::string& first, const std::string& second) {
    return duet_test::message_of<duet::file_error>(
        [&] { duet::write_files(first, "1\n", second, "2\n"); });
  };
  CHECK(error_message(a, b).empty());
  CHECK(content_of(a) == "1\n");
  CHECK(content_of(b) == "2\n");
  write_file(a, "before\n");
  const std::string far = folder.at("none/b.csv");
  CHECK(error_message(a, far) == "duet: " + far + ": cannot be written: No such file or directory");
  CHECK(error_message(far, a) == error_message(a, far));
  CHECK(error_message(a, folder.at("./a.csv")) ==
        "duet: " + folder.at("./a.csv") + ": is the same file as " + a);
  fs::create_symlink("a.csv", folder.at("link"));
  CHECK(error_message(folder.at("link"), a) ==
        "duet: " + a + ": is the same file as " + folder.at("link"));
  const std::string none = folder.at("new.csv"); // not there yet
  CHECK(error_message(none, folder.at("./new.csv")).ends_with(": is the same file as " + none));
  CHECK(content_of(a) == "before\n");
  CHECK(folder.count() == 3);

  // The second target is a folder by the time it is replaced.
  for (const std::string& first : {a, none, folder.at("link")}) {
    const std::string second = folder.at("late.csv");
    {
      duet::file_draft one(first), two(second);
      one.write("1\n");
      two.write("2\n");
      fs::create_directory(second);
      CHECK(duet_test::message_of<duet::file_error>([&] {
              duet::detail::commit_both(first, one, two);
            }) == "duet: " + second + ": cannot be written: Is a directory");
    }
    fs::remove(second);
    CHECK(content_of(a) == "before\n");
    CHECK(fs::is_symlink(folder.at("link")));
    CHECK(folder.count() == 3);
  }

  if (fs::is_character_file("/dev/full") && fs::is_character_file("/dev/null")) {
    CHECK(error_message("/dev/full", a) == message("/dev/full"));
    CHECK(error_message(a, "/dev/full") == message("/dev/full"));
    CHECK(content_of(a) == "before\n");
    CHECK(error_message("/dev/null", "/dev/null").empty());
    CHECK(error_message("/dev/null", a).empty());
    CHECK(content_of(a) == "2\n");
  }
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

} // namespace test_core_file
