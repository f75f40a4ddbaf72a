# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# What duet costs the compiler: a header alone, and thirty functions over duals beside the same
# functions over double; arms as formulas with their Jacobians. The least of several runs.
#
# cmake -Dcompile=<compiler and flags> -Dfolder=<for files> -P compile_time.cmake

cmake_minimum_required(VERSION 3.22)

file(MAKE_DIRECTORY ${folder})

function(measure name code)
  set(file ${folder}/${name}.cpp)
  file(WRITE ${file} "${code}")
  set(best 1000000000)
  foreach(run RANGE 4)
    string(TIMESTAMP before "%s%f" UTC)
    execute_process(COMMAND ${compile} -c ${file} -o ${file}.o RESULT_VARIABLE result
      ERROR_VARIABLE log)
    string(TIMESTAMP after "%s%f" UTC)
    if(NOT result EQUAL 0)
      message(FATAL_ERROR "${name} does not compile\n${log}")
    endif()
    math(EXPR time "(${after} - ${before}) / 1000")
    if(time LESS best)
      set(best ${time})
    endif()
  endforeach()
  set(${name} ${best} PARENT_SCOPE)
  message("${name}: ${best} ms")
endfunction()

set(snippets "")
foreach(i RANGE 1 30)
  string(APPEND snippets "S f${i}(const S& x, const S& y) {
  using namespace std;
  const S a = x * y + ${i};
  const S b = sin(a) * exp(-x * x) / (1 + y * y);
  return a > b ? a * b + sqrt(1 + b * b) : cos(b) - a / ${i};
}
")
endforeach()

measure(dual_header "#include <duet/dual/dual.hpp>\n")
measure(math_header "#include <duet/dual/math.hpp>\n")
measure(all_headers "#include <duet/duet.hpp>\n")
measure(snippets_double "#include <duet/dual/math.hpp>\nusing S = double;\n${snippets}")
measure(snippets_dual "#include <duet/dual/math.hpp>\nusing S = duet::dual<double>;\n${snippets}")
measure(snippets_dual_7
  "#include <duet/dual/math.hpp>\nusing S = duet::dual<double, 7>;\n${snippets}")

# Arms of that many turning joints, as formulas with their spatial Jacobians.
set(formula_headers "#include <duet/expression/jacobian.hpp>\n#include <duet/expression/symbol.hpp>\n")
function(measure_arm count)
  set(axes z y z y x)
  set(symbols "")
  foreach(i RANGE 1 ${count})
    math(EXPR k "${i} % 5")
    list(GET axes ${k} axis)
    string(APPEND symbols "constexpr symbol<\"t${i}\"> t${i};\n")
    list(APPEND factors "screw(axis::${axis}, t${i}) * slide(axis::x, 0.${i})")
    list(APPEND names t${i})
    list(APPEND values "t${i} = x[${i}]")
  endforeach()
  list(JOIN factors " * " arm)
  list(JOIN names ", " names)
  list(JOIN values ", " values)
  measure(arm_${count} "${formula_headers}using namespace duet::expression;
${symbols}
void evaluate(const double* x, double* result) {
  const auto arm = ${arm};
  const auto [tip, J] = jacobian(arm, wrt(${names}), duet::frame::spatial)(${values});
  Eigen::Map<Eigen::Matrix<double, 6, ${count}>>(result + 1) = J;
  *result = tip.w().value();
}
")
endfunction()
measure(formula_headers_alone "${formula_headers}")
measure_arm(7)
measure_arm(20)

math(EXPR percent "100 * ${snippets_dual} / ${snippets_double}")
message("thirty functions over dual<double> against double: ${percent} %")
