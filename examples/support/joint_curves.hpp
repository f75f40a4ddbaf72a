// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "curves.hpp"

#include <duet/core/text/number_text.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <string>
#include <vector>

/// \file
/// Curves of the joints of an arm: the four that move most in colours, with names; the others pale.

namespace example {

class joint_curves {
public:
  /// \param path  the coordinates, from the first to the last
  template <class Joints>
  explicit joint_curves(const std::vector<Joints>& path)
      : low_(path.front()), high_(path.front()), last_(path.back()) {
    for (const Joints& theta : path) {
      low_ = low_.cwiseMin(theta);
      high_ = high_.cwiseMax(theta);
    }
    std::vector<int> order(std::size_t(low_.size()));
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](int a, int b) { return high_[a] - low_[a] > high_[b] - low_[b]; });
    order.resize(std::min<std::size_t>(order.size(), 4));
    named_ = order;
  }

  /// Plots the columns of a table from `first` on, a joint each, over its first column.
  [[nodiscard]] std::string plot(const std::string& file, int first) const {
    std::vector<named_line> lines;
    const auto column = [&](int i) { return "1:" + std::to_string(first + i); };
    for (std::size_t k = 0; k < named_.size(); ++k) {
      lines.push_back({column(named_[k]), colours[k], ""});
    }
    for (int i = 0; i < int(low_.size()); ++i) {
      if (std::find(named_.begin(), named_.end(), i) == named_.end()) {
        lines.push_back({column(i), "pale", ""});
      }
    }
    return plot_command(file, lines);
  }

  /// The names to the right of the last coordinates, without overlaps.
  [[nodiscard]] std::string names() const {
    std::vector<std::size_t> by_end(named_.size());
    std::iota(by_end.begin(), by_end.end(), std::size_t(0));
    std::sort(by_end.begin(), by_end.end(),
              [&](std::size_t a, std::size_t b) { return last_[named_[a]] < last_[named_[b]]; });
    const double spacing = .11 * (high_.maxCoeff() - low_.minCoeff());
    std::string text;
    double free = low_.minCoeff();
    for (const std::size_t k : by_end) {
      const double y = std::max(free, last_[named_[k]]);
      text += "set label 'joint " + std::to_string(named_[k]) + "' at graph 1.015, first " +
              duet::to_text(y) + " tc rgb " + colours[k] + "\n";
      free = y + spacing;
    }
    return text;
  }

private:
  static constexpr const char* colours[] = {"blue", "vermillion", "green", "purple"};

  Eigen::VectorXd low_, high_, last_;
  std::vector<int> named_;
};

} // namespace example
