// SPDX-License-Identifier: Apache-2.0
// Clouds of metaballs as density in the march (WELKIN_BALLS(band): whether a band has them): welkin/shading/ball_volume.h makes the
// textures.

uniform sampler3D uBallShapes;    // density, and how far from the nearest ball, in half heights; shapes in columns and rows
uniform sampler2D uBallTable;     // cells: first texel, clouds, clearance; clouds: middle and extinction, turn and tile, 1 / half sizes and step
uniform vec4 uBallGrid;           // corner of the cells east and north; side of a cell, m
uniform vec2 uBallCells;
uniform vec3 uBallTiles;          // points on the side of a shape's grid; columns and rows of shapes

const int kBallTableWidth = 192;
const vec4 kBallPlace = vec4(0.5, 0.5, 1000.0, 0.05);  // a cumulus's (CloudPoint), which they are

vec4 ballTexel(int i) { return texelFetch(uBallTable, ivec2(i % kBallTableWidth, i / kBallTableWidth), 0); }

// The cell that q is in, or in its place (count -1, distance) out of all cells.
vec3 ballCell(vec3 q) {
  vec2 at = (q.xy - uBallGrid.xy) / uBallGrid.z;
  vec2 beyond = max(max(-at, at - uBallCells), 0.0);
  if (beyond.x + beyond.y > 0.0) return vec3(0.0, -1.0, length(beyond) * uBallGrid.z);
  ivec2 cell = min(ivec2(at), ivec2(uBallCells) - 1);
  return vec3(ballTexel(cell.y * int(uBallCells.x) + cell.x));
}

// A distance within which there are none, or -1 where there may be.
float ballClearance(vec3 q) {
  vec3 cell = ballCell(q);
  return cell.y > 0.0 ? -1.0 : cell.z;
}

// Adds what they are at q. Clouds of balls stand alone: they have no cover.
void addBalls(vec3 q, inout CloudPoint point) {
  vec3 cell = ballCell(q);
  int first = int(cell.x), count = int(cell.y);
  if (count <= 0) {
    point.clearM = min(point.clearM, cell.z);
    return;
  }
  // What stands in the next cell is not listed in this.
  vec2 at = fract((q.xy - uBallGrid.xy) / uBallGrid.z);
  vec2 inside = min(at, 1.0 - at) * uBallGrid.z;
  point.clearM = min(point.clearM, max(min(inside.x, inside.y), 1.0));
  for (int i = 0; i < count; ++i) {
    vec4 place = ballTexel(first + 3 * i), turn = ballTexel(first + 3 * i + 1), size = ballTexel(first + 3 * i + 2);
    vec3 d = q - place.xyz;
    vec3 own = vec3(turn.x * d.x - turn.y * d.y, turn.y * d.x + turn.x * d.y, d.z) * size.xyz;
    vec3 beyond = max(abs(own) - 1.0, 0.0);
    if (beyond.x + beyond.y + beyond.z > 0.0) {
      point.clearM = min(point.clearM, length(beyond / size.xyz));
      continue;
    }
    vec3 tiles = vec3(uBallTiles.yz, 1.0);
    vec3 uvw = (vec3(turn.zw, 0.0) + (0.5 + (0.5 * own + 0.5) * (uBallTiles.x - 1.0)) / uBallTiles.x) / tiles;
    vec2 there = textureLod(uBallShapes, uvw, 0.0).xy;
    float extinction = place.w * there.x;
    point.inside = true;
    point.stepM = min(point.stepM, size.w);
    point.extinction += extinction;
    point.place += extinction * kBallPlace;
    if (extinction <= 0.0) point.clearM = min(point.clearM, there.y / size.z);
  }
}
