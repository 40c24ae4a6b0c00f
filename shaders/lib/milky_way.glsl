// SPDX-License-Identifier: Apache-2.0
// Where a direction lies in the map of welkin/sky/milky_way.h. Plain mathematics.

// Galactic axes in the celestial system: to the centre, along the way that the sun goes, to the north pole. ESA 1997, "The Hipparcos and
// Tycho Catalogues", ESA SP-1200, vol. 1, 1.5.3.
WELKIN_CONST vec3 kGalaxyCentre = vec3(-0.0548755604f, -0.8734370902f, -0.4838350155f);
WELKIN_CONST vec3 kGalaxyAhead = vec3(0.4941094279f, -0.4448296300f, 0.7469822445f);
WELKIN_CONST vec3 kGalaxyPole = vec3(-0.8676661490f, -0.1980763734f, 0.4559837762f);

// Of a unit direction in the celestial system. The map ends 48 degrees from the plane, and is 0 there.
WELKIN_FN vec2 milkyWayAt(vec3 celestial) {
  float longitude = atan(dot(celestial, kGalaxyAhead), dot(celestial, kGalaxyCentre));
  float latitude = asin(clamp(dot(celestial, kGalaxyPole), -1.0f, 1.0f));
  return vec2(longitude * 0.15915494f, latitude * (0.5f / 0.83775804f) + 0.5f);
}
