#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes the picture of truth.md anew: truth.sh PROGRAM. Needs ImageMagick.
set -euo pipefail
(($# == 1)) || { echo "usage: truth.sh PROGRAM" >&2; exit 2; }
program="$(readlink -f "$1")"
here="$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT

"$program" bench truth --truth "$here/../../bench/truth" --pictures "$work"
# Overcast and the inside of a cloud are 16x9, enlarged to the size of the others.
for strip in "$work"/*.png; do convert "$strip" -filter point -resize 730x "$strip"; done
montage "$work"/*.png -tile 2x -geometry +6+4 -quality 66 "$here/truth.jpg"
