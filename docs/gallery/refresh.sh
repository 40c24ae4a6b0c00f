#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Draws the gallery anew: refresh.sh PROGRAM. Needs ImageMagick and ffmpeg.
set -euo pipefail
(($# == 1)) || { echo "usage: refresh.sh PROGRAM" >&2; exit 2; }
program="$(readlink -f "$1")"
here="$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"
demo="$here/../../demo"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT

# picture NAME SCENE FLAG...
picture() {
  local name="$1" scene="$2"
  shift 2
  "$program" render "$scene" -o "$work/$name.png" "$@"
  convert "$work/$name.png" -quality 88 "$here/$name.jpg"
  echo "   $name.jpg"
}

for scene in clear_noon fair_weather_noon stratocumulus_golden_hour overcast_rain thunderstorm_night; do
  picture "$scene" "$demo/$scene.toml" --size 960x540
done
for scene in above_the_clouds sunset cirrus blue_hour starry_night eclipse halo glory fogbow; do picture "$scene" "$here/$scene.toml" --size 960x540; done
picture halo_moon "$here/halo.toml" --time 2026-04-01T22:30:00Z --look 165,35 --size 640x360
picture eclipse_moon "$here/starry_night.toml" --place 40,-100 --time 2025-03-14T06:59:00Z --look 183.8,52.06,1.2 --size 480x270
picture rain "$here/rain.toml" --size 960x540
for scene in rainbow rainbow_report; do picture "$scene" "$here/$scene.toml" --size 960x540; done
picture thunderstorm_day "$demo/thunderstorm_night.toml" --time 2026-09-26T09:00:00Z --size 960x540
picture congestus "$here/congestus.toml" --size 960x540
picture congestus_aside "$here/congestus.toml" --look 330,14 --size 960x540
picture in_the_cloud "$here/above_the_clouds.toml" --eye 1700 --size 960x540
picture between_layers "$here/sunset.toml" --time 2026-06-21T16:00:00Z --eye 3200 --look 260,-4 --size 960x540
picture dome "$demo/fair_weather_noon.toml" --projection fisheye --size 640x640
picture thin_golden_hour "$demo/stratocumulus_golden_hour.toml" --technique skyplane --size 960x540
picture thin_layers "$here/thin_layers.toml" --size 960x540
picture thin_dome "$here/thin_layers.toml" --projection fisheye --size 640x640
picture sheet_shadows "$here/sheet_shadows.toml" --size 960x540
picture mixed_noon "$here/mixed.toml" --size 960x540
picture mixed_sunset "$here/mixed.toml" --time 2026-06-21T19:05:00Z --look 285,14 --size 960x540
picture mixed_between "$here/mixed.toml" --eye 4000 --look 240,2 --size 960x540
picture mixed_above "$here/mixed.toml" --eye 12000 --look 240,-12 --size 960x540
picture living "$here/living.toml" --at 300 --size 960x540
"$program" render "$here/living.toml" --size 320x180 --frames 240 --fps 24 --speed 60 -o "$here/formation.webm"
picture flare_right "$here/flare.toml" --look 250,16 --size 640x360
picture flare_high "$here/flare.toml" --look 288,8 --size 640x360
picture flare_middle "$here/flare.toml" --look 276.3,26.9 --size 640x360
# The thesis's figures 21 to 25.
for theme in overcast broken few combined; do
  picture "thesis_$theme" "$here/thesis.toml" --theme "thesis-$theme" --size 640x400
done
picture thesis_dusk "$here/thesis.toml" --theme thesis-broken --time 2026-06-21T18:40:00Z --look 290,14 --size 640x400
# Its figures 30 and 31: one dome at four cutoffs.
for cutoff in 0.85 0.78 0.72 0.61; do
  { cat "$here/thesis.toml"; printf '[[sheet]]\npreset = "thesis-dome"\ncutoff = %s\ntile_m = 6000\n' "$cutoff"; } > "$work/dome.toml"
  "$program" render "$work/dome.toml" --technique dome --look 165,32 --size 480x300 -o "$work/cutoff_$cutoff.png"
done
montage "$work"/cutoff_0.85.png "$work"/cutoff_0.78.png "$work"/cutoff_0.72.png "$work"/cutoff_0.61.png -tile 2x2 \
  -geometry +2+2 -quality 86 "$here/thesis_dome_cutoffs.jpg"
# Clouds over a sky box, which is a picture of ours.
"$program" render --place 47,8 --time 2026-06-21T18:50:00Z --projection cubemap --size 3072x512 --no-sun-disc \
  -o "$work/sky_box.exr"
cp "$here/sky_box.toml" "$work/sky_box.toml"
picture sky_box "$work/sky_box.toml" --size 960x540
"$here/noise.sh" "$program"
"$here/metaballs.sh" "$program"
"$here/truth.sh" "$program"
