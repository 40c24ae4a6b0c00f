#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes welkin/sky/milky_way.inc, the background light of the Galaxy (welkin/sky/milky_way.h says what it is).

    tools/milky_way.py STARS welkin/sky/milky_way.inc

STARS: the folder of star catalogues of Stellarium 0.22, usr/share/stellarium/stars/default of Debian's package stellarium-data, of which the
counted stars are read: places, V, in catalogues 0 to 3. Needs NumPy and SciPy. Prints mean brightness by latitude.
"""
import argparse
import pathlib
import struct

import numpy as np
from scipy.ndimage import gaussian_filter

# Galactic axes in the celestial system, as in shaders/lib/milky_way.glsl.
GALACTIC = np.array([[-0.0548755604162154, -0.8734370902348850, -0.4838350155487132],
                     [0.4941094278755837, -0.4448296299600112, 0.7469822444972189],
                     [-0.8676661490190047, -0.1980763734312015, 0.4559837761750669]])

# The catalogues sort stars by the triangles of an icosahedron that is divided again and again.
GOLDEN = 0.5 * (1 + 5 ** 0.5)
B = 1 / np.sqrt(1 + GOLDEN * GOLDEN)
A = B * GOLDEN
CORNERS = np.array([[A, -B, 0], [A, B, 0], [-A, B, 0], [-A, -B, 0], [0, A, -B], [0, A, B], [0, -A, B], [0, -A, -B],
                    [-B, 0, A], [B, 0, A], [B, 0, -A], [-B, 0, -A]])
FACES = np.array([(1, 0, 10), (0, 1, 9), (0, 9, 6), (9, 8, 6), (0, 7, 10), (6, 7, 0), (7, 6, 3), (6, 8, 3), (11, 10, 7), (7, 3, 11),
                  (3, 2, 11), (2, 3, 8), (10, 11, 4), (2, 4, 11), (5, 4, 2), (2, 8, 5), (4, 1, 10), (4, 5, 1), (5, 9, 1), (8, 9, 5)])
RECORD = {0: 28, 1: 10, 2: 6}  # bytes a star, by the kind of catalogue

STEP = 0.5  # degrees between samples of the maps
LATITUDES = np.arange(-90, 90, STEP) + STEP / 2
LONGITUDES = np.arange(-180, 180, STEP) + STEP / 2
LATITUDE = np.abs(LATITUDES)[:, None]


def unit(v):
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def triangles(level):
    t = CORNERS[FACES]
    for _ in range(level):
        a, b, c = t[:, 0], t[:, 1], t[:, 2]
        bc, ca, ab = unit(b + c), unit(c + a), unit(a + b)
        t = np.stack([np.stack(k, 1) for k in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (bc, ca, ab))], 1).reshape(-1, 3, 3)
    return t


def signed(bits, width):
    v = bits.astype(np.int64)
    return np.where(v >= 1 << (width - 1), v - (1 << width), v).astype(float)


def read(path):
    """Unit vectors in the celestial system and V of a catalogue's stars."""
    data = path.read_bytes()
    kind, _, _, level, least, span, steps = struct.unpack("<7i", data[4:32])
    zones = 20 * 4 ** level
    counts = np.frombuffer(data, "<u4", zones, 32)
    raw = np.frombuffer(data, np.uint8, int(counts.sum()) * RECORD[kind], 32 + 4 * zones).reshape(-1, RECORD[kind])
    if kind == 0:
        x = raw[:, 4:12].copy().view("<i4").astype(float)
        magnitude, most = raw[:, 13].astype(int), 2 ** 31 - 1
    else:
        word = sum(raw[:, i].astype(np.uint64) << np.uint64(8 * i) for i in range(min(8, RECORD[kind])))
        width = 20 if kind == 1 else 18
        cut = lambda at: (word >> np.uint64(at)) & np.uint64((1 << width) - 1)
        x = np.stack([signed(cut(0), width), signed(cut(width), width)], 1)
        most = 2 ** (width - 1) - 1
        magnitude = raw[:, 9].astype(int) >> 3 if kind == 1 else ((word >> np.uint64(43)) & np.uint64(31)).astype(int)
    # Places in the tangent plane of a triangle's middle, in shares of the largest of all.
    corners = triangles(level)
    middle = unit(corners.sum(1))
    east = unit(np.cross([0, 0, 1.0], middle))
    north = np.cross(middle, east)
    u, v = (np.einsum("zci,zi->zc", corners - middle[:, None], axis) for axis in (east, north))
    scale = np.max(np.maximum(np.abs(u), np.abs(v)) / np.sqrt(1 - u * u - v * v)) / most
    zone = np.repeat(np.arange(zones), counts)
    at = middle[zone] + scale * (x[:, :1] * east[zone] + x[:, 1:] * north[zone])
    return unit(at), (least + magnitude * span / steps) / 1000


def brightness(latitude, longitude, v):
    """S10 of stars: of V = 10, to the square degree."""
    edges = np.arange(-90, 90 + STEP, STEP), np.arange(-180, 180 + STEP, STEP)
    sums = np.histogram2d(latitude, longitude, bins=edges, weights=10 ** (-0.4 * (v - 10)))[0]
    return sums / (STEP * STEP * np.cos(np.radians(LATITUDES)))[:, None]


def smooth(m, latitude, longitude):
    return gaussian_filter(m, [latitude / STEP, longitude / STEP], mode=["nearest", "wrap"])


def along_plane(m):
    s = smooth(m, 2.5, 45)
    return 0.5 * (s + s[::-1])


def rise(x, a, b):
    t = np.clip((x - a) / (b - a), 0, 1)
    return t * t * (3 - 2 * t)


def counted(folder):
    """Stars of V = 6.5 to 10.5: along the whole plane, and how much more or less there are of them here and there."""
    stars = [read(next(folder.glob(f"stars_{i}_*.cat"))) for i in range(4)]
    place = np.concatenate([p for p, _ in stars]) @ GALACTIC.T
    v = np.concatenate([m for _, m in stars])
    latitude, longitude = np.degrees(np.arcsin(np.clip(place[:, 2], -1, 1))), np.degrees(np.arctan2(place[:, 1], place[:, 0]))
    bright, faint = ((v > 6.5) & (v <= 7.5), v > 7.5)
    bright, faint = (brightness(latitude[sel], longitude[sel], v[sel]) for sel in (bright, faint))
    near, far = rise(LATITUDE, 3, 9), rise(LATITUDE, 9, 22)
    fine = smooth(faint, 0.9, 0.9) * (1 - near) + smooth(faint, 1.7, 1.7) * near
    fine = fine * (1 - far) + smooth(faint, 3, 3) * far
    return along_plane(bright) + along_plane(faint), np.minimum(fine / np.maximum(along_plane(faint), 1e-9), 2.6)


def modelled():
    """All stars of the Galaxy, S10."""
    longitude, latitude = np.meshgrid(np.radians(LONGITUDES), np.radians(LATITUDES))
    sun_pc, sun_above_pc = 8178.0, 20.0
    disc_pc, thick_pc, here = 3000.0, 300.0, 24.3 / (2 * 300.0)           # here: solar luminosities, 1/pc^3
    dust_pc, dust_thick_pc, dimming = 3200.0, 150.0, 0.7 / 1000 / 1.086  # dimming here: 1/pc
    bar = np.radians(27)
    edges = np.concatenate([np.arange(0, 3000, 20), np.arange(3000, 20001, 100)]).astype(float)
    total, depth = np.zeros_like(latitude), np.zeros_like(latitude)
    for start, end in zip(edges, edges[1:]):
        step, s = end - start, 0.5 * (start + end)
        x, y = sun_pc - s * np.cos(latitude) * np.cos(longitude), s * np.cos(latitude) * np.sin(longitude)
        z, r = s * np.sin(latitude) + sun_above_pc, np.hypot(x, y)
        light = here * np.exp(-(r - sun_pc) / disc_pc) * np.exp(-abs(z) / thick_pc)
        ahead, across = x * np.cos(bar) - y * np.sin(bar), x * np.sin(bar) + y * np.cos(bar)
        box = (((ahead / 1580) ** 2 + (across / 620) ** 2) ** 2 + (z / 430) ** 4) ** 0.25
        light += 0.10 * np.exp(-0.5 * box ** 2)
        dust = dimming * np.exp(-(r - sun_pc) / dust_pc) * np.exp(-abs(z) / dust_thick_pc)
        dust = dust * np.where(r < 4000, np.exp((r - 4000) / 1500), 1) * step
        total += 3.56 * light * step * np.exp(-depth - dust / 2)  # S10 of a solar luminosity to the square parsec
        depth += dust
    return total


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("stars", type=pathlib.Path)
    arguments.add_argument("output", type=pathlib.Path)
    arguments = arguments.parse_args()

    plane, local = counted(arguments.stars)
    faint = 0.62 * np.maximum(modelled() - 1.35 * plane, 0)
    total = plane * local + faint * np.minimum(local, 1.3) ** 1.15
    weight = np.cos(np.radians(LATITUDES))[:, None] * np.ones_like(total)
    mean = lambda where: np.sum((total * weight)[where]) / np.sum(weight[where])
    latitude = LATITUDE * np.ones_like(total)
    pole = mean(latitude > 75)
    for deg in (0, 10, 30):
        print(f"{deg} degrees: {mean(abs(latitude - deg) < 1):.0f} S10")
    print(f"poles: {pole:.0f} S10")

    excess = np.maximum(total - pole, 0) * (1 - rise(LATITUDE, 33, 45))
    rows = []
    for b in range(-48, 49, 2):
        at = round((b + 90) / STEP)
        middle = 0.25 * sum(excess[at + i] + np.roll(excess[at + i], 1) for i in (-1, 0))  # of the four samples around
        rows.append([round(middle[round((l + 180) % 360 / STEP)]) for l in range(0, 360, 2)])
    with open(arguments.output, "w", encoding="ascii") as f:
        f.write("// SPDX-License-Identifier: Apache-2.0\n"
                "// Written by tools/milky_way.py. Background light of the Galaxy above that at its poles, in S10 (stars of V = 10 to the square\n"
                "// degree): rows from b = -48 to 48 degrees, columns from l = 0 to 358, every 2 degrees; control points of a cubic B-spline. The\n"
                f"// poles have {pole:.0f}.\n"
                "// clang-format off\n")
        for row in rows:
            f.write(",".join(map(str, row)) + ",\n")


if __name__ == "__main__":
    main()
