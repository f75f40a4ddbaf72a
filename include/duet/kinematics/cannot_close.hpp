// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>

#include <string>
#include <utility>
#include <vector>

/// \file
/// The error of closed-chain mechanisms.

namespace duet {

/// Loop-closure failure: a closed chain has no configuration at the requested parameters.
class loop_closure_failure : public no_convergence {
public:
  loop_closure_failure(const std::string& message, std::vector<double> parameter)
      : no_convergence(message), parameter_(std::move(parameter)) {}

  /// The driving parameters at which the loops closed last, or were to close first.
  [[nodiscard]] const std::vector<double>& parameter() const { return parameter_; }

private:
  std::vector<double> parameter_;
};

} // namespace duet
