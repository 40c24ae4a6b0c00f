// SPDX-License-Identifier: Apache-2.0
// The background light of the Galaxy: a smooth map of the stars that are too faint to be drawn one by one,
// for the texture of shaders/lib/milky_way.glsl.
//
// It is the light above that at the galactic poles, which the airglow of a dark sky holds already (28 S10; 1
// S10 is a star of V = 10 to the square degree). Two parts:
//
// Stars of V = 6.5 to 10.5, counted: 600,000 of E. Hog et al. 2000, "The Tycho-2 catalogue of the 2.5 million
// brightest stars", by way of the data files of Stellarium 0.22, smoothed over 1 degree in the plane and 3
// from 20 degrees on, those to V = 7.5 over 45 along the plane.
//
// Fainter ones, modelled: a disc of 3000 and 300 pc (J. Bland-Hawthorn and O. Gerhard 2016, "The Galaxy in
// context") with 24.3 solar luminosities to the square parsec here (C. Flynn et al. 2006, "On the
// mass-to-light ratio of the local Galactic disc and the optical luminosity of the Galaxy"), the bar of E.
// Dwek et al. 1995, "Morphology, near-infrared luminosity, and mass of the Galactic bulge from COBE DIRBE
// observations", and dust of 0.7 magnitudes a kpc, summed along the ray; less what the counted stars give
// along the whole plane; times 0.62 and the counted stars' share of their mean at that latitude to the
// power 1.15, so that dark clouds which hide those hide these. Shares and the bar's strength are chosen to
// meet measured brightness (docs/theory.md). tools/milky_way.py makes both.
//
// It fades out between 33 and 45 degrees from the plane, where a tenth of the airglow is left of it at most.
// Not in it: the Magellanic Clouds, nebulae.
#pragma once

#include "welkin/core/image.h"

namespace welkin::sky {

// cd/m2, linear Rec. 709, by galactic longitude (columns, from 0 on) and latitude (rows, from -48 to 48
// degrees): of the colour of stars of B-V = 0.78, the mean of the counted ones by their light.
const Image<float>& milkyWay();

// Share of it that is drawn: none until the sun is 6 degrees down, where the sky is a thousand times as
// bright, all from 10 on.
float milkyWayShare(double sunElevationDeg);

}  // namespace welkin::sky
