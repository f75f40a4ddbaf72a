// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/dual/promotion.hpp>
#include <duet/kinematics/kinematic_tree.hpp>
#include <duet/kinematics/tree_jacobian.hpp>
#include <duet/kinematics/tree_table.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <vector>

/// \file
/// Centre of mass of a kinematic tree, its Jacobian, time derivative of the Jacobian and Hessian in
/// closed form, in time proportional to the number of links.

namespace duet {

namespace detail {

/// Mass and first moment, Σ mass × centre, of all that a node carries, in the frame of the root.
template <class S>
struct subtree_mass {
  double mass = 0;
  three_vector<S> moment{S(0), S(0), S(0)};
  three_vector<S> rate{S(0), S(0), S(0)}; ///< time derivative of the moment
};

/// Carried masses of the root, then of each node.
///
/// \param rates  velocities of the nodes; if empty all are zero
/// \throws invalid_input if the total mass is zero
template <class S>
[[nodiscard]] std::vector<subtree_mass<S>> carried_masses(const tree_table& table,
                                                          const tree_motion<S>& motion,
                                                          const tree_rates<S>& rates = {}) {
  std::vector<subtree_mass<S>> result(table.masses.size());
  for (std::size_t i = table.masses.size(); i-- > 0;) { // children first
    const mass_on_node& own = table.masses[i];
    subtree_mass<S>& sum = result[i];
    const link_displacement<S> frame = motion.frame(int(i) - 1);
    const three_vector<S> moment =
        S(own.mass) * frame.translation + rotated(frame.rotation, own.moment);
    sum.mass += own.mass;
    sum.moment = sum.moment + moment;
    if (i > 0) {
      if (!rates.nodes.empty()) {
        const twist_column<S>& twist = rates.nodes[i - 1];
        sum.rate = sum.rate + S(own.mass) * twist.v + cross(twist.omega, moment);
      }
      subtree_mass<S>& parent = result[std::size_t(table.nodes[i - 1].parent + 1)];
      parent.mass += sum.mass;
      parent.moment = parent.moment + sum.moment;
      parent.rate = parent.rate + sum.rate;
    }
  }
  require(result[0].mass > 0, "duet: centre_of_mass: the mass of all links is 0 (expected > 0)");
  return result;
}

template <class J, class S>
void add_to_column(J& m, const coordinate_source& source, double factor, const three_vector<S>& v) {
  m(0, source.own) += v.x * (factor * source.multiplier);
  m(1, source.own) += v.y * (factor * source.multiplier);
  m(2, source.own) += v.z * (factor * source.multiplier);
}

/// A coordinate moves the centre of mass c by (m v + ω × h)/M per unit: m and h are the mass and
/// moment that it carries, [v; ω] is its screw.
template <class S>
[[nodiscard]] tree_columns<S, 3> centre_of_mass_jacobian_of(const tree_table& table,
                                                            const tree_motion<S>& motion) {
  const auto masses = carried_masses(table, motion);
  tree_columns<S, 3> result(3, Eigen::Index(table.names.size()));
  result.setConstant(S(0));
  for (const tree_screw<S>& screw : motion.screws) {
    const subtree_mass<S>& carried = masses[std::size_t(screw.at) + 1];
    add_to_column(result, table.sources[std::size_t(screw.coordinate)], 1 / masses[0].mass,
                  S(carried.mass) * screw.twist.v + cross(screw.twist.omega, carried.moment));
  }
  return result;
}

/// Time derivative (m v̇ + ω̇ × h + ω × ḣ)/M.
template <class S, class X, class V>
[[nodiscard]] tree_columns<S, 3> centre_of_mass_jacobian_rate_of(const tree_table& table,
                                                                 const tree_motion<S>& motion,
                                                                 const X& x, const V& x_dot) {
  const auto rates = rates_of<S>(table, motion, x, x_dot);
  const auto masses = carried_masses(table, motion, rates);
  tree_columns<S, 3> result(3, Eigen::Index(table.names.size()));
  result.setConstant(S(0));
  for (std::size_t i = 0; i < motion.screws.size(); ++i) {
    const tree_screw<S>& screw = motion.screws[i];
    const subtree_mass<S>& carried = masses[std::size_t(screw.at) + 1];
    add_to_column(result, table.sources[std::size_t(screw.coordinate)], 1 / masses[0].mass,
                  S(carried.mass) * rates.screws[i].v +
                      cross(rates.screws[i].omega, carried.moment) +
                      cross(screw.twist.omega, carried.rate));
  }
  return result;
}

} // namespace detail

/// The centre of mass of a tree at the configuration q, in the frame of the root.
///
/// \throws invalid_input if the number of coordinates differs from `size()`, and for a
/// tree without mass
template <VectorLike X>
[[nodiscard]] auto centre_of_mass(const kinematic_tree& tree, const X& q) {
  using S = detail::tree_scalar<X>;
  const detail::joint_coordinates<S, X> x(tree.table(), q);
  const auto all = detail::carried_masses(tree.table(), detail::motion_of_all<S>(tree.table(), x));
  return (S(1 / all[0].mass) * all[0].moment).eigen();
}

/// Jacobian ∂c/∂q of the centre of mass c of a tree. Arguments as `centre_of_mass`.
///
/// \return a matrix of 3 rows and a column for each coordinate
template <VectorLike X>
[[nodiscard]] auto centre_of_mass_jacobian(const kinematic_tree& tree, const X& q) {
  using S = detail::tree_scalar<X>;
  const detail::joint_coordinates<S, X> x(tree.table(), q);
  return detail::centre_of_mass_jacobian_of(tree.table(),
                                            detail::motion_of_all<S>(tree.table(), x));
}

/// Time derivative J̇ along q̇ of J = `centre_of_mass_jacobian`, so that c̈ = J q̈ + J̇ q̇.
///
/// \return a matrix of 3 rows and a column for each coordinate
template <VectorLike X, VectorLike V>
[[nodiscard]] auto centre_of_mass_jacobian_rate(const kinematic_tree& tree, const X& q,
                                                const V& q_dot) {
  using S = promote_t<detail::tree_scalar<X>, typename detail::vector_argument<V>::scalar>;
  const detail::joint_coordinates<S, X> x(tree.table(), q);
  const detail::joint_velocities<S, V> x_dot(tree.table(), q_dot);
  return detail::centre_of_mass_jacobian_rate_of(
      tree.table(), detail::motion_of_all<S>(tree.table(), x), x, x_dot);
}

/// Hessian ∂²c/∂q_j∂q_k of the centre of mass c of a tree: for each j a matrix of 3 rows and a
/// column for each k. Arguments as `centre_of_mass`.
///
/// \return a `std::vector` of matrices
template <VectorLike X>
[[nodiscard]] auto centre_of_mass_hessian(const kinematic_tree& tree, const X& q) {
  using S = detail::tree_scalar<X>;
  const detail::joint_coordinates<S, X> x(tree.table(), q);
  const auto motion = detail::motion_of_all<S>(tree.table(), x);
  std::vector<detail::tree_columns<S, 3>> result;
  for (int j = 0; j < tree.size(); ++j) {
    result.push_back(detail::centre_of_mass_jacobian_rate_of(
        tree.table(), motion, x, detail::unit_velocities(tree.table(), j)));
  }
  return result;
}

} // namespace duet
