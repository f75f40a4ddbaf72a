#!/bin/sh
# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# scripts/release in clones of a repository that holds the project as it is: the same archive everywhere, of all
# files, which installs; and what it refuses.
#
# usage: sh release.sh <top of the project> <scratch folder> <CMake> <compiler>

set -eu
top=$1 folder=$2 cmake=$3 compiler=$4
if ! command -v git >/dev/null; then
  echo "SKIPPED: there is no git"
  exit
fi
rm -rf "$folder"
mkdir -p "$folder/origin"
# What this machine has configured for git is no part of it.
export GIT_CONFIG_GLOBAL=/dev/null GIT_CONFIG_NOSYSTEM=1
unset GIT_DIR GIT_WORK_TREE GIT_INDEX_FILE

fail() {
  echo "$*" >&2
  exit 1
}

cd "$folder/origin"
(cd "$top" && tar cf - --exclude=./build --exclude=./.git .) | tar xf -
git init -q .
git config user.name duet
git config user.email duet@placeholder.invalid
git add .
git commit -q -m "As it is"

# Elsewhere, later, with other settings: the same bits, which the checksum tells.
git clone -q "$folder/origin" "$folder/here"
git clone -q "$folder/origin" "$folder/there"
sh "$folder/here/scripts/release" >"$folder/said"
cd "$folder"
(
  umask 077
  export TZ=Asia/Tokyo
  git -C there config core.autocrlf true
  git -C there config tar.umask 0077
  sleep 1
  sh there/scripts/release out >said_there
)
version=$(sed -n 's/^#define DUET_VERSION_STRING "\(.*\)"$/\1/p' "$top/include/duet/core/version.hpp")
archive=duet-$version.tar.gz
grep -q "$folder/here/build/release/$archive" said || fail "says $(cat said)"
cmp "here/build/release/$archive" "out/$archive"
cmp "here/build/release/$archive.sha256" "out/$archive.sha256"
(cd out && sha256sum --quiet -c "$archive.sha256")

# It holds what was committed, and a project finds the headers that it installs.
tar xzf "out/$archive"
(cd "duet-$version" && find . -type f | sort) >files
(cd origin && git ls-files | sed 's,^,./,' | sort) >committed
cmp files committed
"$cmake" -S "duet-$version" -B build -D CMAKE_CXX_COMPILER="$compiler" -D DUET_BUILD_TESTS=OFF \
  -D DUET_BUILD_EXAMPLES=OFF -D DUET_BUILD_PROGRAMS=OFF -D DUET_BUILD_ROBOTICS=OFF -D DUET_BUILD_IO=OFF >/dev/null
"$cmake" --install build --prefix "$folder/prefix" >/dev/null
"$cmake" -S "$top/tests/consumer/find_package" -B consumer -D CMAKE_CXX_COMPILER="$compiler" \
  -D CMAKE_PREFIX_PATH="$folder/prefix" -D expected_prefix="$folder/prefix" >/dev/null

# usage: expect_refusal <words>
expect_refusal() {
  if sh here/scripts/release refused >said 2>&1; then
    fail "not refused: $1"
  fi
  grep -qF "$1" said || fail "in place of '$1' it says: $(cat said)"
  [ -z "$(ls refused)" ] || fail "refused, and yet there is $(ls refused)"
}

: >here/new_file
expect_refusal "duet: release: there are uncommitted changes:"
rm here/new_file
echo >>here/README.md
expect_refusal " M README.md"
git -C here checkout -q README.md

for file in CHANGELOG.md CITATION.cff packaging/vcpkg/duet/vcpkg.json packaging/conan/conanfile.py; do
  sed "s/$version/9.8.7/" "here/$file" >changed
  cp changed "here/$file"
  git -C here -c user.name=duet -c user.email=duet@placeholder.invalid commit -qam "Another version"
  expect_refusal "$file has version '9.8.7', include/duet/core/version.hpp has '$version'"
  git -C here reset -q --hard HEAD~1
done
sed "s/^\(## \[$version\]\).*/\1/" here/CHANGELOG.md >changed
cp changed here/CHANGELOG.md
git -C here -c user.name=duet -c user.email=duet@placeholder.invalid commit -qam "No day"
expect_refusal "CHANGELOG.md has no release date for version"
rm -rf here/.git
expect_refusal "is not the top of a git repository"
