// SPDX-License-Identifier: Apache-2.0
// What is typical of each genus of cloud, and where the sky's storeys end at a latitude. Heights in metres
// above the ground.
//
// Sources, named at the figures in genus.cpp:
// - [Atlas] WMO, International Cloud Atlas, 2017: heights of the levels by region, the genera's looks
// - [Shuttleworth] W. J. Shuttleworth, Terrestrial Hydrometeorology, 2012, table 10.3: base and depth of the
//   genera
// - [OPAC] M. Hess, P. Koepke, I. Schult, Optical properties of aerosols and clouds, 1998: effective radii;
//   extinction from them and the water contents as 1.5 LWC / (density of water x radius)
// - [Salby] M. L. Salby, Physics of the Atmosphere and Climate, table 9.2: water contents and extinctions
// - [ISCCP] W. B. Rossow, R. A. Schiffer, Advances in understanding clouds from ISCCP, 1999: optical depth
//   3.6 parts cirrus, altocumulus and cumulus from cirrostratus, altostratus and stratocumulus, 23 these from
//   deep convection, nimbostratus and stratus
#pragma once

#include "welkin/weather/weather.h"

namespace welkin::weather {

// The levels overlap in the Atlas (middle clouds 2-4 km in polar regions, 2-7 temperate, 2-8 tropical; high
// clouds 3-8, 5-13, 6-18). A base is called high from the middle of the overlap up.
struct Levels {
  double middleBaseM;  // low clouds are below
  double highBaseM;    // middle clouds are below
  double highTopM;     // about the tropopause
};
Levels levelsAt(double latitudeDeg);

// Deeper cloud under the same name: what a report says with TCU.
double congestusDepthM(double latitudeDeg);

}  // namespace welkin::weather
