// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/batch.hpp>
#include <duet/core/batch/math.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/parallel_for.hpp>
#include <duet/derivative/jacobian.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/kinematics/jacobian.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <iterator>
#include <ranges>
#include <span>
#include <type_traits>
#include <utility>

/// \file
/// Forward kinematics and Jacobians of a chain in many configurations, with SIMD batches and
/// multithreading.

namespace duet {

namespace detail {

/// Copies one lane of a result over batches: of a pose, a matrix, or both. (Without inlining a
/// sweep takes 5 % more time, as vectors of lanes go through memory.)
template <class B, class To>
DUET_ALWAYS_INLINE void write_lane(const dual_quaternion<B>& a, int k, To& to) {
  to = lane(a, k);
}
template <class M, class To>
DUET_ALWAYS_INLINE void write_lane(const Eigen::MatrixBase<M>& m, int k, To& to) {
  for (Eigen::Index j = 0; j < m.cols(); ++j) {
    for (Eigen::Index i = 0; i < m.rows(); ++i) {
      to(i, j) = m(i, j)[k];
    }
  }
}
template <class V, class J, class To>
DUET_ALWAYS_INLINE void write_lane(const value_and_jacobian<V, J>& both, int k, To& to) {
  write_lane(both.value, k, to.value);
  write_lane(both.jacobian, k, to.jacobian);
}

/// True if a matrix of type M can have this size.
template <class M>
[[nodiscard]] constexpr bool can_become(Eigen::Index rows, Eigen::Index columns) {
  constexpr auto fits = [](int fixed, int max_size, Eigen::Index n) {
    return fixed == Eigen::Dynamic ? max_size == Eigen::Dynamic || n <= max_size : n == fixed;
  };
  return std::derived_from<M, Eigen::PlainObjectBase<M>> &&
         fits(M::RowsAtCompileTime, M::MaxRowsAtCompileTime, rows) &&
         fits(M::ColsAtCompileTime, M::MaxColsAtCompileTime, columns);
}

/// Resizes the matrices of all results to 6 rows and n columns.
template <class Out, class Matrix>
void fit_matrices(const char* function, Out& out, Eigen::Index n, const Matrix& matrix_of) {
  for (std::size_t i = 0; i < std::size(out); ++i) {
    auto& m = matrix_of(out[i]);
    using type = std::decay_t<decltype(m)>;
    if (m.rows() == 6 && m.cols() == n) {
      continue;
    }
    if (!can_become<type>(6, n)) {
      raise(invalid_input(message("duet: ", function, ": result ", i, " is a ", m.rows(), " × ",
                                  m.cols(), " matrix, not 6 × ", n)));
    }
    if constexpr (type::SizeAtCompileTime == Eigen::Dynamic) {
      m.resize(6, n);
    }
  }
}

/// out[i] = f(configurations[i]), with several configurations in the lanes of f's argument; the
/// last configuration fills the remaining lanes.
template <class C, class X, class Out, class F>
void sweep(const char* function, const C& chain, std::span<const X> configurations, Out& out,
           execution how, const F& f) {
  using argument = vector_argument<X>;
  using B = batch<typename argument::scalar>;
  using lanes = joint_vector<B, C::joints>;
  require(configurations.size() == std::size(out), "duet: ", function, ": ", configurations.size(),
          " configurations, but room for ", std::size(out), " results");
  for (std::size_t i = 0; i < configurations.size(); ++i) {
    if (argument::size(configurations[i]) != chain.size()) {
      raise(invalid_input(message("duet: ", function, ": configuration ", i, " has ",
                                  argument::size(configurations[i]), " coordinates (expected ",
                                  chain.size(), ")")));
    }
  }
  parallel_for_blocks(
      configurations.size(),
      [&](std::size_t first, std::size_t last) {
        lanes theta(chain.size());
        for (std::size_t i = first; i < last; i += std::size_t(B::lanes)) {
          const std::size_t count = std::min(std::size_t(B::lanes), last - i);
          for (Eigen::Index j = 0; j < chain.size(); ++j) {
            theta[j] = B::from_lanes([&](int k) DUET_INLINE_LAMBDA {
              return argument::get(configurations[i + std::min(std::size_t(k), count - 1)], j);
            });
          }
          const auto result = f(theta);
          for (std::size_t k = 0; k < count; ++k) {
            write_lane(result, int(k), out[i + k]);
          }
        }
      },
      how);
}

template <class Range>
using range_element =
    std::remove_cv_t<std::remove_pointer_t<decltype(std::data(std::declval<Range&>()))>>;

template <class Range>
[[nodiscard]] std::span<const range_element<Range>> read_only(const Range& range) {
  return {std::data(range), std::size(range)};
}

} // namespace detail

/// Configurations of a chain, contiguous in memory: a span or a vector of arguments of
/// `chain.pose`, over numbers.
template <class R>
concept Configurations = std::ranges::contiguous_range<R> && VectorLike<detail::range_element<R>>;

/// Forward kinematics of many configurations: out[i] = chain.pose(configurations[i], at), several
/// at once in the lanes of SIMD batches; `out` is a span or a vector.
///
/// Sines are within 1 ulp. A result depends neither on the other configurations nor on the number
/// of threads. With one thread no heap memory is used.
///
/// \throws invalid_input if the sizes differ, and if the number of coordinates differs from that of
/// the chain
/// \throws cancelled if `how.report` requests it, see `parallel_for_blocks`
template <SerialChain C, Configurations X, std::ranges::contiguous_range Out,
          FrameOnChain<C> At = tip_of_chain>
void poses(const C& chain, const X& configurations, Out&& out, execution how = one_core,
           const At& at = {}) {
  detail::sweep("poses", chain, detail::read_only(configurations), out, how,
                [&](const auto& theta) { return chain.pose(theta, at); });
}

/// Jacobians of many configurations: out[i] = jacobian(chain, configurations[i], frame,
/// at), as `poses`.
///
/// Elements of `out` are 6 × n matrices; matrices of dynamic size are resized.
///
/// \throws invalid_input as `poses`, and for a matrix of another fixed size or with too small a
/// maximum size
template <SerialChain C, Configurations X, FrameConstant Frame, std::ranges::contiguous_range Out,
          FrameOnChain<C> At = tip_of_chain>
void jacobians(const C& chain, const X& configurations, Frame frame_of_result, Out&& out,
               execution how = one_core, const At& at = {}) {
  detail::fit_matrices(
      "jacobians", out, chain.size(), [](auto& m) -> auto& { return m; });
  detail::sweep("jacobians", chain, detail::read_only(configurations), out, how,
                [&](const auto& theta) { return jacobian(chain, theta, frame_of_result, at); });
}

/// Poses and Jacobians of many configurations: out[i] = pose_and_jacobian(chain, configurations[i],
/// frame, at), as `jacobians`.
template <SerialChain C, Configurations X, FrameConstant Frame, std::ranges::contiguous_range Out,
          FrameOnChain<C> At = tip_of_chain>
void poses_and_jacobians(const C& chain, const X& configurations, Frame frame_of_result, Out&& out,
                         execution how = one_core, const At& at = {}) {
  detail::fit_matrices(
      "poses_and_jacobians", out, chain.size(), [](auto& both) -> auto& { return both.jacobian; });
  detail::sweep(
      "poses_and_jacobians", chain, detail::read_only(configurations), out, how,
      [&](const auto& theta) { return pose_and_jacobian(chain, theta, frame_of_result, at); });
}

} // namespace duet
