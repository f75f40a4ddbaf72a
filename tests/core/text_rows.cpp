// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/message.hpp"
#include "support/test.hpp"

#include <duet/core/text/csv.hpp>

#include <cstdio>
#include <filesystem>
#include <fstream>

namespace test_core_text_rows {
namespace {

using duet::csv_file;

const std::string path = "text_rows_test.csv";

void write(const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

std::string error_message(const std::string& file, std::size_t columns = 0) {
  return duet_test::message_of<duet::file_error>(
      [&] { static_cast<void>(csv_file(file, columns)); });
}

TEST_CASE("csv_file: reads headers, names, blanks, line ends and byte order marks") {
  write("\xef\xbb\xbfname , a [m],b\r\n\r\n# a comment\nfirst, 1 ,-2e3 # the "
        "rest\n\t3,+4,\nlast,5,6");
  const csv_file file(path);
  CHECK(file.header() == std::vector<std::string>{"name", "a [m]", "b"});
  CHECK(file.header_line() == 1);
  REQUIRE(file.rows().size() == 3);
  CHECK(file.rows()[0].line == 4);
  CHECK(file.rows()[0].name == "first");
  CHECK(file.rows()[0].numbers == std::vector<double>{1, -2e3});
  CHECK(file.rows()[1].numbers == std::vector<double>{3, 4});
  CHECK(file.rows()[2].numbers == std::vector<double>{5, 6});
  write("1 2\t3\n");
  CHECK(csv_file(path, 3).rows()[0].numbers == std::vector<double>{1, 2, 3});
  CHECK(csv_file(path).header().empty());
}

TEST_CASE("csv_file: reads cells separated by semicolons") {
  write("name; a [m, above];b;\r\nfirst; 1 ;-2e3;\nsecond, the last;3;4\n");
  const csv_file file(path);
  CHECK(file.header() == std::vector<std::string>{"name", "a [m, above]", "b"});
  REQUIRE(file.rows().size() == 2);
  CHECK(file.rows()[0].name == "first");
  CHECK(file.rows()[0].numbers == std::vector<double>{1, -2e3});
  CHECK(file.rows()[1].name == "second, the last");
  CHECK(file.rows()[1].numbers == std::vector<double>{3, 4});
}

TEST_CASE("csv_file: reads back headers with as many columns as were written") {
  for (const std::vector<std::string>& names : {std::vector<std::string>{"#", "a"},
                                                {"", ""},
                                                {"a", " "},
                                                {"1", "inf"},
                                                {"1e400", "+2"},
                                                {"a;b", ";"}}) {
    write(duet::csv_header(names) + "3,4\n");
    CAPTURE(duet::csv_header(names));
    const csv_file file(path);
    CHECK(file.header().size() == 2);
    CHECK(file.rows().size() == 1);
  }
  CHECK(duet::csv_header({"#", "a", "1"}) == "_,a,_1\n");
  CHECK(duet::csv_line({}) == "\n");
}

TEST_CASE("csv_file: an invalid file gives an error with line and reason") {
  CHECK(error_message("no/such/file") == "duet: no/such/file: cannot be read");
  CHECK(error_message(".") == "duet: .: is a folder, not a file");
  CHECK_THROWS_AS(static_cast<void>(csv_file(".")), duet::invalid_input); // as other bad input
  write("a,b\n");
  CHECK(error_message(path) == "duet: " + path + ": holds no rows");
  write("\xff\xfe"
        "1\n");
  CHECK(error_message(path) == "duet: " + path + ": is UTF-16 (expected UTF-8)");
  write("1,2\n" + std::string(2'000'000, '1'));
  CHECK(error_message(path) ==
        "duet: " + path + ":2: the line has more than a million characters (expected a table)");
  write("1,1e400\n");
  CHECK(error_message(path) ==
        "duet: " + path + ":1: column 2 is 1e400, beyond the range of a double");
  write("1,-1e-400\n");
  CHECK(error_message(path) ==
        "duet: " + path + ":1: column 2 is -1e-400, beyond the range of a double");
  write("1,inf\n");
  CHECK(error_message(path) == "duet: " + path + ":1: column 2 is inf");
  write("1,2\n1,2,3\n");
  CHECK(error_message(path, 2) == "duet: " + path + ":2: 2 numbers expected, got 3");
  // Decimal commas, which are neither names nor a header.
  for (const char* text : {"1,2;3\n", "1,5;2,5\n", "+1,5e3;1\n"}) {
    write(text);
    CHECK(error_message(path).starts_with("duet: " + path + ":1: column 1 is not a number: '"));
    CHECK(error_message(path).ends_with("' (expected a decimal point, not a comma)"));
  }
  write("1;2\n3;1,2,3\n");
  CHECK(error_message(path) == "duet: " + path + ":2: column 2 is not a number: '1,2,3'");
  std::remove(path.c_str());
}

} // namespace
} // namespace test_core_text_rows
