// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include <duet/core/text/file_error.hpp>
#include <duet/io/srdf.hpp>

#include "xml.hpp"

#include <string>
#include <vector>

namespace duet {
DUET_ABI_BEGIN

std::vector<link_pair> read_disabled_collisions(const std::string& path) {
  using detail::xml_element;
  const xml_element robot = detail::read_xml(path);
  const auto fail = [&](const xml_element& in, const std::string& what) {
    detail::raise(file_error(path, in.line, what));
  };
  if (robot.name != "robot") {
    fail(robot, "the root is <" + robot.name + "> (expected <robot>)");
  }
  std::vector<link_pair> result;
  for (const xml_element& each : robot.children) {
    if (each.name == "enable_collisions" || each.name == "disable_default_collisions") {
      fail(each, "<" + each.name + "> is not supported");
    }
    if (each.name != "disable_collisions") {
      continue;
    }
    for (const auto& [key, value] : each.attributes) {
      if (key != "link1" && key != "link2" && key != "reason") {
        fail(each, "<disable_collisions>: unknown attribute \"" + key +
                       "\": there are \"link1\", \"link2\" and \"reason\"");
      }
    }
    for (const char* key : {"link1", "link2"}) {
      if (each.attribute(key) == nullptr) {
        fail(each, std::string("<disable_collisions>: no attribute \"") + key + "\"");
      }
      if (each.attribute(key)->empty()) {
        fail(each, std::string("<disable_collisions>: ") + key + "=\"\" is empty");
      }
    }
    if (*each.attribute("link1") == *each.attribute("link2")) {
      fail(each,
           "<disable_collisions>: link1 and link2 are both \"" + *each.attribute("link1") + "\"");
    }
    result.push_back({*each.attribute("link1"), *each.attribute("link2")});
  }
  return result;
}

DUET_ABI_END
} // namespace duet
