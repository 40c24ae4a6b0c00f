#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes the pictures of noise.md anew: noise.sh PROGRAM. Needs ImageMagick and Python.
set -euo pipefail
(($# == 1)) || { echo "usage: noise.sh PROGRAM" >&2; exit 2; }
program="$(readlink -f "$1")"
here="$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
side=320

# histogram REPORT.json PICTURE.pgm: 256 bins from black to white, heights as square roots.
histogram() {
  python3 - "$1" "$2" "$side" <<'PYTHON'
import json, math, sys
report, out, side = sys.argv[1], sys.argv[2], int(sys.argv[3])
bins = [math.sqrt(n) for n in json.load(open(report))["histogram"]]
columns = [bins[x * 256 // side] * (side - 24) / max(bins) for x in range(side)]
rows = [bytes(40 if side - 12 - y <= h else 235 for h in columns) for y in range(side - 12)]
rows += [bytes(x * 255 // side for x in range(side))] * 12
open(out, "wb").write(b"P5 %d %d 255 " % (side, side) + b"".join(rows))
PYTHON
}

# row NAME PICTURE...: side by side, all of one size.
row() {
  local name="$1"
  shift
  convert "$@" -filter box -resize "${side}x$side" -background grey50 -bordercolor grey50 -border 2 +append \
    -colorspace gray -strip -define png:compression-level=9 "$here/noise_$name.png"
  echo "   noise_$name.png"
}

for layer in overcast broken few; do
  "$program" noise --preset "thesis-$layer" -o "$work/x.dds" --preview "$work/one.png" --report "$work/r.json"
  "$program" noise --preset "thesis-$layer" -o "$work/x.dds" --preview "$work/four.png" --tile 2x2
  histogram "$work/r.json" "$work/histogram.pgm"
  row "$layer" "$work/one.png" "$work/four.png" "$work/histogram.pgm"
done

"$program" noise --preset thesis-dome -o "$work/x.dds" --preview "$work/noise.png" --report "$work/r.json"
"$program" noise --preset thesis-dome --cutoff 0.7 --density 0.96 -o "$work/x.dds" --preview "$work/cloud.png"
histogram "$work/r.json" "$work/histogram.pgm"
row dome "$work/noise.png" "$work/cloud.png" "$work/histogram.pgm"

"$program" cloud -o "$work/x.dds" --format r32f --dynamics 2 --preview "$work/example.png"
"$program" cloud --cumulus --voxel 10 -o "$work/x.dds" --format r32f --dynamics 1.5 --preview "$work/tower.png"
row maps "$work/example.png" "$work/tower.png"
