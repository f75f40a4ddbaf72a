// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// A program that links no library: duet::duet.

#include <duet/duet.hpp>

#include <iostream>

int main() {
  const auto x = duet::dual<double>::variable(3.0);
  std::cout << "duet " << DUET_VERSION_STRING << ": d(x²)/dx at 3 is " << (x * x).epsilon() << '\n';
  return (x * x).epsilon() == 6.0 ? 0 : 1;
}
