#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Draws the gallery anew: refresh.sh PROGRAM. Needs ImageMagick.
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
for scene in above_the_clouds sunset cirrus blue_hour; do picture "$scene" "$here/$scene.toml" --size 960x540; done
picture thunderstorm_day "$demo/thunderstorm_night.toml" --time 2026-09-26T09:00:00Z --size 960x540
picture in_the_cloud "$here/above_the_clouds.toml" --eye 1700 --size 960x540
picture between_layers "$here/sunset.toml" --time 2026-06-21T16:00:00Z --eye 3200 --look 260,-4 --size 960x540
picture dome "$demo/fair_weather_noon.toml" --projection fisheye --size 640x640
picture thin_golden_hour "$demo/stratocumulus_golden_hour.toml" --technique skyplane --size 960x540
picture thin_layers "$here/thin_layers.toml" --size 960x540
picture flare_right "$here/flare.toml" --look 250,16 --size 640x360
picture flare_high "$here/flare.toml" --look 288,8 --size 640x360
picture flare_middle "$here/flare.toml" --look 276.3,26.9 --size 640x360
"$here/noise.sh" "$program"
"$here/metaballs.sh" "$program"
