#!/bin/sh
# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# Where there is no apt-get, `sh scripts/demo` says what to type. Systems are folders of stubs: PATH has nothing
# else, and headers are looked for below DUET_SETUP_ROOT.
#
# usage: sh setup.sh <top of the project> <folder for the systems>

set -eu
top=$1
folder=$2
rm -rf "$folder"
failures=0

# usage: command_of <system> <name> [line of a shell]
command_of() {
  mkdir -p "$folder/$1/bin"
  printf '#!/bin/sh\n%s\n' "${3-}" >"$folder/$1/bin/$2"
  chmod +x "$folder/$1/bin/$2"
}

# usage: system <name> <user id> <package manager> [line of a shell for it]
system() {
  command_of "$1" id "echo $2"
  command_of "$1" "$3" "${4-}"
  ln -s "$(command -v dirname)" "$folder/$1/bin/dirname"
}

# usage: header_of <system> <folder>/<header>
header_of() {
  mkdir -p "$(dirname "$folder/$1/root$2")"
  : >"$folder/$1/root$2"
}

# usage: expect <system> <status> <what is said> <script> [argument ...]
expect() {
  name=$1 status=$2 words=$3 script=$4
  shift 4
  got=0
  said=$(env -i PATH="$folder/$name/bin" DUET_SETUP_ROOT="$folder/$name/root" /bin/sh "$top/scripts/$script" "$@" 2>&1) || got=$?
  if [ "$got" -ne "$status" ] || [ "$said" != "$words" ]; then
    printf '%s: scripts/%s\n  says     %s, status %s\n  in place of %s, status %s\n' \
      "$name" "$script $*" "$said" "$got" "$words" "$status" >&2
    failures=$((failures + 1))
  fi
}

please="duet: packages are missing. Please install it:"

# Nothing there: all of it, each package once.
system fedora 1000 dnf
expect fedora 1 "$please sudo dnf install gcc-c++ cmake ninja-build gnuplot python3 eigen3-devel boost-devel expat-devel doctest-devel" demo
expect fedora 1 "$please sudo dnf install gcc-c++ cmake ninja-build gnuplot python3 eigen3-devel boost-devel expat-devel doctest-devel clang glibc-locale-source" \
  setup clang locales
system arch 1000 pacman
expect arch 1 "$please sudo pacman -S --needed gcc cmake ninja gnuplot python eigen boost expat doctest" demo --help
system mac 501 brew "[ \"\$*\" = --prefix ] && echo /opt/homebrew"
expect mac 1 "$please brew install gcc cmake ninja gnuplot python eigen boost doctest" demo
system none 1000 true
expect none 1 "duet: packages are missing. There is no apt-get, dnf, pacman or brew here; Debian calls it: g++ cmake ninja-build gnuplot-nox python3 libeigen3-dev libboost-dev libexpat1-dev libboost-program-options-dev doctest-dev" demo

# Commands there, headers in part; root needs no sudo.
system container 0 dnf
for name in g++ cmake ninja gnuplot python3; do command_of container $name; done
header_of container /usr/include/eigen3/Eigen/Core
header_of container /usr/local/include/doctest/doctest.h
header_of container /usr/include/expat.h
header_of container /usr/include/boost/version.hpp # and no program options
expect container 1 "$please dnf install boost-devel" setup

# All there: nothing is said. Homebrew's headers are where it says; there is no package for a locale.
system ready 501 brew "echo /opt/homebrew"
for name in g++ cmake ninja gnuplot python3; do command_of ready $name; done
for name in eigen3/Eigen/Core boost/version.hpp boost/program_options.hpp doctest/doctest.h; do
  header_of ready /opt/homebrew/include/$name
done
expect ready 0 "" setup locales

# Debian: what is missing is installed, by its names, as root or by sudo; what is there is not.
for name in debian ubuntu; do
  user=0
  [ $name = debian ] || user=1000
  system $name $user apt-get 'echo "apt-get $*"'
  command_of $name dpkg-query 'case "$*" in *doctest-dev | *lintian) echo installed ;; esac'
  for each in g++ cmake ninja python3; do command_of $name "$each"; done
  command_of $name cut 'echo 12' # the release of g++
  ln -s "$(command -v env)" "$folder/$name/bin/env"
done
missing="gnuplot-nox libeigen3-dev libboost-dev libexpat1-dev libboost-program-options-dev"
installing="duet: installing $missing
apt-get update -qq
apt-get install -y -qq --no-install-recommends $missing"
expect debian 0 "$installing" setup lintian
expect ubuntu 1 "duet: to install packages run as root, or install sudo. Missing: $missing" demo
command_of ubuntu sudo 'exec "$@"'
expect ubuntu 0 "$installing" setup

[ "$failures" -eq 0 ]
