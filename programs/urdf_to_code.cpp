// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// duet-urdf-to-code: the forward kinematics of a robot description as code that needs no duet.

#include <duet/core/errors.hpp>
#include <duet/core/text/file.hpp>
#include <duet/core/text/printable.hpp>
#include <duet/core/version.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/expression/code/c.hpp>
#include <duet/expression/code/cpp.hpp>
#include <duet/expression/code/matlab.hpp>
#include <duet/expression/code/python.hpp>
#include <duet/io/urdf.hpp>
#include <duet/kinematics/chain_formula.hpp>

#include <boost/program_options.hpp>

#include <cstddef>
#include <exception>
#include <iostream>
#include <stdexcept>
#include <string>

namespace {

namespace po = boost::program_options;

constexpr int max_joints = 64;

constexpr const char* usage =
    "usage: duet-urdf-to-code robot.urdf base tip [options]\n\n"
    "Writes the pose of the link `tip` relative to the link `base`, the geometric\n"
    "Jacobian with columns [v; omega] and, on request, its rate as one function.\n"
    "Joints that carry neither link are left out; fixed joints are merged.\n"
    "Exit status: 0, or 1 with one line on standard error.\n\nOptions";

po::options_description options() {
  po::options_description result(usage);
  result.add_options()("language", po::value<std::string>()->default_value("c"),
                      "c, cpp (Eigen), python (NumPy) or matlab (Octave)")(
      "frame", po::value<std::string>()->default_value("spatial"),
      "axes of the Jacobian: spatial, body or hybrid")(
      "name", po::value<std::string>()->default_value("forward_kinematics"),
      "name of the function")("output", po::value<std::string>(),
                              "file to write (default: standard output)")(
      "float", "single precision, in C and C++")("no-jacobian", "without the Jacobian")(
      "jacobian-rate", "with the derivative of the Jacobian by time")("help", "this text")(
      "version", "version of duet");
  return result;
}

duet::expression::formula_graph formula_in(const duet::urdf_chain<max_joints>& chain,
                                           const std::string& frame,
                                           const duet::chain_formula_options& outputs) {
  if (frame == "spatial") {
    return duet::formula_of(chain, duet::frame::spatial, outputs);
  }
  if (frame == "body") {
    return duet::formula_of(chain, duet::frame::body, outputs);
  }
  if (frame == "hybrid") {
    return duet::formula_of(chain, duet::frame::hybrid, outputs);
  }
  throw std::runtime_error("--frame is '" + frame + "' (expected spatial, body or hybrid)");
}

std::string code_in(const std::string& language, const duet::expression::formula_graph& f,
                    const std::string& name, const duet::expression::code_options& how) {
  if (language == "c") {
    return duet::expression::to_c(f, name, how);
  }
  if (language == "cpp") {
    return duet::expression::to_cpp(f, name, how);
  }
  if (language == "python") {
    return duet::expression::to_python(f, name, how);
  }
  if (language == "matlab") {
    return duet::expression::to_matlab(f, name, how);
  }
  throw std::runtime_error("--language is '" + language +
                           "' (expected c, cpp, python or matlab)");
}

/// The sentences of the function's comment: links, joints in order, units.
std::string description(const duet::urdf_chain<max_joints>& chain, const std::string& base,
                        const std::string& tip, const std::string& frame) {
  std::string joints;
  for (const std::string& joint : chain.joint_names()) {
    joints += (joints.empty() ? "" : ", ") + joint;
  }
  return duet::printable("the pose of " + tip + " relative to " + base +
                         ", the Jacobian [v; omega] in " + frame +
                         " axes; theta in rad and units of length of the joints " + joints);
}

int run(int argc, char** argv) {
  po::options_description known = options();
  po::options_description hidden;
  hidden.add_options()("file", po::value<std::string>())("base", po::value<std::string>())(
      "tip", po::value<std::string>());
  po::options_description all;
  all.add(known).add(hidden);
  po::positional_options_description order;
  order.add("file", 1).add("base", 1).add("tip", 1);
  po::variables_map given;
  po::store(po::command_line_parser(argc, argv).options(all).positional(order).run(), given);
  if (given.count("help") > 0) {
    std::cout << known;
    return 0;
  }
  if (given.count("version") > 0) {
    std::cout << "duet-urdf-to-code " DUET_VERSION_STRING "\n";
    return 0;
  }
  if (given.count("tip") == 0) {
    throw std::runtime_error("a robot description, a base and a tip are needed (--help)");
  }
  const auto text = [&](const char* name) { return given[name].as<std::string>(); };
  const auto chain = duet::read_urdf<max_joints>(text("file"), text("base"), text("tip"));
  if (chain.size() == 0) {
    throw std::runtime_error("there is no movable joint between " + text("base") + " and " +
                             text("tip"));
  }
  const auto formula =
      formula_in(chain, text("frame"),
                 {.has_jacobian = given.count("no-jacobian") == 0,
                  .has_jacobian_rate = given.count("jacobian-rate") > 0});
  const std::string code =
      code_in(text("language"), formula, text("name"),
              {.description = description(chain, text("base"), text("tip"), text("frame")),
               .is_single_precision = given.count("float") > 0});
  if (given.count("output") > 0) {
    duet::write_file(text("output"), code);
  } else {
    std::cout << code << std::flush;
    if (!std::cout) {
      throw std::runtime_error("standard output: not all of it could be written");
    }
  }
  return 0;
}

} // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::string reason = error.what();
    reason.erase(0, reason.rfind("duet: ", 0) == 0 ? 6 : 0);
    std::cerr << duet::printable("duet-urdf-to-code: " + reason) << "\n";
    return 1;
  }
}
