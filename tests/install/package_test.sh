#!/bin/bash
# Makes the program's Debian package, unpacks it and runs it with nothing else of the project: a
# render to PNG and a small comparison with its report page.
# Usage: package_test.sh CPACK BUILD VERSION
set -u
cpack=$1 build=$2 version=$3
command -v dpkg-shlibdeps >/dev/null && command -v dpkg-deb >/dev/null || exit 77
# shellcheck source=tests/cli/checks.sh
source "$(dirname "$0")/../cli/checks.sh" root/usr/bin/lockstep

"$cpack" -G DEB --config "$build/CPackConfig.cmake" -B packages -D CPACK_COMPONENTS_ALL=program >log 2>&1 ||
  fail "cpack: $(tail -n 20 log)"
package=$(echo packages/lockstep_"$version"-1_*.deb)
[ -s "$package" ] || fail "no package: $(tail -n 20 log)"

control() { dpkg-deb -f "$package" "$1"; }
[ "$(control Package)" = lockstep ] || fail "name: $(control Package)"
[ "$(control Version)" = "$version-1" ] || fail "version: $(control Version)"
for library in libembree3 libopenexr libtbb libstdc++6 libopenimageio; do
  control Depends | grep -q "$library" || fail "does not depend on $library: $(control Depends)"
done
control Depends | grep -q -- -dev && fail "depends on headers: $(control Depends)"
dpkg-deb -c "$package" | awk '{print $2, $6}' >files
grep -v '^root/root ' files && fail "files are not root's"
for file in bin/lockstep share/man/man1/lockstep.1.gz share/doc/lockstep/copyright \
  share/bash-completion/completions/lockstep; do
  grep -q " ./usr/$file\$" files || fail "lacks usr/$file"
done
grep -qE '/include/|\.a$' files && fail "has what is liblockstep-dev's: $(grep -E '/include/|\.a$' files)"

dpkg-deb -x "$package" root || fail "cannot be unpacked"
run() { env -i PATH=/usr/bin:/bin HOME="$folder" "$program" "$@" >stdout 2>stderr </dev/null; }
run render cornell -o a.png --spp 1 --resolution 8x8 --threads 1 --quiet || fail "render: $(cat stderr)"
run compare cornell --samplers random,owen --spp 1,4 --seeds 2 --resolution 16x16 --reference-spp 16 \
  --threads 1 --quiet -o out || fail "compare: $(cat stderr)"
grep -q '</html>' out/report.html || fail "no report page"

finish
