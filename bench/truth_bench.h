// SPDX-License-Identifier: Apache-2.0
// How far the marched renderer is from the truth: scenes whose pictures the reference renderer has made,
// drawn with Welkin's light in clouds and with what is usual in its place.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "welkin/core/image.h"
#include "welkin/render/sky_renderer.h"

namespace welkin::bench {

// Over the pixels of a picture, each by the clouds' opacity in it.
struct TruthError {
  double relative = 0.0;  // mean relative error of the luminance
  double bias = 0.0;      // of the mean luminance
  double flip = 0.0;      // mean of FLIP
  double cpuS = 0.0;      // processor time of the march
};

struct TruthRow {
  std::string scene;
  double noise = 0.0;              // mean relative standard error of the truth, over the same pixels
  std::vector<TruthError> errors;  // in the order of kTruthLights
};

struct TruthTable {
  std::string device;
  std::vector<TruthRow> rows;
};

inline constexpr render::CloudLight kTruthLights[] = {
    render::CloudLight::kSingle, render::CloudLight::kOctaves, render::CloudLight::kFull};

// folder: of scenes X.toml and their truths X.exr. pictures: where to write X.png, if not empty: the truth,
// the fast picture and its relative error. Throws ParameterError for a folder without them, IoError,
// GpuError.
TruthTable measureTruth(const std::filesystem::path& folder, const std::filesystem::path& pictures);

}  // namespace welkin::bench
