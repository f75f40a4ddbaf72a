// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

/// \file
/// Checks a formula derived on paper: the body angular velocity of the rotation exp(φ),
///   ω = φ̇ − (1 − cos θ)/θ² φ × φ̇ + (θ − sin θ)/θ³ φ × (φ × φ̇),  θ = |φ|.

#include "support/program.hpp"

#include <duet/duet.hpp>
#include <duet/interop/multiprecision.hpp>

#include <iostream>

namespace {

int run() {
  using namespace duet;

  // The definition: the rotation as a function of time, differentiated.
  const auto automatic = [](const auto& phi, const auto& rate) {
    const auto moving = [&](auto t) { return from_rotation_vector((phi + t * rate).eval()); };
    const auto [q, q_dot] = derivative(moving, 0);
    return angular_velocity(q, q_dot, frame::body);
  };
  // The formula on paper, with either sign of the second term.
  const auto on_paper = [](int sign) {
    return [sign](const auto& phi, const auto& rate) {
      using std::cos, std::sin;
      const auto angle = phi.norm();
      const auto c = (1 - cos(angle)) / (angle * angle);
      const auto s = (angle - sin(angle)) / (angle * angle * angle);
      return (rate + sign * c * phi.cross(rate) + s * phi.cross(phi.cross(rate))).eval();
    };
  };

  const auto inputs = sampler(vectors<3>{3.0}, vectors<3>{1.0}).named("phi", "rate");
  for (const int sign : {+1, -1}) {
    const std::string label = sign > 0 ? "with a plus" : "with a minus";
    std::cout << to_text(compare<double, real_50>(label, automatic, on_paper(sign), inputs));
  }
  return 0;
}

} // namespace

int main() { return example::run_program("check_your_formula", run); }
