#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes the picture of metaballs.md anew: metaballs.sh PROGRAM. Needs ImageMagick and Python.
set -euo pipefail
(($# == 1)) || { echo "usage: metaballs.sh PROGRAM" >&2; exit 2; }
program="$(readlink -f "$1")"
here="$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT

# views VOLUME.raw NAME: seen from the south, how much of the light behind it a cloud takes; and its middle slice from above.
views() {
  python3 - "$1" "$2" <<'PYTHON'
import array, json, math, sys
name = sys.argv[1]
side = json.load(open(name + ".json"))
(nx, ny, nz), voxel = side["size"], side["voxel_size_m"][0]
d = array.array("f", open(name, "rb").read())
def grey(path, width, rows):
    open(path, "wb").write(b"P5 %d %d 255 " % (width, len(rows)) + b"".join(bytes(min(255, int(255 * v + 0.5)) for v in row) for row in rows))
through = [[sum(d[(z * ny + y) * nx + x] for y in range(ny)) * voxel for x in range(nx)] for z in reversed(range(nz))]
grey(sys.argv[2] + "_side.pgm", nx, [[1 - math.exp(-t / 60) for t in row] for row in through])
middle = nz // 2
grey(sys.argv[2] + "_slice.pgm", nx, [[2.2 * max(d[(middle * ny + y) * nx + x], 0) for x in range(nx)] for y in reversed(range(ny))])
PYTHON
}

cd "$work"
"$program" cloud -o map.raw
"$program" fit map.raw --method man --balls 1000 -o man.json --report man-r.json
for k in 1000 100 30; do "$program" fit map.raw --balls $k -o "$k.json" --report "$k-r.json"; done
views map.raw map
columns=()
label() { echo "$1, error $(python3 -c 'import json, sys; print("%.2f" % json.load(open(sys.argv[1]))["levels"][0]["relative_l2"])' "$2")"; }
for name in map 1000 100 30 man; do
  case $name in
    map) text="11,760 voxels" ;;
    man) text="$(label "Man's rule, 1,000" man-r.json)" ;;
    *) text="$(label "$name balls" "$name-r.json")" ;;
  esac
  if [[ $name != map ]]; then
    "$program" cloud --metaballs "$name.json" --size 48x36x24 --voxel 20 -o "$name.raw"
    views "$name.raw" "$name"
  fi
  convert "${name}_side.pgm" "${name}_slice.pgm" -filter Mitchell -resize 288x -background grey30 -splice 0x4 -append \
    -gravity north -background grey20 -splice 0x22 -font DejaVu-Sans -fill white -pointsize 14 -annotate +0+3 "$text" \
    -bordercolor grey30 -border 2 "$name.png"
  columns+=("$name.png")
done
convert "${columns[@]}" +append -colorspace gray -strip -quality 88 "$here/metaballs.jpg"
echo "   metaballs.jpg"
