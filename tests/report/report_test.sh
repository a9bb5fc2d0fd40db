#!/usr/bin/env bash
# Makes a small report with the program and looks at it in headless Chromium.
# Usage: report_test.sh PROGRAM WORK_FOLDER
# Skipped (status 77) where there is no Chromium, Node.js or npm, or where npm cannot fetch
# playwright-core; it is fetched once into the work folder.
set -uo pipefail
program=$1 work=$2
source=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

skip() {
  echo "SKIPPED: $*"
  exit 77
}

for tool in chromium node npm; do
  command -v "$tool" >/dev/null || skip "$tool is not installed (see tests/packages.txt)"
done

mkdir -p "$work" && cd "$work" || exit 1
cp "$source"/{package.json,package-lock.json,report_test.mjs} . || exit 1
if ! cmp -s package-lock.json installed-lock.json; then
  rm -f installed-lock.json
  timeout 100 npm ci --ignore-scripts --no-audit --no-fund --fetch-retries=1 >npm.log 2>&1 ||
    skip "npm could not fetch playwright-core: $(grep -v '^npm warn' npm.log | head -n 1)"
  cp package-lock.json installed-lock.json
fi

# A scene whose name is markup: the page must show it as text. Made-up triangles, seen from afar.
rm -rf page && mkdir page || exit 1
scene='page/<!--<script><img src=x onerror=alert(1)>&amp;.ply'
cat >"$scene" <<'PLY'
ply
format ascii 1.0
element vertex 4
property float x
property float y
property float z
element face 2
property list uchar int vertex_indices
end_header
-1 0 -1
1 0 -1
0 1.5 0
0 0 1
3 0 2 1
3 0 3 2
PLY
"$program" compare cornell "$scene" --samplers random,owen,rcs:c=8,strata --spp 1,4,16 --seeds 3 \
  --resolution 72x48 --reference-spp 64 --threads 1 --quiet -o page >compare.log 2>&1 || {
  cat compare.log
  exit 1
}
exec timeout 240 node report_test.mjs "$(command -v chromium)" "$PWD/page"
