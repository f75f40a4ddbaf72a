# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# Right and wrong claims, options, and exit statuses.
#
# cmake -Dprogram=<duet-check-formula> -Dversion=<version> -Dfolder=<for files> -P check_formula.cmake

cmake_minimum_required(VERSION 3.22)

file(REMOVE_RECURSE ${folder})
file(MAKE_DIRECTORY ${folder})

# Runs the program with the further arguments: its output, or for status 2 its one line of error, must match.
function(run expected_status expected_text)
  execute_process(COMMAND ${program} ${ARGN} WORKING_DIRECTORY ${folder}
    RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE error)
  if(NOT status EQUAL expected_status)
    message(FATAL_ERROR "${ARGN}: status ${status}, expected ${expected_status}\n${output}${error}")
  endif()
  set(text "${output}")
  if(status EQUAL 2)
    set(text "${error}")
    if(NOT error MATCHES "^(duet-check-formula: [^\n]*\n)+$")
      message(FATAL_ERROR "${ARGN}: says\n${error}")
    endif()
  endif()
  if(NOT text MATCHES "${expected_text}")
    message(FATAL_ERROR "${ARGN}: prints\n${text}without: ${expected_text}")
  endif()
endfunction()

# Derivatives of every function, against themselves in other words.
foreach(pair IN ITEMS "sqrt(x)|1/2/sqrt(x)" "cbrt(x)|x^(-2/3)/3" "exp(2x)|2exp(2x)" "exp2(x)|ln(2)*2^x" "expm1(x)|exp(x)"
    "log(x)|1/x" "log2(x)|1/x/ln(2)" "log10(x)|1/x/ln(10)" "log1p(x)|1/(1+x)" "sin(x)|cos(x)" "cos(x)|-sin(x)"
    "tan(x)|1/cos(x)^2" "asin(x)|(1-x^2)^-0.5" "acos(x)|-(1-x^2)^-0.5" "atan(x)|1/(1+x^2)" "sinh(x)|cosh(x)"
    "cosh(x)|sinh(x)" "tanh(x)|1/cosh(x)^2" "asinh(x)|1/sqrt(1+x^2)" "acosh(x)|1/sqrt(x^2-1)" "atanh(x)|1/(1-x^2)"
    "erf(x)|2/sqrt(pi)*exp(-x^2)" "erfc(x)|-2/sqrt(pi)*exp(-x^2)" "abs(x)|select(x < 0, -1, 1)" "x^7|7x^6" "x^-2|-2x^-3"
    "x^x|x^x*(ln(x)+1)" "2^(3x)|3*ln(2)*2^(3x)" "atan2(x, y)|y/(x^2+y^2)" "hypot(x, y)|x/hypot(x, y)" "floor(x)|0"
    "fmod(x, 3)|1" "remainder(y, x)|-round(y/x)" "fma(x, x, x)|2x+1" "x*y/(x+y)|y^2/(x+y)^2" "max(x, y)|select(x < y, 0, 1)"
    "stumpff0(x)|-stumpff1(x)/2" "stumpff2(x)|(2*stumpff4(x)-stumpff3(x))/2" "arc_ratio(x, y)|(y/(x+y^2)-arc_ratio(x, y))/(2*x)"
    "3|0")
  string(REPLACE "|" ";" pair "${pair}")
  list(GET pair 0 f)
  list(GET pair 1 derivative)
  run(0 "^agrees: " "${derivative}" --derivative-of "${f}" --wrt x)
  run(1 "^disagrees: " "${derivative} + 0.001" --derivative-of "${f}" --wrt x)
endforeach()
run(0 "^agrees" "-arc_ratio(y, x)/x + arc_ratio(y, x)/x - 1/(y + x^2)" --derivative-of "arc_ratio(y, x)" --wrt x)

# Vectors and rotations.
run(0 "^agrees" "2w" --derivative-of "dot(w, w)" --wrt w --vector w)
run(0 "^agrees" "cross(v, [1, 0, 0])" --derivative-of "cross(v, [x, 0, 0])" --wrt x --vector v)
run(0 "^agrees" "rotate(q*p, w)" --equals "rotate(q, rotate(p, w))" --rotation q,p --vector w)
run(1 "simplest input:  w = \\[" "rotate(q*p, w)" --equals "rotate(p, rotate(q, w))" --rotation q --rotation p --vector w)
run(0 "^agrees" "exp(t*w)" --equals "slerp(exp(0*w), exp(w), t)" --vector w --range w=-0.5:0.5)
run(2 "the claim has 3 numbers, and the other side has 1" "w" --equals 1 --vector w)

# What only many digits show, and what they must not.
run(0 "^agrees" "cos(x + pi/2)" --equals "-sin(x)")
run(0 "^agrees" "0.1x + 0.2x" --equals "0.3x")
run(0 "^agrees" "sqrt(2)*sin(x + pi/4)" --equals "sin(x) + cos(x)")
run(0 "hidden by round-off" "cosh(x)^2 - sinh(x)^2" --equals 1)
run(0 "^agrees" "atan2(y^2 + y, -x^2)" --equals "atan2(y*(y + 1), -x^2)") # 0 and -0 at y = -1
run(1 "^disagrees" "x + 1e-20" --equals "x")
run(0 "^agrees.*such as x = 0, where the claim has no value" "x/x" --equals 1)
run(0 "the claim loses more than half of the digits at x = 1e-08" "(1 - cos(x))/x^2" --equals "2 sin(x/2)^2/x^2")
run(2 "no input at which both sides have a value" "log(x)" --equals "log(x)" --range x=-2:-1)
run(0 "^agrees" "sqrt(x^2)" --equals x --range x=0:10)
run(1 "x = -1" "sqrt(x^2)" --equals x)

# Proofs, which cover the inputs without a value.
run(0 "proof: " "2 x*exp(x^2)" --derivative-of "exp(x^2)" --wrt x)
run(0 "proof: " "rotate(q*p, w)" --equals "rotate(q, rotate(p, w))" --rotation q,p --vector w)
run(0 "\"proved\":true" "2w" --derivative-of "dot(w, w)" --wrt w --vector w --json)
run(0 "\"one_sided\":1.*\"proved\":false" "x/x" --equals 1 --json)
run(1 "\"proved\":false" "x" --equals 1 --json)
run(0 "\"loses_digits_at\":{\"x\":\"1e-08\"}" "(1 - cos(x))/x^2" --equals "2 sin(x/2)^2/x^2" --json)

# Options.
run(0 "usage: .*--derivative-of FORMULA" --help)
run(0 "^duet-check-formula ${version}\n$" --version)
run(1 "^{\"verdict\":\"disagrees\",\"claim\":\"-x\",\"equals\":\"x\",.*\"input\":{\"x\":\"1\"}.*}\n$" "-x" --equals x --json)
run(2 "there is no claim" --equals x)
run(2 "expected either --derivative-of or --equals" x)
run(2 "belong together" x --derivative-of x)
run(2 "unrecognised option '--foo'" --foo)
run(2 "x[)]: column 2: expected an operator or the end of the formula, got '[)]'" "x)" --equals x)
run(2 "--range is 'x=1' .expected name=low:high." x --equals x --range x=1)
run(2 "the formula has no input 'y'" x --equals x --range y=1:2)
run(2 "% has no meaning here" "x%value%" --equals x)
run(2 "none: cannot be opened" --file none)
run(2 "gamma function has no formula" x --derivative-of "tgamma(x)" --wrt x)

file(WRITE ${folder}/claims.txt "# derivatives\n\n\"2 x\" --derivative-of x^2 --wrt x\r\nx --equals x\n")
run(0 "^agrees: 2 x as.*agrees: x = x" --file claims.txt)
file(APPEND ${folder}/claims.txt "x --equals y\n")
run(1 "disagrees: x = y" --file claims.txt)
file(APPEND ${folder}/claims.txt "x --equals\nx+ --equals x\n--file claims.txt\n")
run(2 "claims.txt:6: .*claims.txt:7: x[+]: column 3: .*claims.txt:8: --file in a file" --file claims.txt)
