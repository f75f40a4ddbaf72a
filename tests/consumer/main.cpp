// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include <duet/duet.hpp>
#include <duet/io/urdf.hpp>

#include <fstream>
#include <iostream>

int main() {
  const auto x = duet::dual<double>::variable(3.0);
  std::cout << "duet " << DUET_VERSION_STRING << ": d(x²)/dx at 3 is " << (x * x).epsilon() << '\n';
  std::ofstream("consumer.urdf") << R"(<robot name="r"><link name="base"/></robot>)";
  const auto names = duet::read_urdf_summary("consumer.urdf");
  return (x * x).epsilon() == 6.0 && names.links.size() == 1 ? 0 : 1;
}
