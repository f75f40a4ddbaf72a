// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/derivative/gradient.hpp>
#include <duet/derivative/jacobian.hpp>
#include <duet/dual/dual.hpp>
#include <duet/dual/level.hpp>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <type_traits>
#include <utility>
#include <vector>

/// \file
/// Jacobians and Hessians with a known sparsity pattern.

namespace duet {
namespace detail {

/// Column groups of a sparsity pattern, no two columns of a group with entries in the same row, so
/// that the sum of a group gives each entry separately (Curtis, Powell, Reid 1974). One more sum,
/// of all columns with weights, detects entries that the pattern lacks.
template <class S>
class column_groups {
public:
  template <class P>
  explicit column_groups(const Eigen::SparseMatrixBase<P>& structure)
      : entries_(structure.template cast<S>()), group_(std::size_t(structure.cols())) {
    const Eigen::SparseMatrix<S, Eigen::RowMajor> rows(entries_);
    std::vector<Eigen::Index>
        met_by; // of each group: the last column that it has a row in common with
    for (Eigen::Index j = 0; j < entries_.cols(); ++j) {
      for (column_entry entry(entries_, j); entry; ++entry) {
        for (row_entry other(rows, entry.row()); other && other.col() < j; ++other) {
          met_by[std::size_t(group_[std::size_t(other.col())])] = j;
        }
      }
      const auto free = std::find_if(met_by.begin(), met_by.end(),
                                     [j](Eigen::Index column) { return column != j; });
      group_[std::size_t(j)] = int(free - met_by.begin());
      if (free == met_by.end()) {
        met_by.push_back(-1);
      }
    }
    sums_.setZero(entries_.rows(), Eigen::Index(met_by.size()) + 1);
  }

  /// Number of sums of columns, one per group and the weighted one.
  [[nodiscard]] int count() const { return int(sums_.cols()); }
  /// The weight of column j in the sum k.
  [[nodiscard]] double weight(Eigen::Index j, int k) const {
    if (k + 1 < count()) {
      return group_[std::size_t(j)] == k ? 1 : 0;
    }
    const double golden = 0.6180339887498949 * double(j + 1); // no two weights in a simple ratio
    return 1 + golden - std::floor(golden);
  }
  [[nodiscard]] S& sum(Eigen::Index row, int k) { return sums_(row, k); }

  /// The matrix with these sums.
  ///
  /// \throws invalid_input if the last sum shows entries outside the pattern
  [[nodiscard]] Eigen::SparseMatrix<S> matrix(const char* caller) {
    const int last = count() - 1;
    Eigen::Matrix<S, Eigen::Dynamic, 1> rest = sums_.col(last);
    Eigen::VectorXd scale = Eigen::VectorXd::Zero(rest.size());
    for (Eigen::Index j = 0; j < entries_.cols(); ++j) {
      for (column_entry entry(entries_, j); entry; ++entry) {
        entry.valueRef() = sums_(entry.row(), group_[std::size_t(j)]);
        rest[entry.row()] -= entry.value() * S(weight(j, last));
        scale[entry.row()] += std::abs(double(innermost(entry.value())));
      }
    }
    const double largest = rest.size() > 0 ? scale.maxCoeff() : 0;
    for (Eigen::Index i = 0; i < rest.size(); ++i) {
      // Sums are not exact: a millionth of the row, or the cancellation of the largest one.
      require(!(std::abs(double(innermost(rest[i]))) > 1e-6 * scale[i] + 1e-12 * largest),
              "duet: ", caller, ": row ", i, " has entries outside the sparsity pattern");
    }
    return entries_;
  }

private:
  using column_entry = typename Eigen::SparseMatrix<S>::InnerIterator;
  using row_entry = typename Eigen::SparseMatrix<S, Eigen::RowMajor>::InnerIterator;

  Eigen::SparseMatrix<S> entries_;
  std::vector<int> group_; ///< group of each column
  Eigen::Matrix<S, Eigen::Dynamic, Eigen::Dynamic> sums_;
};

} // namespace detail

/// f(x) and the sparse Jacobian ∂f_i/∂x_j, m × n. Arguments as `jacobian`.
///
/// Columns without a common row share a partial: with at most k entries in a row, k to a few more
/// partials suffice instead of n, and f is evaluated once for every sixteen.
///
/// \param structure  sparsity pattern, m × n: its entries, whatever their values, are all that may
///   be nonzero
/// \return `value_and_jacobian`
/// \throws invalid_input if the pattern has another size, and if an entry outside it exceeds a
///   millionth of its row
template <class Tag = void, detail::FunctionOfAny F, Variables X, class P>
[[nodiscard]] auto sparse_jacobian(F&& f, const X& x, const Eigen::SparseMatrixBase<P>& structure) {
  using argument = detail::vector_argument<X>;
  using tag = detail::tag_for<Tag, F>;
  using D = dual<typename argument::scalar, detail::chunk, tag>;
  auto variables = detail::constants<D>(x);
  using output = std::decay_t<decltype(detail::result_of_call(detail::call(f, variables)))>;
  static_assert(VectorLike<output>, "duet: sparse_jacobian needs a function that returns a vector");
  using value = std::decay_t<decltype(detail::parts<tag>(std::declval<const output&>(), 0))>;
  using S = typename detail::vector_argument<value>::scalar;
  constexpr const char* caller = "sparse_jacobian";
  const Eigen::Index size = argument::size(x);
  detail::require(structure.cols() == size, "duet: ", caller, ": the structure has ",
                  structure.cols(), " columns for ", size, " variables");
  detail::column_groups<S> groups(structure);
  value_and_jacobian<value, Eigen::SparseMatrix<S>> result{};
  for (int first = 0; first < groups.count(); first += detail::chunk) {
    const int count = std::min(detail::chunk, groups.count() - first);
    for (Eigen::Index j = 0; j < size; ++j) {
      for (int k = 0; k < count; ++k) {
        detail::component(variables, j).set_partial(k, groups.weight(j, first + k));
      }
    }
    const output y = detail::result_of_call(detail::call(f, variables));
    const Eigen::Index rows = detail::vector_argument<output>::size(y);
    detail::require(structure.rows() == rows, "duet: ", caller, ": the structure has ",
                    structure.rows(), " rows, the function ", rows, " components");
    result.value = detail::parts<tag>(y, 0);
    for (Eigen::Index i = 0; i < rows; ++i) {
      for (int k = 0; k < count; ++k) {
        groups.sum(i, first + k) = detail::part<tag>(detail::component(y, i), k + 1);
      }
    }
  }
  result.jacobian = groups.matrix(caller);
  return result;
}

/// f(x), ∇f and the sparse symmetric Hessian. Arguments as `gradient`.
///
/// With k groups of columns, as for `sparse_jacobian`, f is evaluated ⌈n/8⌉ ⌈(k + 1)/4⌉ times.
///
/// \param structure  sparsity pattern, n × n: its entries, whatever their values and in either
///   triangle or both, are all that may be nonzero
/// \return `value_gradient_and_hessian`
/// \throws invalid_input as `sparse_jacobian`
template <class Tag = void, detail::FunctionOfAny F, Variables X, class P>
[[nodiscard]] auto sparse_hessian(F&& f, const X& x, const Eigen::SparseMatrixBase<P>& structure) {
  using argument = detail::vector_argument<X>;
  using T = typename argument::scalar;
  using tag = detail::tag_for<Tag, F>;
  using group_tag = derivative_tag<tag, struct groups_of_columns>;
  constexpr int rows = detail::hessian_block, columns = 4;
  using E = dual<T, columns, group_tag>;
  using D = dual<E, rows, tag>;
  using output =
      std::decay_t<decltype(detail::result_of_call(detail::call(f, detail::constants<D>(x))))>;
  static_assert(Scalar<output>, "duet: sparse_hessian needs a function that returns a scalar");
  using S =
      decltype(detail::part<group_tag>(detail::part<tag>(std::declval<const output&>(), 0), 0));
  const Eigen::Index size = argument::size(x);
  detail::require(size > 0, "duet: sparse_hessian: the function has no variables");
  detail::require(structure.rows() == size && structure.cols() == size,
                  "duet: sparse_hessian: the structure is ", structure.rows(), " x ",
                  structure.cols(), " for ", size, " variables");
  using matrix = Eigen::SparseMatrix<typename P::Scalar>;
  detail::column_groups<S> groups(matrix(structure) + matrix(structure.transpose()));
  using vector = Eigen::Matrix<S, argument::size_at_compile_time, 1>;
  value_gradient_and_hessian<S, vector, Eigen::SparseMatrix<S>> result{S(0), vector(size), {}};
  auto variables = detail::constants<D>(x);
  for (Eigen::Index block = 0; block < size; block += rows) {
    for (int first = 0; first < groups.count(); first += columns) {
      const int count = std::min(columns, groups.count() - first);
      for (Eigen::Index j = 0; j < size; ++j) {
        E moved(argument::get(x, j));
        for (int k = 0; k < count; ++k) {
          moved.set_partial(k, groups.weight(j, first + k));
        }
        const bool is_row = block <= j && j < block + rows;
        detail::component(variables, j) = is_row ? D::variable(moved, int(j - block)) : D(moved);
      }
      const auto y = detail::result_of_call(detail::call(f, variables));
      result.value = detail::part<group_tag>(detail::part<tag>(y, 0), 0);
      for (Eigen::Index i = block; i < std::min<Eigen::Index>(block + rows, size); ++i) {
        const auto slope = detail::part<tag>(y, int(i - block) + 1);
        result.gradient[i] = detail::part<group_tag>(slope, 0);
        for (int k = 0; k < count; ++k) {
          groups.sum(i, first + k) = detail::part<group_tag>(slope, k + 1);
        }
      }
    }
  }
  result.hessian = groups.matrix("sparse_hessian");
  return result;
}

template <class Tag = void, detail::FunctionOfReals F, class... X>
DUET_REFUSED_FUNCTION(sparse_jacobian)
value_and_jacobian<Eigen::VectorXd, Eigen::SparseMatrix<double>> sparse_jacobian(F&&, X&&...);
template <class Tag = void, detail::FunctionOfReals F, class... X>
DUET_REFUSED_FUNCTION(sparse_hessian)
value_gradient_and_hessian<double, Eigen::VectorXd, Eigen::SparseMatrix<double>> sparse_hessian(
    F&&, X&&...);

DUET_REFUSES_MATRICES(sparse_jacobian, "structure",
                      value_and_jacobian<Eigen::VectorXd, Eigen::SparseMatrix<double>>)
DUET_REFUSES_MATRICES(
    sparse_hessian, "structure",
    value_gradient_and_hessian<double, Eigen::VectorXd, Eigen::SparseMatrix<double>>)

} // namespace duet
