// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/test.hpp"

#include <duet/comparison/judge_jacobian.hpp>
#include <duet/comparison/rigid_motions.hpp>
#include <duet/duet.hpp>

namespace test_comparison_judge_jacobian {
namespace {

using namespace duet;
using Eigen::Matrix3d, Eigen::MatrixXd, Eigen::Vector2d, Eigen::Vector3d;
using rotation_type = quaternion<double>;
using pose_type = dual_quaternion<double>;

Matrix3d hat(const Vector3d& v) {
  return (Matrix3d() << 0, -v[2], v[1], v[2], 0, -v[0], -v[1], v[0], 0).finished();
}

/// One or two slips of a handwritten Jacobian; 0 for a right one.
struct slip {
  int first = 0, second = 0;
  bool operator==(int k) const { return k != 0 && (first == k || second == k); }
};

bool has(const jacobian_judgement& j, const std::string& name, const std::string& block) {
  return std::any_of(j.slips.begin(), j.slips.end(), [&](const jacobian_slip& s) {
    return s.name.find(name) != s.name.npos && s.block.find(block) != s.block.npos;
  });
}

struct expected {
  int slip;
  const char* name;
  const char* block;
  int second = 0; ///< another slip that makes the named one of both
};

/// \param judge  the judgement on the Jacobian with given slips
template <class Judge>
void check_slips(const Judge& judge, const std::vector<expected>& single,
                 const std::vector<slip>& pairs) {
  const jacobian_judgement right = judge(slip{});
  CAPTURE(to_text(right));
  CHECK(right);
  CHECK(right.counts[0] == right.samples);
  for (const expected& e : single) {
    const jacobian_judgement j = judge(slip{e.slip, e.second});
    CAPTURE(e.slip);
    CAPTURE(e.second);
    CAPTURE(to_text(j));
    CHECK(j.outcome == verdict::disagrees);
    CHECK(has(j, e.name, e.block));
  }
  for (const slip& s : pairs) {
    const jacobian_judgement j = judge(s);
    CAPTURE(s.first);
    CAPTURE(s.second);
    CAPTURE(to_text(j));
    CHECK(j.outcome == verdict::disagrees);
    CHECK(j.slips.empty());
    CHECK(to_text(j).find("no single slip explains it") != std::string::npos);
  }
}

TEST_CASE("a pinhole camera: slips in blocks, and in factors of the chain") {
  const auto f = [](const auto& q, const auto& t, const auto& p, const auto& a) {
    const auto r = rotate(q, p);
    using S = std::decay_t<decltype(a * (r[0] + t[0]))>;
    const S x = r[0] + t[0], y = r[1] + t[1], z = r[2] + t[2];
    return Eigen::Matrix<S, 2, 1>(a * x / z, a * y / z);
  };
  const auto inputs = sampler(rotations{}, vectors<3>{1}, vectors<3>{2}, real_numbers{1, 3})
                          .named("q", "t", "p", "a")
                          .where([](const auto& q, const auto& t, const auto& p, double) {
                            return std::abs(rotate(q, p)[2] + t[2]) > .2;
                          });
  const auto judge = [&](slip s) {
    return judge_jacobian(
        "camera", f,
        [s](const rotation_type& q, const Vector3d& t, const Vector3d& p, double a) {
          const Matrix3d r = rotation_matrix(q);
          const Vector3d x = r * p + t;
          Eigen::Matrix<double, 2, 3> by_point;
          by_point << a / x[2], 0, -a * x[0] / (x[2] * x[2]), 0, a / x[2],
              -a * x[1] / (x[2] * x[2]);
          by_point(0, 2) *= s == 1 ? -1 : 1;
          by_point(1, 2) *= s == 2 ? x[2] : 1;
          by_point(0, 2) = s == 3 ? by_point(1, 2) : by_point(0, 2);
          const Matrix3d by_rotation = s == 4    ? Matrix3d(r * hat(p))
                                       : s == 5  ? Matrix3d(-hat(p) * r)
                                       : s == 6  ? Matrix3d(-hat(r * p))
                                       : s == 7  ? Matrix3d(-hat(x))
                                       : s == 8  ? Matrix3d(-r.transpose() * hat(p))
                                       : s == 9  ? Matrix3d(-r * hat(p + t))
                                       : s == 10 ? Matrix3d(-hat(p))
                                                 : Matrix3d(-r * hat(p));
          const Matrix3d by_p = s == 11 ? Matrix3d(r.transpose()) : r,
                         by_t = s == 12 ? r : Matrix3d(Matrix3d::Identity());
          Eigen::Matrix<double, 2, 10> j;
          j << by_point * by_rotation * (s == 13 ? .5 : 1), by_point * by_t, by_point * by_p,
              Vector2d(x[0] / x[2], x[1] / x[2]) * (s == 14 ? a : 1);
          if (s == 15) {
            j.leftCols<3>().swap(j.middleCols<3>(3));
          }
          if (s == 16) { // one use of the outer factor
            by_point(0, 2) *= -1;
            j.middleCols<3>(6) = by_point * r;
          }
          if (s == 17) {
            j.leftCols<3>() = by_point * -r * hat(x);
          }
          return j;
        },
        inputs, {.samples = 20});
  };
  check_slips(judge,
              {{1, "sign", "entry (0, 2) of d f / d (q p + t)"},
               {2, "wrong factor: times (q p + t)[2]", "entry (1, 2) of d f / d (q p + t)"},
               {3, "wrong index: entry (1, 2)", "entry (0, 2) of d f / d (q p + t)"},
               {4, "sign", "d f / d q"},
               {5, "offset in other axes: p in those of q", "d (q p) / d q"},
               {6, "left perturbation for right", "d f / d q"},
               {7, "moment arm about another point: off by t, and the other side", "d f / d q"},
               {8, "conjugate rotation of q", "d (q p) / d q"},
               {9, "moment arm about another point: off by t", "d f / d q"},
               {10, "evaluated with q = identity", "d (q p) / d q"},
               {11, "Ad(q)^-2", "d f / d p"},
               {12, "multiplied by Ad(q) from the right", "d f / d t"},
               {13, "half angle for full angle: factor 1/2", "d f / d q"},
               {14, "scaled by a", "d f / d a"},
               {15, "permuted or shifted: columns 3, 4, 5, 0, 1, 2", "d f"},
               {16, "sign", "entry (0, 2) of d f / d (q p"},
               {17, "moment arm about another point: (q p + t) instead", "d f / d q"},
               {1, "sign", "entry (0, 2) of d f / d (q p + t)", 16}, // in two of three uses
               {4, "scaled by a constant, -0.5", "d f / d q", 13},
               {8, "conjugate rotation of q", "all of d (q p + t)", 11}},
              {{1, 4}, {6, 11}, {13, 14}});
}

TEST_CASE("a camera in the world: a slip behind a point moved back") {
  const auto f = [](const auto& q, const auto& t, const auto& p) {
    const auto y = rotate(conj(q), (p - t).eval());
    using S = std::decay_t<decltype(y[0] / y[2])>;
    return Eigen::Matrix<S, 2, 1>(y[0] / y[2], y[1] / y[2]);
  };
  const auto inputs = sampler(rotations{}, vectors<3>{1}, vectors<3>{2})
                          .named("q", "t", "p")
                          .where([](const auto& q, const auto& t, const auto& p) {
                            return std::abs(rotate(conj(q), Vector3d(p - t))[2]) > .2;
                          });
  const auto judge = [&](slip s) {
    return judge_jacobian("image", f,
                          [s](const rotation_type& q, const Vector3d& t, const Vector3d& p) {
                            const Matrix3d back = rotation_matrix(q).transpose();
                            const Vector3d y = back * (p - t);
                            const double w = 1 / y[2];
                            MatrixXd by_point(2, 3), moved(3, 9);
                            by_point << w, 0, (s == 1 ? 1 : -1) * y[0] * w * w, 0, w, -y[1] * w * w;
                            moved << (s == 2 ? -1 : 1) * hat(y), -back, back;
                            return MatrixXd(by_point * moved);
                          },
                          inputs, {.samples = 60});
  };
  check_slips(judge, {{1, "sign", "d f / d (q^-1 (t - p))"}, {2, "sign", "d f / d q"}}, {{1, 2}});
}

TEST_CASE("rotation between two rotations: branches, sheets and Jacobians of exp") {
  const auto f = [](const auto& a, const auto& b) { return rotation_vector(conj(a) * b); };
  const auto inputs = sampler(rotations{3.1}, rotations{3.1})
                          .named("a", "b")
                          .where([](const auto& a, const auto& b) {
                            return rotation_vector(conj(a) * b).norm() < 3.1;
                          });
  const auto judge = [&](slip s) {
    return judge_jacobian("difference", f,
                          [s](const rotation_type& a, const rotation_type& b) {
                            const Vector3d e = rotation_vector(conj(a) * b);
                            const Matrix3d one = Matrix3d::Identity(),
                                           right = right_jacobian_inverse(e),
                                           left = left_jacobian_inverse(e);
                            const double angle = e.norm();
                            Eigen::Matrix<double, 3, 6> j;
                            j << (s == 1   ? Matrix3d(-one)
                                  : s == 2 ? Matrix3d(left)
                                  : s == 3 ? Matrix3d(-left * rotation_matrix(a).transpose())
                                           : Matrix3d(-left)),
                                (s == 4                            ? left
                                 : s == 5                          ? Matrix3d(right.inverse())
                                 : s == 6 && angle < 1e-3          ? Matrix3d(one - .5 * hat(e))
                                 : s == 7                          ? Matrix3d(one + .5 * hat(e))
                                 : s == 8 && (conj(a) * b).w() < 0 ? Matrix3d(-right)
                                 : s == 9 && angle > 3             ? Matrix3d(right + .1 * one)
                                 : s == 10                         ? Matrix3d(one)
                                                                   : right);
                            return j;
                          },
                          inputs, {.samples = 60});
  };
  check_slips(judge,
              {{1, "right only at the identity", "d f / d a"},
               {2, "sign", "d f / d a"},
               {3, "left perturbation for right", "d f / d a"},
               {4, "transposed", "d f / d b"},
               {5, "Jacobian of the inverse", "d f / d b"},
               {6, "branch of small values: angle of a^-1 b", "d f / d b"},
               {7, "right only at the identity: angle of a^-1 b", "d f / d b"},
               {8, "sheet of the double cover", "d f / d b"},
               {9, "branch beside a half turn: angle of a^-1 b", "d f / d b"},
               {10, "right only at the identity", "d f / d b"},
               {1, "another state: b for a", "all of d f", 10}},
              {{2, 4}, {1, 8}, {3, 6}, {6, 7}, {6, 10}});
}

TEST_CASE("pose between two poses: blocks of adjoints") {
  const auto f = [](const auto& a, const auto& b) { return conj(a) * b; };
  const auto inputs = sampler(rigid_motions{}, rigid_motions{}).named("A", "B");
  const auto judge = [&](slip s) {
    return judge_jacobian(
        "relative pose", f,
        [s](const pose_type& a, const pose_type& b) {
          MatrixXd by_a = -Ad(pose_type(conj(b) * a));
          const MatrixXd exact = by_a;
          if (s == 1) {
            by_a = exact.inverse();
          } else if (s == 2) {
            by_a.topRightCorner<3, 3>().setZero();
          } else if (s == 3) {
            by_a.topRightCorner<3, 3>() *= -1;
          } else if (s == 4) {
            by_a << exact.bottomRightCorner<3, 3>(), exact.bottomLeftCorner<3, 3>(),
                exact.topRightCorner<3, 3>(), exact.topLeftCorner<3, 3>();
          } else if (s == 5) {
            by_a = -Ad(a);
          } else if (s == 6) {
            by_a.row(4) *= -1;
          }
          return std::tuple(by_a, MatrixXd(MatrixXd::Identity(6, 6) * (s == 7 ? -1 : 1)));
        },
        inputs, {.samples = 20});
  };
  check_slips(judge,
              {{1, "Jacobian of the inverse", "d f / d A"},
               {2, "missing: zero", "d f.translation / d A.rotation"},
               {3, "sign", "d f.translation / d A.rotation"},
               {4, "rows and columns [omega; v] for [v; omega]", "d f / d A"},
               {5, "evaluated with B = identity", "d f / d A"},
               {6, "sign", "row 4 of d f / d A"},
               {7, "sign", "d f / d B"}},
              {{3, 7}});
}

TEST_CASE("integrated rotation: time steps") {
  const auto f = [](const auto& q, const auto& w, const auto& h) {
    using S = std::decay_t<decltype(w[0] * h)>;
    return q * from_rotation_vector(vector3<S>(w[0] * h, w[1] * h, w[2] * h));
  };
  const auto inputs = sampler(rotations{}, vectors<3>{2}, real_numbers{.1, 1}).named("q", "w", "h");
  const auto judge = [&](slip s) {
    return judge_jacobian("integration", f,
                          [s](const rotation_type& q, const Vector3d& w, double h) {
                            const Vector3d r = w * h;
                            const Matrix3d moved = rotation_matrix(from_rotation_vector(r)),
                                           right = right_jacobian(r);
                            Eigen::Matrix<double, 3, 7> j;
                            j << (s == 1 ? moved : Matrix3d(moved.transpose())),
                                (s == 2   ? right
                                 : s == 3 ? Matrix3d(left_jacobian(r) * h)
                                 : s == 4 ? Matrix3d(Matrix3d::Identity() * h)
                                 : s == 5 ? Matrix3d(right_jacobian(w) * h)
                                          : Matrix3d(right * h)),
                                (s == 6 ? Vector3d(rotation_matrix(q) * w) : w);
                            return j;
                          },
                          inputs, {.samples = 20});
  };
  check_slips(judge,
              {{1, "transposed", "d f / d q"},
               {2, "scaled by h^-1", "d f / d w"},
               {3, "transposed", "d f / d w"},
               {4, "evaluated with 0 for w", "d f / d w"},
               {5, "evaluated with 1 for h, then multiplied by it", "d f / d w"},
               {6, "spatial for body axes", "d f / d h"}},
              {{3, 6}});
}

TEST_CASE("a direction: powers of the length, and no slip at the singularity") {
  const auto f = [](const auto& p, const auto& t) {
    using std::sqrt;
    using S = std::decay_t<decltype(p[0] - t[0])>;
    const S x = p[0] - t[0], y = p[1] - t[1], z = p[2] - t[2], d = sqrt(x * x + y * y + z * z);
    return Eigen::Matrix<S, 3, 1>(x / d, y / d, z / d);
  };
  const auto inputs =
      sampler(vectors<3>{2}, vectors<3>{1}).named("p", "t").where([](const auto& p, const auto& t) {
        return (p - t).norm() > .1;
      });
  const auto judge = [&](slip s) {
    return judge_jacobian(
        "direction", f,
        [s](const Vector3d& p, const Vector3d& t) {
          const double d = (p - t).norm();
          const Vector3d u = (p - t) / d;
          const Matrix3d m = (Matrix3d::Identity() - u * u.transpose()) / d;
          Eigen::Matrix<double, 3, 6> j;
          j << (s == 1 ? d : 1) * (s == 2 ? -1 : 1) * m, (s == 3 ? 1 / d : 1) * -m;
          j.row(1) *= s == 4 ? 3 : 1;
          j(0, 4) *= s == 5 ? 7 : 1;
          return j;
        },
        inputs);
  };
  check_slips(judge,
              {{1, "scaled by |p - t|", "d f / d p"},
               {2, "sign", "d f / d p"},
               {3, "scaled by |p - t|^-1", "d f / d t"}},
              {{1, 3}, {3, 4}, {4, 5}, {2, 5}});
}

TEST_CASE("a gyroscope: slips in the rotation by a rate less its bias") {
  const auto f = [](const auto& q, const auto& w, const auto& b, const auto& h) {
    using S = std::decay_t<decltype((w[0] - b[0]) * h * q.w())>;
    const vector3<S> r((w[0] - b[0]) * h, (w[1] - b[1]) * h, (w[2] - b[2]) * h);
    return rotation_vector(quaternion<S>(conj(from_rotation_vector(r)) * q));
  };
  const auto inputs = sampler(rotations{1.5}, vectors<3>{2}, vectors<3>{.5}, real_numbers{.1, .5})
                          .named("q", "w", "b", "h");
  const auto judge = [&](slip s) {
    return judge_jacobian(
        "gyroscope", f,
        [s](const rotation_type& q, const Vector3d& w, const Vector3d& b, double h) {
          const vector3<double> r = h * (w - b);
          const rotation_type e = conj(from_rotation_vector(r)) * q;
          const Matrix3d outer = right_jacobian_inverse(rotation_vector(e));
          const Matrix3d back = outer * rotation_matrix(e).transpose();
          const Matrix3d inner = h * right_jacobian(r);
          Matrix3d by_b = back * inner;
          by_b = s == 1   ? Matrix3d(back * h)
                 : s == 2 ? Matrix3d(back * h * left_jacobian(r))
                 : s == 3 ? Matrix3d(back * h * right_jacobian(vector3<double>(h * w)))
                 : s == 4 ? Matrix3d(by_b / h)
                 : s == 5 ? Matrix3d(back * h * right_jacobian_inverse(r))
                 : s == 6 ? Matrix3d(back * h * right_jacobian(vector3<double>(r / 2)))
                 : s == 7 ? Matrix3d(outer * inner)
                          : by_b;
          Eigen::Matrix<double, 3, 10> j;
          j << outer, -back * inner, by_b, -back * (w - b);
          return j;
        },
        inputs);
  };
  check_slips(judge,
              {{1, "right only at the identity of (exp((w - b) h))", "d (exp((w - b) h)) / d b"},
               {2, "adjoint: multiplied by Ad((exp((w - b) h)))", "d (exp((w - b) h)) / d b"},
               {3, "evaluated with 0 for b", "d (exp((w - b) h)) / d b"},
               {4, "scaled by h^-1", "d f / d b"},
               {5, "twice (Jacobian for its inverse)", "d (exp((w - b) h)) / d b"},
               {6, "evaluated with half of h, and the factor right", "d (exp((w - b) h)) / d b"},
               {7, "multiplied by Ad(exp(f)) from the left", "d f / d b"}},
              {});
}

TEST_CASE("derivatives by stored numbers of rotations and poses, in both orders and sides") {
  const auto f = [](const auto& a, const auto& p) { return transform_point(a, p); };
  const auto inputs = sampler(rigid_motions{}, vectors<3>{1}).named("A", "p");
  for (const bool is_usual : {true, false}) {
    const auto order = is_usual ? quaternion_order::wxyz : quaternion_order::xyzw;
    const auto side = is_usual ? perturbation::right : perturbation::left;
    const auto judge = [&](slip s) {
      return judge_jacobian(
          "moved point", f,
          [&](const pose_type& a, const Vector3d& p) {
            const rotation_type q = rotation(a);
            const Vector3d v(q.x(), q.y(), q.z());
            const double sign = s == 2 ? -1 : 1;
            const Vector3d by_w = 2 * q.w() * p + 2 * (s == 3 ? -1 : 1) * v.cross(p);
            Matrix3d by_v = -2 * p * v.transpose() + 2 * v.dot(p) * Matrix3d::Identity() +
                            2 * v * p.transpose() - 2 * sign * q.w() * hat(p);
            by_v(0, 1) *= s == 1 ? -1 : 1;
            Eigen::Matrix<double, 3, 10> j;
            if ((order == quaternion_order::wxyz) != (s == 4)) {
              j << Matrix3d::Identity(), by_w, by_v, rotation_matrix(q);
            } else {
              j << Matrix3d::Identity(), by_v, by_w, rotation_matrix(q);
            }
            if (s == 6) { // the translation's columns are right
              j.middleCols<4>(3) << Matrix3d((side == perturbation::right ? -1 : 1) *
                                             rotation_matrix(q) * hat(p)),
                  Vector3d::Zero();
              if (side == perturbation::left) {
                j.middleCols<3>(3) = -hat(rotation_matrix(q) * p);
              }
            }
            if (s == 5) {
              j.middleCols<4>(3) << (side == perturbation::right
                                         ? Matrix3d(-rotation_matrix(q) * hat(p))
                                         : Matrix3d(-hat(rotation_matrix(q) * p + translation(a)))),
                  Vector3d::Zero();
              j.leftCols<3>() =
                  side == perturbation::right ? rotation_matrix(q) : Matrix3d(Matrix3d::Identity());
            }
            return j;
          },
          inputs, {.samples = 20, .side = side, .order = order});
    };
    check_slips(judge,
                {{1, "sign", "entry (0, 2) of d f / d A, by stored numbers"},
                 {2, "sign of A[0]", "d f / d A[1..3], by stored numbers"},
                 {3, "the vector part of A x p", "column 0 of d f / d A, by stored numbers"},
                 {4, order == quaternion_order::wxyz ? "w last for w first" : "w first for w last",
                  "d / d A"},
                 {5, "missing chart factor", "d / d A"},
                 {6, "missing chart factor", "d / d A"}},
                {{3, 4}});
  }
}

TEST_CASE("an accelerometer: terms with constants that the function has captured") {
  const Vector3d arm(.4, -.7, .2);
  const auto f = [arm](const auto& w, const auto& b) {
    using S = std::decay_t<decltype(w[0] + b[0])>;
    const vector3<S> rate(w[0], w[1], w[2]), r{S(arm[0]), S(arm[1]), S(arm[2])};
    const vector3<S> a = rate.cross(vector3<S>(rate.cross(r)));
    return vector3<S>(a[0] + b[0], a[1] + b[1], a[2] + b[2]);
  };
  const auto inputs = sampler(vectors<3>{2}, vectors<3>{1}).named("w", "b");
  const auto judge = [&](slip s) {
    return judge_jacobian("accelerometer", f,
                          [s, arm](const Vector3d& w, const Vector3d&) {
                            const Matrix3d one = Matrix3d::Identity();
                            const Matrix3d by_w = (s == 1 ? -1 : 1) * w.dot(arm) * one +
                                                  (s == 2 ? -1 : 1) * w * arm.transpose() -
                                                  (s == 3 ? 1 : 2) * arm * w.transpose();
                            const Matrix3d by_b =
                                Vector3d(1, s == 5 ? 1.3 : 1, s == 5 ? .7 : 1).asDiagonal();
                            Eigen::Matrix<double, 3, 6> j;
                            j << (s == 4 ? Matrix3d(-hat(w) * hat(arm)) : by_w), by_b;
                            return j;
                          },
                          inputs, {.samples = 20});
  };
  check_slips(judge,
              {{1, "(w . c) 1, c = (-0.8, 1.4, -0.4)", "d f / d w"},
               {2, "w c^T", "d f / d w"},
               {3, "c w^T", "d f / d w"},
               {4, "the cross matrix of w x c", "d f / d w"}},
              {{1, 2}, {2, 3}, {5, 0}});
}

TEST_CASE("constants: arguments without columns, named in chains and as axes of joints") {
  const auto project = [](const auto& a, const auto& p, const auto& c, const auto& focal) {
    const auto z = rotate(c, vector3<scalar_t<std::decay_t<decltype(transform_point(a, p))>>>(
                                 transform_point(conj(a), p)));
    return Eigen::Matrix<std::decay_t<decltype(focal * z[0])>, 2, 1>(focal * z[0] / z[2],
                                                                     focal * z[1] / z[2]);
  };
  const auto cameras = sampler(rigid_motions{}, vectors<3>{2}, rotations{}, real_numbers{1, 3})
                           .named("T", "p", "C", "f0")
                           .where([](const auto& a, const auto& p, const auto& c, double) {
                             const vector3<double> y(transform_point(conj(a), p));
                             return std::abs(rotate(c, y)[2]) > .2 && std::abs(y[2]) > .1;
                           });
  const auto camera = [&](slip s, std::size_t constants) {
    return judge_jacobian(
        "camera", project,
        [s](const pose_type& a, const Vector3d& p, const rotation_type& c, double focal) {
          const Matrix3d back = rotation_matrix(rotation(a)).transpose(), r = rotation_matrix(c);
          const Vector3d y = transform_point(conj(a), p), z = s == 1 ? y : Vector3d(r * y);
          Eigen::Matrix<double, 2, 3> by_point;
          by_point << focal / z[2], 0, (s == 2 ? 1 : -1) * focal * z[0] / (z[2] * z[2]), 0,
              (s == 3 ? 1 : focal) / z[2], -focal * z[1] / (z[2] * z[2]);
          Eigen::Matrix<double, 3, 9> by_all;
          by_all << -Matrix3d::Identity(), hat(y), back;
          return Eigen::MatrixXd(by_point *
                                 (s == 4   ? Matrix3d(Matrix3d::Identity())
                                  : s == 5 ? r.transpose()
                                           : r) *
                                 by_all);
        },
        cameras, {.samples = 20, .constants = constants});
  };
  check_slips([&](slip s) { return camera(s, 2); },
              {{1, "in those of C^-1", "d f / d (T^-1 p)"},
               {2, "sign", "entry (0, 2) of d f / d (C (T^-1 p))"},
               {3, "scaled by f0^-1", "entry (1, 1) of d f / d (C (T^-1 p))"},
               {4, "multiplied by Ad(C)^-1", "d f / d (T^-1 p)"},
               {5, "multiplied by Ad(C)^-2", "d f / d (T^-1 p)"}},
              {{2, 4}, {2, 3}});
  CHECK_THROWS_WITH_AS(
      (void)camera({}, 1),
      "duet: judge_jacobian: the Jacobian is 2 x 9 (expected 2 x 12, or 14 columns "
      "for stored numbers; constants have none)",
      invalid_input);
  CHECK_THROWS_WITH_AS((void)camera({}, 4),
                       "duet: judge_jacobian: 4 constants (expected fewer than the 4 arguments)",
                       invalid_input);

  const auto tip = [](const auto& a, const auto& b, const auto& p, const auto& m, const auto& n,
                      const auto& d) {
    using S = std::decay_t<decltype(a * p[0])>;
    const auto by = [](const auto& t, const auto& axis) {
      return from_rotation_vector(vector3<S>(t * axis[0], t * axis[1], t * axis[2]));
    };
    const auto x = rotate(by(b, n), vector3<S>(p[0], p[1], p[2]));
    return rotate(by(a, m), vector3<S>(x[0] + d[0], x[1] + d[1], x[2] + d[2]));
  };
  const auto arm = [&](slip s) {
    return judge_jacobian(
        "arm", tip,
        [s](double a, double b, const Vector3d& p, const Vector3d& m, const Vector3d& n,
            const Vector3d& d) {
          const Matrix3d first = rotation_matrix(from_rotation_vector(vector3<double>(a * m))),
                         both =
                             first * rotation_matrix(from_rotation_vector(vector3<double>(b * n)));
          const Vector3d elbow = first * d, x = elbow + both * p,
                         axis = s == 1 ? n : Vector3d(first * n);
          Eigen::Matrix<double, 3, 5> j;
          j << m.cross(x),
              axis.cross(x - (s == 2   ? 0
                              : s == 3 ? -1
                                       : 1) *
                                 elbow),
              s == 4 ? first : both;
          j.leftCols<2>() *= s == 5 ? 57.29577951308232 : 1;
          return j;
        },
        sampler(real_numbers{-3, 3}, real_numbers{-3, 3}, vectors<3>{1}, vectors<3>{1},
                vectors<3>{1}, vectors<3>{1})
            .named("a", "b", "p", "m", "n", "d"),
        {.samples = 20, .constants = 3});
  };
  check_slips(arm,
              {{1, "Ad(exp(m a) exp(n b))^-1 from the left", "d (exp(n b)) / d b"},
               {2, "(exp(m a) n) x (exp(m a) d)", "d f / d b"},
               {3, "(exp(m a) n) x (exp(m a) d)", "d f / d b"},
               {4, "another rotation: that of exp(m a)", "d f / d p"},
               {5, "degrees", "all of d / d a to b"},
               {2, "another term instead: -1 f x n", "d f / d b", 1}},
              {{2, 4}, {3, 5}});
}

TEST_CASE("a hand and an eye: sums of an identity matrix and an adjoint") {
  const auto f = [](const auto& x, const auto& a, const auto& b) { return conj(x * b) * (a * x); };
  const auto inputs =
      sampler(rigid_motions{}, rigid_motions{}, rigid_motions{}).named("X", "A", "B");
  const auto judge = [&](slip s) {
    return judge_jacobian("hand and eye", f,
                          [s](const pose_type& x, const pose_type& a, const pose_type& b) {
                            const pose_type e = conj(x * b) * (a * x);
                            const MatrixXd one = MatrixXd::Identity(6, 6),
                                           m = Ad(pose_type(conj(e) * conj(b)));
                            MatrixXd by_b = -Ad(pose_type(conj(e)));
                            if (s == 4) { // in other axes of the result
                              const Matrix3d r = rotation_matrix(rotation(a));
                              by_b.topRows(3) = (r * by_b.topRows(3)).eval();
                              by_b.bottomRows(3) = (r * by_b.bottomRows(3)).eval();
                            }
                            const MatrixXd by_x =
                                s == 1   ? MatrixXd(one + m)
                                : s == 2 ? MatrixXd(one - Ad(pose_type(conj(b) * conj(e))))
                                : s == 3 ? MatrixXd(one - Ad(pose_type(conj(b))))
                                         : MatrixXd(one - m);
                            return std::tuple(by_x, MatrixXd(Ad(pose_type(conj(x)))), by_b);
                          },
                          inputs, {.samples = 10});
  };
  check_slips(judge,
              {{1, "sign of one summand: all but the identity matrix", "d f / d X"},
               {2, "exchanged factors: multiplied by Ad(f)", "d f / d X"},
               {3, "all but the identity matrix multiplied by Ad(f) from the left", "d f / d X"},
               {4, "multiplied by Ad(A.rotation) from the left", "d f / d B"}},
              {});
}

TEST_CASE("a moved twist: halves of vectors, and slips before the change of axes") {
  const auto f = [](const auto& t, const auto& xi) {
    const auto q = rotation(t);
    const auto p = translation(t);
    using S = std::decay_t<decltype(q.w() * xi[0])>;
    const vector3<S> v(rotate(q, vector3<S>(xi[0], xi[1], xi[2]))),
        w(rotate(q, vector3<S>(xi[3], xi[4], xi[5])));
    const vector3<S> u = vector3<S>(p[0], p[1], p[2]).cross(w);
    Eigen::Matrix<S, 6, 1> result;
    result << v[0] + u[0], v[1] + u[1], v[2] + u[2], w[0], w[1], w[2];
    return result;
  };
  const auto inputs = sampler(rigid_motions{}, vectors<6>{1}).named("T", "xi");
  const auto judge = [&](slip s) {
    return judge_jacobian("moved twist", f,
                          [s](const pose_type& t, const Eigen::Matrix<double, 6, 1>& xi) {
                            const Matrix3d v = hat(xi.head<3>()), w = hat(xi.tail<3>());
                            MatrixXd inner = MatrixXd::Zero(6, 6);
                            inner.topLeftCorner<3, 3>() = s == 1 ? v : w;
                            inner.bottomRightCorner<3, 3>() = w;
                            (s == 2 ? inner.bottomLeftCorner<3, 3>()
                                    : inner.topRightCorner<3, 3>()) = v;
                            const MatrixXd outer = Ad(t);
                            return std::tuple(MatrixXd(-outer * inner), outer);
                          },
                          inputs, {.samples = 20});
  };
  check_slips(judge,
              {{1, "another vector: xi[0..2] for [3..5]", "d f[0..2] / d T.translation"},
               {2, "rows and columns [omega; v] for [v; omega]", "d f / d T, in the axes of T"}},
              {{1, 2}});
}

TEST_CASE("rotation between two rotations and a captured one: branches where the result is zero") {
  const rotation_type m = from_rotation_vector(Vector3d(.3, -.2, .4));
  const auto f = [m](const auto& a, const auto& b) {
    using S = std::decay_t<decltype(a.w() * b.w())>;
    const quaternion<S> known{S(m.w()), S(m.x()), S(m.y()), S(m.z())};
    return rotation_vector(quaternion<S>(conj(known) * (conj(a) * b)));
  };
  const auto inputs = sampler(rotations{3.1}, rotations{3.1})
                          .named("a", "b")
                          .where([m](const auto& a, const auto& b) {
                            return rotation_vector(conj(m) * (conj(a) * b)).norm() < 3.05;
                          });
  const auto judge = [&](slip s) {
    return judge_jacobian("to a measured one", f,
                          [s, m](const rotation_type& a, const rotation_type& b) {
                            const rotation_type q = conj(m) * (conj(a) * b);
                            const Vector3d e = rotation_vector(q);
                            const Matrix3d right = right_jacobian_inverse(e);
                            const Matrix3d linear = Matrix3d::Identity() + .5 * hat(e);
                            const Matrix3d back = rotation_matrix(conj(b) * a);
                            Eigen::Matrix<double, 3, 6> j;
                            j << -right * (s == 4 ? rotation_matrix(a).transpose() : back),
                                (s == 1 && e.norm() < 1e-3  ? Matrix3d(linear - hat(e))
                                 : s == 2 && q.w() < 0      ? Matrix3d(-right)
                                 : s == 3                   ? linear
                                 : s == 5 && e.norm() > 2.9 ? linear
                                                            : right);
                            return j;
                          },
                          inputs, {.samples = 60});
  };
  check_slips(judge,
              {{1, "branch of small values: length of f", "d f / d b"},
               {2, "sheet of the double cover only: of a", "d f / d b"},
               {3, "wrong coefficient: a multiple of the squared cross matrix of f", "d f / d b"},
               {4, "another rotation: that of a^-1", "d (a^-1 b) / d a"},
               {5, "branch beside a half turn: length of f", "d f / d b"}},
              {{3, 4}});
}

TEST_CASE("a rotated vector: coefficients and axes in factors, and two slips that vanish at once") {
  const auto f = [](const auto& r, const auto& p) { return rotate(from_rotation_vector(r), p); };
  const auto inputs = sampler(vectors<3>{1.8}, vectors<3>{2}).named("r", "p");
  const auto judge = [&](slip s) {
    return judge_jacobian("rotated vector", f,
                          [s](const Vector3d& r, const Vector3d& p) {
                            const Matrix3d a = rotation_matrix(from_rotation_vector(r));
                            Matrix3d j = right_jacobian(r);
                            j += (s == 1 ? r.norm() : 0) * hat(r) * hat(r);
                            Eigen::Matrix<double, 3, 6> result;
                            result << (s == 2   ? Matrix3d(-hat(p) * a * j)
                                       : s == 3 ? Matrix3d(-a * hat(p + Vector3d(1, 2, 3)) * j)
                                                : Matrix3d(-a * hat(p) * j)),
                                (s == 4 ? Matrix3d(a.transpose() + 2 * hat(r.cross(p))) : a);
                            return result;
                          },
                          inputs, {.samples = 20});
  };
  check_slips(judge,
              {{1, "wrong coefficient: a multiple of the squared cross matrix of r", "d r"},
               {2, "exchanged factors: multiplied by Ad(exp(r))^-1", "d f / d r"},
               {3, "(exp(r)) times the cross matrix of c, c = (-1, -2, -3)", "d f / d (exp(r))"}},
              {{4, 0}});
}

TEST_CASE("formulas by stored numbers for a vector that is no argument") {
  const auto f = [](const auto& q, const auto& a, const auto& b, const auto& h) {
    using S = std::decay_t<decltype(q.w() * a[0] * b[0] * h)>;
    return rotate(conj(q), vector3<S>(a[0] - b[0] * h, a[1] - b[1] * h, a[2] - b[2] * h));
  };
  const auto inputs = sampler(rotations{}, vectors<3>{2}, vectors<3>{1}, real_numbers{.1, 1})
                          .named("q", "a", "b", "h");
  const auto judge = [&](slip s) {
    return judge_jacobian(
        "displacement", f,
        [s](const rotation_type& q, const Vector3d& a, const Vector3d& b, double h) {
          const Vector3d z = a - b * h;
          const Vector3d v = (s == 2 ? -1 : 1) * Vector3d(q.x(), q.y(), q.z());
          const Matrix3d back = rotation_matrix(q).transpose();
          Matrix3d by_v = v.dot(z) * Matrix3d::Identity() + v * z.transpose() - z * v.transpose() +
                          q.w() * hat(z);
          by_v(1, 0) += s == 3 ? q.w() * (z[0] - z[2]) : 0;
          Eigen::Matrix<double, 3, 11> j;
          j << 2 * (q.w() * z + (s == 1 ? 1 : -1) * v.cross(z)),
              2 * (s == 4 ? Matrix3d(by_v.transpose()) : by_v), back, -h * back, -back * b;
          return j;
        },
        inputs, {.samples = 20});
  };
  check_slips(judge,
              {{1, "the vector part of q x (q f)", "column 0 of d f / d q, by stored numbers"},
               {2, "conjugate rotation", "d f / d q, by stored numbers"},
               {3, "wrong index in one summand", "entry (1, 1) of d f / d q, by stored numbers"},
               {4, "transposed", "d f / d q[1..3], by stored numbers"},
               {1, "conjugate rotation", "d f / d q[1..3], by stored numbers", 2}},
              {{1, 3}});
}

TEST_CASE("blocks of other units, singular ones and their inverses hide no second slip") {
  for (const double unit : {1., 1e9, 1e-9}) {
    const auto f = [unit](const auto& q, const auto& t, const auto& p) {
      const auto r = rotate(q, p);
      using S = std::decay_t<decltype(r[0] + t[0])>;
      return vector3<S>(unit * r[0] + t[0], unit * r[1] + t[1], unit * r[2] + t[2]);
    };
    const auto inputs =
        sampler(rotations{}, vectors<3>{2 * unit}, vectors<3>{2}).named("q", "t", "p");
    const auto judge = [&](slip s) {
      return judge_jacobian("moved point", f,
                            [s, unit](const rotation_type& q, const Vector3d&, const Vector3d& p) {
                              const Matrix3d r = rotation_matrix(q);
                              Matrix3d by_q = (s == 1 ? 1 : -1) * unit * r * hat(p),
                                       by_t = Matrix3d::Identity();
                              if (s == 2) { // as the inverse of a singular matrix
                                by_q += 1e16 / unit * p * (r * p).transpose();
                              }
                              by_t = s == 3 ? Matrix3d::Zero() : s == 4 ? Matrix3d(-by_t) : by_t;
                              by_t = s == 5 ? Matrix3d(Vector3d(1.1, .9, 1.05).asDiagonal()) : by_t;
                              const Matrix3d by_p = unit * (s == 6 ? Matrix3d(r.transpose()) : r);
                              Eigen::Matrix<double, 3, 9> j;
                              j << (s == 7 ? 57.3 : 1) * by_q, by_t, by_p;
                              j.row(2) *= s == 8 ? -1 : 1;
                              return j;
                            },
                            inputs, {.samples = 40});
    };
    check_slips(judge,
                {{1, "sign", "d f / d q"},
                 {3, "missing: zero", "d f / d t"},
                 {4, "sign", "d f / d t"},
                 {6, "transposed", "d f / d p"},
                 {7, "scaled by a constant, 57.3", "d f / d q"},
                 {8, "sign", "row 2 of d f"}},
                {{2, 3}, {2, 4}, {2, 5}, {2, 6}, {5, 0}, {1, 5}, {5, 6}, {7, 4}, {3, 7}, {4, 8}});
  }
}

TEST_CASE("a constant of a wrong factor is named") {
  const auto f = [](double x) { return x * x * x; };
  const auto half = [](double x) { return std::array{-1.5 * x * x * x}; };
  CHECK(has(judge_jacobian("cube", f, half, sampler(real_numbers{1, 2}).named("x")),
            "wrong factor: times -0.5 x", "d f / d x"));
}

TEST_CASE("a curve: blocks of zeros, and entries of one column") {
  const auto f = [](const auto& u, const auto& a, const auto& b, const auto& c) {
    using S = std::decay_t<decltype(u * a[0])>;
    const S v = 1 - u;
    const auto at = [&](int i) { return v * v * a[i] + 2 * u * v * b[i] + 0 * c[i]; };
    return vector3<S>(at(0), at(1), at(2));
  };
  const auto inputs = sampler(real_numbers{0, 1}, vectors<3>{1}, vectors<3>{1}, vectors<3>{1})
                          .named("u", "a", "b", "c");
  const auto judge = [&](slip s) {
    return judge_jacobian("curve", f,
                          [s](double u, const Vector3d& a, const Vector3d& b, const Vector3d&) {
                            const double v = 1 - u;
                            const Vector3d by_u = -2 * v * a + 2 * (v - u) * b;
                            Eigen::Matrix<double, 3, 10> j = Eigen::Matrix<double, 3, 10>::Zero();
                            j.col(0) = s == 1 ? Vector3d(by_u[1], by_u[0], by_u[2]) : by_u;
                            j.middleCols<3>(s == 2 ? 7 : 1).diagonal().array() += v * v;
                            j.middleCols<3>(4).diagonal().array() += 2 * u * (s == 3 ? -v : v);
                            j(0, 9) += s == 4 ? u : 0;
                            j(1, 1) += s == 5 ? v : 0;
                            return j;
                          },
                          inputs, {.samples = 40});
  };
  check_slips(judge,
              {{1, "rows: 1, 0, 2", "d f / d u"},
               {2, "columns 0, 7, 8, 9, 4, 5, 6, 1, 2, 3", "d f"},
               {3, "sign", "d f / d b"},
               {4, "a multiple of u", "entry (0, 2) of d f / d c"}},
              {{1, 2}, {1, 3}, {2, 3}, {1, 4}, {3, 4}, {4, 5}});
}

TEST_CASE("round-off of code over double is told from slips, also beside one") {
  const auto f = [](const auto& r) { return from_rotation_vector(r); };
  const auto inputs = sampler(vectors<3>{3}).named("r");
  const auto naive = [](double sign) {
    return [sign](const Vector3d& r) {
      const double t = r.norm();
      return Matrix3d(Matrix3d::Identity() - sign * (1 - std::cos(t)) / (t * t) * hat(r) +
                      (t - std::sin(t)) / (t * t * t) * hat(r) * hat(r));
    };
  };
  const auto without_zero = inputs.without({0, 0, 0});
  const auto j = judge_jacobian("naive", f, naive(1), without_zero);
  CHECK(j.outcome == verdict::loses_precision);
  CHECK(j.counts[4] == 0);
  CHECK(j.slips.empty());
  CHECK(judge_jacobian("at 0", f, naive(1), inputs).outcome == verdict::not_finite);
  CHECK(has(judge_jacobian("left", f, naive(-1), without_zero), "transposed", "d f / d r"));
  const auto exact = [](const Vector3d& r) { return Matrix3d(right_jacobian(r)); };
  CHECK(judge_jacobian("exact", f, exact, inputs));
  const auto left = [](const Vector3d& r) { return Matrix3d(left_jacobian(r)); };
  CHECK(judge_jacobian("left", f, left, inputs, {.side = perturbation::left}));
}

TEST_CASE("functions over double alone are differentiated by differences") {
  const auto f = [](const Vector3d& r) -> rotation_type { return from_rotation_vector(r); };
  const auto inputs = sampler(vectors<3>{3}).named("r");
  const auto exact = [](const Vector3d& r) { return Matrix3d(right_jacobian(r)); };
  CHECK(judge_jacobian("exact", f, exact, inputs));
  const auto left = [](const Vector3d& r) { return Matrix3d(left_jacobian(r)); };
  CHECK(has(judge_jacobian("left", f, left, inputs), "transposed", "d f / d r"));
  // Noise of 1e-7 hides a relative error of 1e-7.
  const auto rough = [](double x) { return std::floor(std::sin(x) * 1e7) / 1e7; };
  const auto slope = [](double x) { return std::array{std::cos(x) * (1 + 1e-7)}; };
  const auto j = judge_jacobian("rough", rough, slope, sampler(real_numbers{-1, 1}));
  CHECK(j.outcome == verdict::inconclusive);
  CHECK(to_text(j).find("inconclusive at") != std::string::npos);
  const auto wrong = [](double x) { return std::array{-std::cos(x)}; };
  CHECK(judge_jacobian("rough", rough, wrong, sampler(real_numbers{-1, 1})).outcome ==
        verdict::disagrees);
}

TEST_CASE("round-off where the Jacobian vanishes, and of other entries beside a slip") {
  const auto f = [](const auto& q, const auto& t, const auto& a, const auto& b) {
    const auto x = rotate(q, a);
    return b[0] * (t[1] * x[2] - t[2] * x[1]) + b[1] * (t[2] * x[0] - t[0] * x[2]) +
           b[2] * (t[0] * x[1] - t[1] * x[0]);
  };
  const auto inputs =
      sampler(rotations{}, vectors<3>{1}, vectors<3>{2}, vectors<3>{2}).named("q", "t", "a", "b");
  const auto judge = [&](slip s) {
    return judge_jacobian(
        "epipolar constraint", f,
        [s](const rotation_type& q, const Vector3d& t, const Vector3d& a, const Vector3d& b) {
          const Matrix3d r = rotation_matrix(q);
          const Vector3d x = r * a, m = r.transpose() * b.cross(t);
          Eigen::Matrix<double, 1, 12> j;
          j << (s == 1 ? -1 : 1) * a.cross(m).transpose(),
              (s == 2 ? .5 : 1) * x.cross(b).transpose(), (s == 3 ? -1 : 1) * m.transpose(),
              t.cross(x).transpose();
          if (s == 4) { // columns exchanged in two blocks
            j.col(0).swap(j.col(1));
            j.col(10).swap(j.col(11));
          }
          return j;
        },
        inputs);
  };
  check_slips(judge,
              {{1, "sign", "d f / d q"}, {2, "half angle", "d f / d t"}, {3, "sign", "d f / d a"}},
              {{1, 2}, {2, 3}, {1, 3}, {4, 0}});
}

TEST_CASE("derivatives by stored numbers of one rotation beside those of another") {
  const auto f = [](const auto& a, const auto& b, const auto& p, const auto& t) {
    const auto y = rotate(b, p);
    using S = std::decay_t<decltype(y[0] + t[0])>;
    return rotate(a, vector3<S>(y[0] + t[0], y[1] + t[1], y[2] + t[2]));
  };
  const auto inputs =
      sampler(rotations{}, rotations{}, vectors<3>{2}, vectors<3>{2}).named("a", "b", "p", "t");
  const auto by_quaternion = [](const rotation_type& q, const Vector3d& p, double sign) {
    const Vector3d v(q.x(), q.y(), q.z());
    Eigen::Matrix<double, 3, 4> m; // of the rotation matrix of any norm
    m << 2 * (q.w() * p + v.cross(p)), 2 * (v.dot(p) * Matrix3d::Identity() + v * p.transpose() -
                                            p * v.transpose() - sign * q.w() * hat(p));
    return m;
  };
  const auto judge = [&](slip s) {
    return judge_jacobian(
        "two rotations", f,
        [&](const rotation_type& a, const rotation_type& b, const Vector3d& p, const Vector3d& t) {
          const Matrix3d r = rotation_matrix(a), back = rotation_matrix(b);
          Eigen::Matrix<double, 3, 4> by_a = by_quaternion(a, back * p + t, s == 1 ? -1 : 1),
                                      by_b = by_quaternion(b, p, s == 2 ? -1 : 1);
          by_a(0, 2) *= s == 3 ? -1 : 1;
          Eigen::Matrix<double, 3, 14> j;
          j << by_a, r * by_b, r * back, (s == 4 ? -1 : 1) * r;
          return j;
        },
        inputs, {.samples = 20});
  };
  check_slips(judge,
              {{1, "sign of a[0]", "d f / d a[1..3], by stored numbers"},
               {2, "sign of b[0]", "d f / d b[1..3], by stored numbers"},
               {3, "sign", "entry (0, 2) of d f / d a, by stored numbers"},
               {4, "sign", "d f / d t"}},
              {{1, 2}, {1, 4}, {3, 4}});
}

TEST_CASE("errors as small as what a hypothesis may leave, and terms that hide a second slip") {
  const auto f = [](const auto& a, const auto& b, const auto& v) {
    const auto q = conj(a) * b;
    using S = std::decay_t<decltype(q.w() + v[0])>;
    const vector3<S> e(rotation_vector(q));
    return std::tuple(e, vector3<S>(v[0] - 9.81, v[1], v[2]), conj(a));
  };
  const auto inputs = sampler(rotations{3.1}, rotations{3.1}, vectors<3>{2})
                          .named("a", "b", "v")
                          .where([](const auto& a, const auto& b, const auto&) {
                            return rotation_vector(conj(a) * b).norm() < 3.1;
                          });
  const auto judge = [&](slip s) {
    return judge_jacobian("differences", f,
                          [s](const rotation_type& a, const rotation_type& b, const Vector3d&) {
                            const Matrix3d one = Matrix3d::Identity();
                            const Vector3d e = rotation_vector(conj(a) * b);
                            MatrixXd j = MatrixXd::Zero(9, 9);
                            j.topLeftCorner<3, 3>() = -left_jacobian_inverse(e);
                            j.block<3, 3>(0, 3) = s == 1 && e.norm() < 2e-4
                                                      ? Matrix3d(one + .5 * hat(e))
                                                      : right_jacobian_inverse(e);
                            j.block<3, 3>(3, 6) = one;
                            j.block<3, 3>(6, 0) = s == 2 ? one : Matrix3d(-rotation_matrix(a));
                            if (s == 3) { // a constant error of two blocks
                              j.middleRows<3>(3).setConstant(.7);
                            }
                            return j;
                          },
                          inputs, {.samples = 100});
  };
  check_slips(judge, {}, {{2, 0}, {3, 0}});
  const jacobian_judgement j = judge({1});
  CAPTURE(to_text(j));
  CHECK(j.outcome == verdict::disagrees);
  CHECK(has(j, "only in the branch of small values: angle of a^-1 b", "d f[0] / d b"));
  for (const jacobian_slip& s : j.slips) {
    CHECK(s.name.find("only in the branch") == 0);
  }
}

TEST_CASE("what a Jacobian returns: matrices side by side, numbers row by row, wrong sizes") {
  const auto f = [](const auto& q, const auto& p) { return rotate(q, p); };
  const auto inputs = sampler(rotations{}, vectors<3>{1}).named("q", "p");
  const auto numbers = [](bool is_row_major) {
    return [is_row_major](const rotation_type& q, const Vector3d& p) {
      Eigen::Matrix<double, 3, 6> m;
      m << -rotation_matrix(q) * hat(p), rotation_matrix(q);
      std::array<double, 18> a{};
      for (std::size_t i = 0; i < 18; ++i) {
        a[i] = is_row_major ? m(Eigen::Index(i / 6), Eigen::Index(i % 6)) : m(Eigen::Index(i));
      }
      return a;
    };
  };
  CHECK(judge_jacobian("numbers", f, numbers(true), inputs));
  CHECK(has(judge_jacobian("numbers", f, numbers(false), inputs),
            "column-major data in a row-major array", "all of d f"));
  const auto square = [](const rotation_type&, const Vector3d&) { return Matrix3d(); };
  CHECK_THROWS_WITH_AS((void)judge_jacobian("size", f, square, inputs),
                       "duet: judge_jacobian: the Jacobian is 3 x 3 (expected 3 x 6, or 7 columns "
                       "for stored numbers)",
                       invalid_input);
  int calls = 0;
  const auto report = [&](const progress&) { return ++calls < 3; };
  CHECK_THROWS_AS((void)judge_jacobian("cancelled", f, numbers(true), inputs, {.report = report}),
                  cancelled);
  CHECK(calls == 3);
}

TEST_CASE("a judgement as text") {
  const auto f = [](const auto& q, const auto& p) { return rotate(q, p); };
  const auto wrong = [](const rotation_type& q, const Vector3d& p) {
    return std::tuple(Matrix3d(-rotation_matrix(q) * hat(p)),
                      Matrix3d(rotation_matrix(q).transpose()));
  };
  const auto j =
      judge_jacobian("point", f, wrong, sampler(rotations{}, vectors<3>{1}).named("q", "p"));
  const std::string text = to_text(j);
  CHECK(text.find("point: disagrees at ") == 0);
  CHECK(text.find("  slip: transposed (column-major data in a row-major array), in d f / d p\n") !=
        std::string::npos);
  CHECK(text.find("  simplest input: q = rotation by (1, 0, 0), p = (0, 0, 0)\n"
                  "    entry (1, 5): -0.8414709848, handwritten 0.8414709848\n"
                  "    derivative:\n") != std::string::npos);
  CHECK(j.simplest->input == "q = rotation by (1, 0, 0), p = (0, 0, 0)");
  CHECK(j.simplest->row == 1);
  CHECK(j.simplest->column == 5);
}

} // namespace
} // namespace test_comparison_judge_jacobian
