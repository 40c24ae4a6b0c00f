#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Draws the demonstration: demo.sh PROGRAM OUT
#
# OUT gets a still and a report of each scene beside this file, a fisheye dome, an HDR environment map, a time-lapse, and
# contact_sheet.png with all of them. A picture that is newer than the program and its scene is not drawn again.
# WELKIN_DEMO_QUICK=1 draws everything small and coarse, to try this script.
set -euo pipefail
here="$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"
(($# == 2)) || { echo "usage: demo.sh PROGRAM OUT" >&2; exit 2; }
program="$(readlink -f "$1")"
out="$2"
mkdir -p "$out"

still=(--size 1280x720 --quality medium)
dome=(--projection fisheye --size 1024x1024 --quality medium)
environment=(--projection equirect --look 0,0 --quality medium)
environment_size=2048x1024
lapse=(--size 640x360 --quality low --frames 120 --fps 24 --speed 120)
if [[ -n "${WELKIN_DEMO_QUICK:-}" ]]; then
  still=(--size 320x180 --quality low)
  dome=(--projection fisheye --size 256x256 --quality low)
  environment=(--projection equirect --look 0,0 --quality low)
  environment_size=256x128
  lapse=(--size 160x90 --quality low --frames 24 --fps 24 --speed 120)
fi

# The scene, and what stands under its picture.
scenes=(
  "clear_noon|Clear, local noon, Amsterdam"
  "fair_weather_noon|Fair-weather cumulus, high sun, Columbus, Texas"
  "stratocumulus_golden_hour|Broken stratocumulus, sunrise, Moscow"
  "overcast_rain|Overcast with rain beneath, afternoon, Naples, Florida"
  "thunderstorm_night|Thunderstorm, full moon, Bamako"
)

# draw OUT SCENE FLAG...
draw() {
  local file="$out/$1" scene="$here/$2.toml" started=$SECONDS
  shift 2
  if [[ -e "$file" && "$file" -nt "$program" && "$file" -nt "$scene" && "$file" -nt "$here/demo.sh" ]]; then
    echo "   $file: up to date"
    return
  fi
  "$program" render "$scene" -o "$file" --report "${file%.*}.json" "$@"
  echo "   $file: $((SECONDS - started)) s"
}

for entry in "${scenes[@]}"; do
  draw "${entry%%|*}.png" "${entry%%|*}" "${still[@]}"
done
draw fisheye.png fair_weather_noon "${dome[@]}"
draw environment.exr fair_weather_noon "${environment[@]}" --size "$environment_size"
# The same for the eye; the EXR is the one to light with.
draw environment_preview.png fair_weather_noon "${environment[@]}" --size "$environment_size"
draw time_lapse.mp4 fair_weather_noon "${lapse[@]}"

# --- contact sheet ---------------------------------------------------------------------------------------------------------------

font=/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT

cells=()
for entry in "${scenes[@]}"; do cells+=(-label "${entry#*|}" "$out/${entry%%|*}.png"); done
cells+=(-label "Fisheye dome of the same cumulus" "$out/fisheye.png")
cells+=(-label "Environment map (environment.exr), exposed" "$out/environment_preview.png")
for share in 0 99; do
  frame="$work/lapse_$share.png"
  count="$(ffprobe -v error -count_packets -show_entries stream=nb_read_packets -of csv=p=0 "$out/time_lapse.mp4")"
  ffmpeg -v error -i "$out/time_lapse.mp4" -vf "select=eq(n\,$(((count - 1) * share / 99)))" -frames:v 1 -y "$frame" </dev/null
  cells+=(-label "Time-lapse, frame $(((count - 1) * share / 99 + 1)) of $count" "$frame")
done
montage "${cells[@]}" -font "$font" -pointsize 17 -fill '#e8e8e8' -background '#202428' -tile 3x \
  -geometry '480x270+10+8' "png24:$work/sheet.png"
mv "$work/sheet.png" "$out/contact_sheet.png"
echo "   $out/contact_sheet.png"
