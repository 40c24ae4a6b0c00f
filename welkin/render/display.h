// SPDX-License-Identifier: Apache-2.0
// From luminance to a picture for a screen: exposure and a display transform.
#pragma once

#include "welkin/core/image.h"

namespace welkin::render {

// Exposure value (ISO 100) for a picture: from its log-mean luminance, with the eye's darker rendering of dim
// scenes.
double automaticExposureEv(const Image<float>& luminance);

// RGB cd/m2 to sRGB-encoded values in [0, 1].
Image<float> toDisplay(const Image<float>& luminance, double exposureEv);

}  // namespace welkin::render
