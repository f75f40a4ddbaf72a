// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include <duet/dual/dual.hpp>
#include <duet/io/loop_file.hpp>

double first_partial(const duet::dual<double, 4>& x);

int main() {
  return int(first_partial(duet::dual<double, 4>::variable(1.0))) -
         int(duet::read_loops("file").loops.size());
}
