// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/derivative/jacobian.hpp>
#include <duet/dual/promotion.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/kinematics/chain_walk.hpp>
#include <duet/kinematics/jacobian.hpp>
#include <duet/kinematics/jacobian_rate.hpp>
#include <duet/kinematics/kinematic_tree.hpp>
#include <duet/kinematics/tree_table.hpp>
#include <duet/quaternion/exponential_jacobian.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/rotation.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <Eigen/Core>

#include <concepts>
#include <cstddef>
#include <vector>

/// \file
/// Geometric Jacobians of frames on a kinematic tree and of its centre of mass, their time
/// derivatives and Hessians, in closed form. Functions of the centre of mass take time proportional
/// to the number of links.

namespace duet {

namespace detail {

/// The screw of a joint coordinate: the twist of all that the joint carries, per unit of
/// the coordinate.
template <class S>
struct tree_screw {
  int at;         ///< index of its node in the list of nodes
  int coordinate; ///< number of the joint coordinate
  twist_column<S> twist;
};

/// Nodes of a tree, parents first, with their frames relative to the frame above the first node,
/// and the screws of their coordinates, with v at the origin of that frame.
template <class S>
struct tree_motion {
  std::vector<int> nodes;
  std::vector<int> before; ///< index of each node's parent in `nodes`; −1: the frame above
  std::vector<link_displacement<S>> frames; ///< frame of each node after its motion
  std::vector<tree_screw<S>> screws;

  /// Frame of the node at an index; for −1 the frame above.
  [[nodiscard]] link_displacement<S> frame(int i) const {
    return i < 0 ? identity_displacement<S>() : frames[std::size_t(i)];
  }

  template <class X>
  void follow(const tree_table& table, const X& x) {
    frames.reserve(nodes.size());
    screws.reserve(nodes.size());
    const auto put_screw = [&](int coordinate, const twist_column<S>& twist) {
      screws.push_back({int(frames.size()), coordinate, twist});
    };
    for_each_node<S>(
        table, x, int(nodes.size()), [&](int i) { return nodes[std::size_t(i)]; }, put_screw,
        [&](const tree_node&, const auto& move) {
          frames.push_back(move(frame(before[frames.size()])));
        });
  }
};

/// Motion of the nodes below a node `top` down to one node.
template <class S, class X>
[[nodiscard]] tree_motion<S> motion_to(const tree_table& table, const X& x, int node, int top) {
  const node_path path(table, node, top);
  tree_motion<S> result;
  for (const int k : path) {
    result.before.push_back(int(result.nodes.size()) - 1);
    result.nodes.push_back(k);
  }
  result.follow(table, x);
  return result;
}

/// Motion of all nodes of the tree.
template <class S, class X>
[[nodiscard]] tree_motion<S> motion_of_all(const tree_table& table, const X& x) {
  tree_motion<S> result;
  for (std::size_t k = 0; k < table.nodes.size(); ++k) {
    result.nodes.push_back(int(k));
    result.before.push_back(table.nodes[k].parent);
  }
  result.follow(table, x);
  return result;
}

/// Time derivative of `left_jacobian(r)` along ṙ: with cₙ the Stumpff functions of s = r·r, whose
/// derivatives are cₙ′ = (n cₙ₊₂ − cₙ₊₁)/2,
/// r·ṙ ((c₃ − c₂) I + (2 c₄ − c₃) r̂ + (3 c₅ − c₄) r rᵀ) + c₂ ṙ̂ + c₃ (ṙ rᵀ + r ṙᵀ).
template <class S>
[[nodiscard]] matrix3<S> left_jacobian_rate(const vector3<S>& r, const vector3<S>& r_dot) {
  const auto c = stumpff_sequence<5>(S(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]));
  const S p = r[0] * r_dot[0] + r[1] * r_dot[1] + r[2] * r_dot[2];
  matrix3<S> result =
      axial_matrix<S>(p * (c[3] - c[2]), p * (2 * c[4] - c[3]), p * (3 * c[5] - c[4]), r) +
      axial_matrix<S>(S(0), c[2], S(0), r_dot);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      result(i, j) += c[3] * (r_dot[i] * r[j] + r[i] * r_dot[j]);
    }
  }
  return result;
}

template <class S>
[[nodiscard]] twist_column<S> sum(const twist_column<S>& a, const twist_column<S>& b) {
  return {a.v + b.v, a.omega + b.omega};
}

/// Time derivatives of the screws of a motion, and the twists of its nodes.
template <class S>
struct tree_rates {
  std::vector<twist_column<S>> screws; ///< ṡ of each screw s
  std::vector<twist_column<S>> nodes;  ///< twist of each node

  /// Twist of the node at an index; zero for −1, the frame above the first node.
  [[nodiscard]] twist_column<S> node(int i) const {
    return i < 0 ? no_twist<S>() : nodes[std::size_t(i)];
  }
};

/// A screw is carried by the parent node of its joint, ad(V) s; the screws of a spherical joint
/// also change with its own coordinates.
template <class S, class X, class V>
[[nodiscard]] tree_rates<S> rates_of(const tree_table& table, const tree_motion<S>& motion,
                                     const X& x, const V& x_dot) {
  tree_rates<S> result;
  result.screws.reserve(motion.screws.size());
  result.nodes.reserve(motion.nodes.size());
  auto screw = motion.screws.begin();
  for (std::size_t i = 0; i < motion.nodes.size(); ++i) {
    const tree_node& node = table.nodes[std::size_t(motion.nodes[i])];
    const twist_column<S> before = result.node(motion.before[i]);
    twist_column<S> after = before;
    matrix3<S> j_rate;
    link_displacement<S> origin;
    if (node.is_ball) {
      origin = origin_of_ball(motion.frame(motion.before[i]), node);
      j_rate =
          left_jacobian_rate<S>(ball_coordinates<S>(node, x), ball_coordinates<S>(node, x_dot));
    }
    for (int k = 0; k < node.coordinates(); ++k, ++screw) {
      const twist_column<S>& twist = screw->twist;
      twist_column<S> rate = bracket(before, twist);
      if (node.is_ball) {
        const three_vector<S> omega =
            rotated(origin.rotation, three_vector<S>{j_rate(0, k), j_rate(1, k), j_rate(2, k)});
        rate = sum(rate, {cross(origin.translation, omega), omega});
      }
      result.screws.push_back(rate);
      const S speed(x_dot[screw->coordinate]);
      after = sum(after, {speed * twist.v, speed * twist.omega});
    }
    result.nodes.push_back(after);
  }
  return result;
}

/// A matrix with one column for each coordinate of a tree.
template <class S, int Rows>
using tree_columns = Eigen::Matrix<S, Rows, Eigen::Dynamic>;

/// The two frames, and all nodes that move between them.
template <class S>
struct relative_motion : relative_frames<S> {
  tree_motion<S> to_frame, to_observer;

  template <class X>
  relative_motion(const tree_table& table, const X& x, const tree_view& view)
      : to_frame(motion_to<S>(table, x, view.frame.node, view.top)),
        to_observer(motion_to<S>(table, x, view.observer.node, view.top)) {
    this->frame = pose_on(to_frame, view.frame.offset);
    this->observer = pose_on(to_observer, view.observer.offset);
  }

private:
  [[nodiscard]] static link_displacement<S> pose_on(const tree_motion<S>& motion,
                                                    const placement<double>& offset) {
    return attached(motion.frame(int(motion.frames.size()) - 1), offset);
  }
};

template <class J, class S>
DUET_ALWAYS_INLINE void add_to_column(J& m, const coordinate_source& source, double sign,
                                      const twist_column<S>& a) {
  const double factor = sign * source.multiplier;
  m(0, source.own) += a.v.x * factor;
  m(1, source.own) += a.v.y * factor;
  m(2, source.own) += a.v.z * factor;
  m(3, source.own) += a.omega.x * factor;
  m(4, source.own) += a.omega.y * factor;
  m(5, source.own) += a.omega.z * factor;
}

/// Adds the screws of all nodes of a path, times a sign, to the columns of their coordinates;
/// returns the frame of the last node.
template <class S, class X>
[[nodiscard]] DUET_ALWAYS_INLINE link_displacement<S>
add_screws(tree_columns<S, 6>& m, const tree_table& table, const X& x, const node_path& path,
           double sign) {
  return walk_down<S>(table, x, path,
                      [&](int coordinate, const twist_column<S>& screw) DUET_INLINE_LAMBDA {
                        add_to_column(m, table.sources[std::size_t(coordinate)], sign, screw);
                      });
}

/// Sets m to the Jacobian of a frame of a tree; returns the pose of that frame.
template <class Frame, class S, class X>
[[nodiscard]] relative_frames<S> fill_jacobian(tree_columns<S, 6>& m, const tree_table& table,
                                               const X& x, const tree_view& view) {
  m.setConstant(6, Eigen::Index(table.names.size()), S(0));
  const node_path to_frame(table, view.frame.node, view.top);
  relative_frames<S> result{attached(add_screws<S>(m, table, x, to_frame, 1), view.frame.offset),
                            identity_displacement<S>()};
  if (!view.is_from_above) {
    const node_path to_observer(table, view.observer.node, view.top);
    result.observer = attached(add_screws<S>(m, table, x, to_observer, -1), view.observer.offset);
  }
  // All columns, as zero columns stay zero: finding the others takes longer.
  if (!std::same_as<Frame, spatial_frame> || !view.is_from_above) {
    take_at(m, result.template origin<Frame>().translation);
  }
  if (std::same_as<Frame, body_frame> || !view.is_from_above) {
    express_in(m, result.template axes<Frame>().rotation);
  }
  return result;
}

/// Time derivative of Rᵀ(v + ω × p), Rᵀω, where p has the velocity ṗ and R the angular velocity Ω:
/// Rᵀ(v̇ + ω̇ × p + ω × ṗ − Ω × (v + ω × p)), Rᵀ(ω̇ − Ω × ω).
template <class Frame, class S, class X, class V>
[[nodiscard]] tree_columns<S, 6> jacobian_rate_of(const tree_table& table,
                                                  const relative_motion<S>& motion, const X& x,
                                                  const V& x_dot) {
  tree_columns<S, 6> result(6, Eigen::Index(table.names.size()));
  result.setConstant(S(0));
  const auto to_frame = rates_of<S>(table, motion.to_frame, x, x_dot);
  const auto to_observer = rates_of<S>(table, motion.to_observer, x, x_dot);
  const auto last = [](const tree_rates<S>& rates) {
    return rates.node(int(rates.nodes.size()) - 1);
  };
  const twist_column<S> of_frame = last(to_frame);
  const twist_column<S> of_observer = last(to_observer);
  const three_vector<S>& p = motion.template origin<Frame>().translation;
  const quaternion<S> back = conj(motion.template axes<Frame>().rotation);
  const twist_column<S>& of_origin = std::same_as<Frame, spatial_frame> ? of_observer : of_frame;
  const three_vector<S> p_dot = of_origin.v + cross(of_origin.omega, p);
  const three_vector<S>& axes_omega =
      std::same_as<Frame, body_frame> ? of_frame.omega : of_observer.omega;
  const auto add = [&](const tree_motion<S>& branch, const tree_rates<S>& rates, double sign) {
    for (std::size_t i = 0; i < branch.screws.size(); ++i) {
      const twist_column<S>& s = branch.screws[i].twist;
      const twist_column<S>& s_dot = rates.screws[i];
      const three_vector<S> at_p = s.v + cross(s.omega, p);
      const twist_column<S> change{s_dot.v + cross(s_dot.omega, p) + cross(s.omega, p_dot) -
                                       cross(axes_omega, at_p),
                                   s_dot.omega - cross(axes_omega, s.omega)};
      add_to_column(result, table.sources[std::size_t(branch.screws[i].coordinate)], sign,
                    twist_column<S>{rotated(back, change.v), rotated(back, change.omega)});
    }
  };
  add(motion.to_frame, to_frame, 1);
  add(motion.to_observer, to_observer, -1);
  return result;
}

} // namespace detail

/// The geometric Jacobian J of 6 rows: the twist [v; ω] = J q̇ of a frame on a tree (N18, N20), for
/// example an end-effector frame. Columns of coordinates that do not move the frame are zero.
/// Units: those of q in the denominator.
///
/// \tparam Frame  `frame::spatial`, `frame::body` or `frame::hybrid`, as for a chain; for a
///                `relative_frame` the observer is the fixed frame
/// \param at      a link number, an `attached_frame`, as `tree.link("hand").at_point({x, y, z})`,
///                or a `relative_frame`
/// \return a matrix of 6 rows and a column for each coordinate
/// \throws invalid_input if the number of coordinates differs from `size()`, or the link
/// does not exist
template <VectorLike X, FrameConstant Frame, FrameOnTree At>
[[nodiscard]] auto jacobian(const kinematic_tree& tree, const X& q, Frame, const At& at) {
  using S = detail::tree_scalar<X>;
  const detail::joint_coordinates<S, X> x(tree.table(), q);
  detail::tree_columns<S, 6> result;
  static_cast<void>(detail::fill_jacobian<Frame>(result, tree.table(), x, tree.view(at)));
  return result;
}

/// Forward kinematics and geometric Jacobian: the pose A of a frame on a tree, and its Jacobian
/// there. Arguments as `jacobian`.
///
/// \return `value_and_jacobian`
template <VectorLike X, FrameConstant Frame, FrameOnTree At>
[[nodiscard]] auto pose_and_jacobian(const kinematic_tree& tree, const X& q, Frame, const At& at) {
  using S = detail::tree_scalar<X>;
  const detail::joint_coordinates<S, X> x(tree.table(), q);
  value_and_jacobian<dual_quaternion<S>, detail::tree_columns<S, 6>> result;
  result.value =
      detail::fill_jacobian<Frame>(result.jacobian, tree.table(), x, tree.view(at)).pose();
  return result;
}

/// J and J̇ of a frame on a tree along the joint velocities q̇, so that J q̈ + J̇ q̇ is the
/// derivative of the twist J q̇. In `frame::hybrid` its linear part is p̈ of the frame's origin.
/// Arguments as `jacobian`.
///
/// \return `jacobian_and_rate`
template <VectorLike X, VectorLike V, FrameConstant Frame, FrameOnTree At>
[[nodiscard]] auto jacobian_with_rate(const kinematic_tree& tree, const X& q, const V& q_dot, Frame,
                                      const At& at) {
  using S = promote_t<detail::tree_scalar<X>, typename detail::vector_argument<V>::scalar>;
  const detail::joint_coordinates<S, X> x(tree.table(), q);
  const detail::joint_velocities<S, V> x_dot(tree.table(), q_dot);
  const detail::tree_view view = tree.view(at);
  jacobian_and_rate<detail::tree_columns<S, 6>> result;
  static_cast<void>(detail::fill_jacobian<Frame>(result.jacobian, tree.table(), x, view));
  const detail::relative_motion<S> motion(tree.table(), x, view);
  result.rate = detail::jacobian_rate_of<Frame>(tree.table(), motion, x, x_dot);
  return result;
}

/// J̇ of `jacobian_with_rate`, the time derivative of the Jacobian.
///
/// \return a matrix of 6 rows and a column for each coordinate
template <VectorLike X, VectorLike V, FrameConstant Frame, FrameOnTree At>
[[nodiscard]] auto jacobian_rate(const kinematic_tree& tree, const X& q, const V& q_dot,
                                 Frame frame_of_result, const At& at) {
  return jacobian_with_rate(tree, q, q_dot, frame_of_result, at).rate;
}

/// Kinematic Hessian ∂J/∂q_j of a frame on a tree for all j, each a matrix of 6 rows and a column
/// for each coordinate. Only in `frame::hybrid` the linear part of column k is ∂²p/∂q_j∂q_k of the
/// frame's origin p. Arguments as `jacobian`.
///
/// \return a `std::vector` of matrices
template <VectorLike X, FrameConstant Frame, FrameOnTree At>
[[nodiscard]] auto kinematic_hessian(const kinematic_tree& tree, const X& q, Frame, const At& at) {
  using S = detail::tree_scalar<X>;
  const detail::joint_coordinates<S, X> x(tree.table(), q);
  const detail::relative_motion<S> motion(tree.table(), x, tree.view(at));
  std::vector<detail::tree_columns<S, 6>> result;
  for (int j = 0; j < tree.size(); ++j) {
    result.push_back(detail::jacobian_rate_of<Frame>(tree.table(), motion, x,
                                                     detail::unit_velocities(tree.table(), j)));
  }
  return result;
}

template <VectorLike X>
DUET_REFUSED("name the frame and the axes: jacobian(tree, q, frame::hybrid, tree.link(\"hand\"))")
Eigen::MatrixXd jacobian(const kinematic_tree&, const X&);
template <VectorLike X, FrameConstant Frame>
DUET_REFUSED("name the frame: jacobian(tree, q, frame::hybrid, tree.link(\"hand\"))")
Eigen::MatrixXd jacobian(const kinematic_tree&, const X&, Frame);

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
    detail::add_to_column(result, table.sources[std::size_t(screw.coordinate)], 1 / masses[0].mass,
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
  const detail::tree_table& table = tree.table();
  const detail::joint_coordinates<S, X> x(table, q);
  const auto motion = detail::motion_of_all<S>(table, x);
  const auto masses = detail::carried_masses(table, motion);
  detail::tree_columns<S, 3> result(3, Eigen::Index(table.names.size()));
  result.setConstant(S(0));
  // A coordinate moves c by (m v + ω × h)/M per unit: m and h are the mass and moment that it
  // carries, [v; ω] is its screw.
  for (const detail::tree_screw<S>& screw : motion.screws) {
    const detail::subtree_mass<S>& carried = masses[std::size_t(screw.at) + 1];
    add_to_column(result, table.sources[std::size_t(screw.coordinate)], 1 / masses[0].mass,
                  S(carried.mass) * screw.twist.v + cross(screw.twist.omega, carried.moment));
  }
  return result;
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
