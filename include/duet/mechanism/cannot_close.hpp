// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>

#include <string>
#include <utility>
#include <vector>

/// \file
/// The error of mechanisms with loops.

namespace duet {

/// A closed loop that has no position where one was asked for.
class cannot_close : public no_convergence {
public:
  cannot_close(const std::string& message, std::vector<double> parameter)
      : no_convergence(message), parameter_(std::move(parameter)) {}

  /// The driving parameters at which it closed last, or was to close first.
  [[nodiscard]] const std::vector<double>& parameter() const { return parameter_; }

private:
  std::vector<double> parameter_;
};

} // namespace duet
