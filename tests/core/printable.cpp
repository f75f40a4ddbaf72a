// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/test.hpp"

#include <duet/core/text/printable.hpp>

namespace test_core_printable {

using duet::printable;

TEST_CASE("printable: plain text is unchanged") {
  CHECK(printable("").empty());
  for (const std::string text : {"out/a b.csv: 3 \"x\" \\ ~", "Größe ½ m", "日本語", "\U0001F916",
                                 "\u00a0 \u2027 \u202f", "\uffff", "\U0010ffff"}) {
    CHECK(printable(text) == text);
  }
}

TEST_CASE("printable: terminal control characters are escaped") {
  CHECK(printable("a\nb\tc\rd") == "a\\nb\\tc\\rd");
  CHECK(printable("\x1b[2J\x07\x7f") == "\\x1b[2J\\x07\\x7f");
  CHECK(printable(std::string("a\0b", 3)) == "a\\x00b");
  CHECK(printable("\u009b2J \u0085") == "\\xc2\\x9b2J \\xc2\\x85"); // C1, of eight bits
  CHECK(printable("\u202e \u2066 \u2028") ==
        "\\xe2\\x80\\xae \\xe2\\x81\\xa6 \\xe2\\x80\\xa8"); // direction, separator of lines
  CHECK(printable("\u061c \u200e \u200f") ==
        "\\xd8\\x9c \\xe2\\x80\\x8e \\xe2\\x80\\x8f"); // direction
}

TEST_CASE("printable: bytes that are not UTF-8 are escaped") {
  CHECK(printable("\x9b"
                  "2J") == "\\x9b2J");
  CHECK(printable("a\xc3") == "a\\xc3"); // cut off
  CHECK(printable("\xe2\x80") == "\\xe2\\x80");
  CHECK(printable("\xc3\x28") == "\\xc3(");     // not continued
  CHECK(printable("\xc0\x8a") == "\\xc0\\x8a"); // a longer way to write \n
  CHECK(printable("\xe0\x80\x8a") == "\\xe0\\x80\\x8a");
  CHECK(printable("\xf0\x80\x80\x8a") == "\\xf0\\x80\\x80\\x8a");
  CHECK(printable("\xed\xa0\x80") == "\\xed\\xa0\\x80"); // a surrogate
  CHECK(printable("\xf4\x90\x80\x80") == "\\xf4\\x90\\x80\\x80");
  CHECK(printable("\xff\xfe") == "\\xff\\xfe");
}

TEST_CASE("printable: long text is shortened in the middle") {
  const std::string text = "begin" + std::string(1000000, 'x') + "end";
  const std::string shown = printable(text);
  CHECK(shown.size() == 1005);
  CHECK(shown.starts_with("beginxx"));
  CHECK(shown.ends_with("xxend"));
  CHECK(printable(std::string(1000, 'x')) == std::string(1000, 'x'));
}

} // namespace test_core_printable
