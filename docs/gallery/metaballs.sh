#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes the pictures of metaballs.md anew: metaballs.sh PROGRAM. Needs ImageMagick and Python.
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

# Skies of them, and one cloud before the sun with and without the droplets' phase function.
cp "$here"/metaball_{sky,lining,fly}.toml .
i=0
picture() { convert "$1" -strip -quality 86 "$here/$2.jpg" && echo "   $2.jpg"; }
"$program" render metaball_sky.toml --size 960x540 -o noon.png
picture noon.png metaball_noon
"$program" render metaball_sky.toml --size 960x540 --time 2026-06-21T19:10:00Z --look 318,10,75 -o sunset.png
picture sunset.png metaball_sunset
"$program" cloud --cumulus -o tower.json
"$program" render metaball_lining.toml --size 480x360 --exposure 16.5 -o droplets.png
sed 's/"droplets"/"isotropic"/' metaball_lining.toml > isotropic.toml
"$program" render isotropic.toml --size 480x360 --exposure 16.5 -o isotropic.png
convert isotropic.png droplets.png +append lining.png
picture lining.png metaball_lining

# The same field by three renderers.
for how in "--metaballs-as splats" "--metaballs-as volume" "--renderer reference --spp 48"; do
  "$program" render metaball_lining.toml --time 2026-06-21T14:00:00Z --look 284,17,30 --size 240x180 --exposure 15 $how -o "three_$((i++)).png"
done
convert three_0.png three_1.png three_2.png +append three.png
picture three.png metaball_three

"$program" render metaball_fly.toml --size 320x180 --quality low --frames 144 --fps 12 --speed 4 -o "$here/metaball_fly.webm"

# A flight over and through the sky: the eye rises while it turns.
frames=()
for i in 0 1 2 3 4 5 6 7; do
  "$program" render metaball_sky.toml --size 320x200 --at $((60 * i)) --eye $((100 + 350 * i)) --look $((285 + 6 * i)),$((14 - 3 * i)),75 -o "f$i.png"
  frames+=("f$i.png")
done
montage "${frames[@]}" -tile 4x -geometry +2+2 flight.png
picture flight.png metaball_flight
