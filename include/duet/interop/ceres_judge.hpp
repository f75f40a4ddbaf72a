// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/comparison/domain.hpp>
#include <duet/comparison/judge_jacobian.hpp>
#include <duet/comparison/numeric_derivative.hpp>
#include <duet/comparison/sampler.hpp>
#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/interop/ceres.hpp>

#include <ceres/cost_function.h>
#include <ceres/manifold.h>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

/// \file
/// Judge of the Jacobians of a cost function of Ceres, and of its manifolds.

namespace duet {

namespace detail {
DUET_ABI_BEGIN

/// A cost function of Ceres as a function of the objects in its parameter blocks.
template <class Blocks, class... X>
class ceres_function {
public:
  ceres_function(const ceres::CostFunction& f, const Blocks& blocks) : f_(f), blocks_(blocks) {
    const auto& sizes = f.parameter_block_sizes();
    const std::array<int, sizeof...(X)> expected =
        std::apply([](const auto&... b) { return std::array{int(b.size)...}; }, blocks);
    require(sizes.size() == sizeof...(X), "duet: judge_jacobian: the cost function has ",
            sizes.size(), " parameter blocks (expected ", sizeof...(X), ")");
    for (std::size_t k = 0; k < sizeof...(X); ++k) {
      require(sizes[k] == expected[k], "duet: judge_jacobian: parameter block ", k, " has ",
              sizes[k], " numbers (expected ", expected[k], ")");
    }
  }

  /// Residuals.
  Eigen::VectorXd operator()(const X&... x) const { return evaluated(x...).first; }

  /// Residuals, and their Jacobians by all numbers side by side.
  [[nodiscard]] std::pair<Eigen::VectorXd, Eigen::MatrixXd> evaluated(const X&... x) const {
    std::vector<std::vector<double>> numbers = stored(x...);
    return evaluated(numbers);
  }
  [[nodiscard]] std::pair<Eigen::VectorXd, Eigen::MatrixXd>
  evaluated(const std::vector<std::vector<double>>& numbers) const {
    const Eigen::Index rows = f_.num_residuals();
    Eigen::VectorXd residuals(rows);
    std::vector<std::vector<double>> jacobians;
    std::vector<const double*> parameters;
    std::vector<double*> pointers;
    Eigen::Index columns = 0;
    for (const std::vector<double>& block : numbers) {
      parameters.push_back(block.data());
      jacobians.emplace_back(std::size_t(rows) * block.size());
      columns += Eigen::Index(block.size());
    }
    for (std::vector<double>& j : jacobians) {
      pointers.push_back(j.data());
    }
    if (!f_.Evaluate(parameters.data(), residuals.data(), pointers.data())) {
      raise(invalid_input("duet: judge_jacobian: Evaluate returned false (exclude such inputs by "
                          "sampler::where)"));
    }
    Eigen::MatrixXd all(rows, columns);
    Eigen::Index first = 0;
    for (const std::vector<double>& j : jacobians) {
      const Eigen::Index size = Eigen::Index(j.size()) / rows;
      all.middleCols(first, size) =
          Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
              j.data(), rows, size);
      first += size;
    }
    return {residuals, all};
  }

  /// The numbers of all blocks.
  [[nodiscard]] std::vector<std::vector<double>> stored(const X&... x) const {
    return std::apply([&](const auto&... block) { return std::vector{numbers_of(block, x)...}; },
                      blocks_);
  }

private:
  template <class Block, class Value>
  [[nodiscard]] static std::vector<double> numbers_of(const Block& block, const Value& x) {
    std::vector<double> numbers(std::size_t(block.size));
    if constexpr (requires { block.store(x, numbers.data()); }) {
      block.store(x, numbers.data());
    } else if constexpr (std::is_same_v<Value, double>) {
      numbers[0] = x;
    } else {
      std::copy_n(x.data(), x.size(), numbers.begin());
    }
    return numbers;
  }

  const ceres::CostFunction& f_;
  const Blocks& blocks_;
};

/// Errors of PlusJacobian as the derivative of Plus, and of the Jacobian by block k times
/// PlusJacobian, each relative to the largest exact entry.
template <class Function>
[[nodiscard]] std::pair<double, double>
errors_of_plus(const Function& function, const ceres::Manifold& manifold,
               std::vector<std::vector<double>> numbers, std::size_t k) {
  const int size = manifold.AmbientSize(), dimension = manifold.TangentSize();
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> plus(size, dimension);
  if (!manifold.PlusJacobian(numbers[k].data(), plus.data())) {
    return {1, 1};
  }
  Eigen::Index first = 0;
  for (std::size_t i = 0; i < k; ++i) {
    first += Eigen::Index(numbers[i].size());
  }
  const Eigen::MatrixXd product =
      product_of(function.evaluated(numbers).second.middleCols(first, size), plus);
  const std::vector<double> x = numbers[k];
  const auto error_of = [&](const Eigen::MatrixXd& jacobian, const auto& f) {
    double error = 0, scale = 1e-300;
    for (int j = 0; j < dimension; ++j) {
      const auto moved = [&](double h) -> Eigen::VectorXd {
        Eigen::VectorXd delta = Eigen::VectorXd::Zero(dimension);
        delta[j] = h;
        manifold.Plus(x.data(), delta.data(), numbers[k].data());
        return f();
      };
      const Eigen::VectorXd exact = central_difference_derivative(moved, 0.).derivative;
      error = std::max(error, (exact - jacobian.col(j)).cwiseAbs().maxCoeff());
      scale = std::max(scale, exact.cwiseAbs().maxCoeff());
    }
    return error / scale;
  };
  return {error_of(plus, [&] { return Eigen::VectorXd::Map(numbers[k].data(), size); }),
          error_of(product, [&] { return function.evaluated(numbers).first; })};
}

DUET_ABI_END
} // namespace detail

/// Judges the Jacobians of a cost function of Ceres against extrapolated differences of its
/// residuals, and names the slip. Derivatives by the numbers of rotations and poses count as far as
/// a step can reach: J · PlusJacobian.
///
/// Manifolds, if given, are judged as well: a PlusJacobian that is not the derivative of Plus is a
/// note of the judgement, which says whether its product with the Jacobian is right: then both are
/// right only together.
///
/// \param inputs     a `sampler` of what the blocks hold
/// \param blocks     a tuple of `rotation_block`, `pose_block`, `vector_block`, `number_block`
/// \param manifolds  manifolds of the blocks; nullptr for none
/// \throws invalid_input if the sizes of blocks differ from those of the cost function, or Evaluate
///   returns false
///
/// Example: `judge_jacobian("reprojection", *cost, sampler(poses{}, vectors<3>{1}).named("T", "p"),
/// std::tuple(pose_block(quaternion_order::xyzw), vector_block<3>()))`
template <class... Domains, class... Blocks>
  requires(sizeof...(Domains) == sizeof...(Blocks))
[[nodiscard]] jacobian_judgement
judge_jacobian(const std::string& label, const ceres::CostFunction& f,
               const sampler<Domains...>& inputs, const std::tuple<Blocks...>& blocks,
               const std::array<const ceres::Manifold*, sizeof...(Domains)>& manifolds = {},
               jacobian_options options = {}) {
  using arguments = decltype(inputs.template make<double>(std::declval<const coordinates&>()));
  return [&]<class... X>(const std::tuple<X...>*) {
    const detail::ceres_function<std::tuple<Blocks...>, X...> function(f, blocks);
    std::array<quaternion_order, sizeof...(X) + 1> orders{};
    std::size_t next = 0;
    const auto add_order = [&](const auto& block) {
      if constexpr (requires { block.order(); }) {
        orders[next++] = block.order();
      }
    };
    std::apply([&](const auto&... block) { (add_order(block), ...); }, blocks);
    detail::require(std::all_of(orders.begin(), orders.begin() + std::ptrdiff_t(next),
                                [&](quaternion_order o) { return o == orders[0]; }),
                    "duet: judge_jacobian: all blocks must have the same order of quaternions");
    options.order = orders[0];
    const auto jacobian = [&](const X&... x) { return function.evaluated(x...).second; };
    std::vector<detail::jacobian_part> results;
    detail::append_part(results, detail::jacobian_part::kind::vector, "f", f.num_residuals());
    jacobian_judgement result =
        detail::judged_jacobian(label, function, jacobian, std::move(results), inputs, options);
    const std::vector<coordinates> points = inputs.points(options.samples, options.seed);
    for (std::size_t k = 0; k < manifolds.size(); ++k) {
      if (manifolds[k] == nullptr) {
        continue;
      }
      double plus_error = 0, product_error = 0;
      for (std::size_t n = 0; n < points.size();
           n += std::max<std::size_t>(points.size() / 32, 1)) {
        const auto numbers = std::apply([&](const X&... x) { return function.stored(x...); },
                                        inputs.template make<double>(points[n]));
        const auto [of_plus, of_product] =
            detail::errors_of_plus(function, *manifolds[k], numbers, k);
        plus_error = std::max(plus_error, of_plus);
        product_error = std::max(product_error, of_product);
      }
      constexpr double digits = 1e-7; // of differences
      if (plus_error > digits) {
        result.notes.push_back(detail::message(
            "PlusJacobian of the manifold of ", inputs.names()[k],
            " is not the derivative of its Plus",
            product_error <= digits
                ? ": right only together with this Jacobian, wrong with any other manifold"
                : ", and its product with the Jacobian is wrong"));
      } else if (product_error <= digits && result.outcome == verdict::disagrees) {
        result.notes.push_back(
            detail::message("the product with PlusJacobian is right for ", inputs.names()[k]));
      }
    }
    return result;
  }(static_cast<const arguments*>(nullptr));
}

} // namespace duet
