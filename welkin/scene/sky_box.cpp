// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/sky_box.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "welkin/core/colour.h"
#include "welkin/core/error.h"
#include "welkin/io/texel_file.h"

namespace welkin::scene {
namespace {

Image<float> luminanceIn(const std::string& path, double whiteCdM2) {
  const io::Texels texels = [&] {
    try {
      return io::readTexels(path);
    } catch (const ParameterError& e) {
      throw IoError(e.what());  // of what kind it is, the name does not say
    }
  }();
  const io::TexelShape& shape = texels.shape;
  if (shape.volume) throw IoError(path + ": a volume; expected a picture, for a sky box");
  const int channels = shape.format.channelCount();
  const bool display =
      shape.format.type == io::ValueType::kUnorm8 || shape.format.type == io::ValueType::kUnorm16;
  std::vector<float> values(texels.bytes.size() / shape.format.valueBytes());
  io::toFloats(shape.format.type, texels.bytes, values);
  Image<float> out(shape.nx, shape.ny, 3);
  for (std::size_t i = 0; i < out.data.size() / 3; ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      const float x = values[i * static_cast<std::size_t>(channels) + (channels >= 3 ? c : 0)];
      out.data[3 * i + c] = display ? static_cast<float>(whiteCdM2) * linearOfSrgb(x) : std::max(x, 0.0f);
    }
  return out;
}

Image<float> cut(const Image<float>& strip, int face) {
  const int side = strip.height;
  Image<float> out(side, side, 3);
  for (int y = 0; y < side; ++y)
    std::copy_n(&strip.data[strip.index(face * side, y)], static_cast<std::size_t>(side) * 3,
                &out.data[out.index(0, y)]);
  return out;
}

std::string sizeOf(const Image<float>& image) {
  return std::to_string(image.width) + "x" + std::to_string(image.height);
}

}  // namespace

bool SkyBox::empty() const {
  const auto all = faces();
  return !strip && std::none_of(all.begin(), all.end(), [](const auto* face) { return face->has_value(); });
}

void describe(SkyBox& b, ParamVisitor& v) {
  v.value({"strip", "",
           "file, beside the scene file, with the six faces side by side, +x -x +y -y +z -z, as --projection "
           "cubemap writes them"},
          b.strip);
  v.value(
      {"px", "", "file of the face +x, as OpenGL orients it; with the five others in the place of a strip"},
      b.px);
  v.value({"nx", "", "file of the face -x"}, b.nx);
  v.value({"py", "", "file of the face +y"}, b.py);
  v.value({"ny", "", "file of the face -y"}, b.ny);
  v.value({"pz", "", "file of the face +z"}, b.pz);
  v.value({"nz", "", "file of the face -z"}, b.nz);
  v.choice({"axes", "", "z_up: x east, y north; y_up: x east, -z north, as most engines have it"}, b.axes);
  v.value({"turn_deg", "deg", "turns the box clockwise as seen from above", -360, 360}, b.turnDeg);
  v.value({"white_cd_m2", "cd/m2", "luminance of white in files of integers; files of floats hold luminance",
           1e-6, 1e9},
          b.whiteCdM2);
  v.value({"ground", "", "draw the ground below the horizon; false: the box all around"}, b.ground);
}

void validate(const SkyBox& b) {
  const auto all = b.faces();
  const auto given =
      std::count_if(all.begin(), all.end(), [](const auto* face) { return face->has_value(); });
  if (b.strip && given > 0) throw ParameterError("sky_box has a strip and faces; expected one or the other");
  if (b.empty() && b != SkyBox{})
    throw ParameterError("sky_box has neither a strip nor faces; expected one or the other");
  if (given > 0 && given < 6)
    throw ParameterError("sky_box has " + std::to_string(given) +
                         " of six faces; expected px, nx, py, ny, pz and nz, or a strip");
}

std::array<Image<float>, 6> skyBoxFaces(const SkyBox& b) {
  std::array<Image<float>, 6> faces;
  if (b.strip) {
    const Image<float> strip = luminanceIn(*b.strip, b.whiteCdM2);
    if (strip.width != 6 * strip.height)
      throw IoError(*b.strip + ": " + sizeOf(strip) + " pixels; expected six square faces side by side");
    for (int f = 0; f < 6; ++f) faces[static_cast<std::size_t>(f)] = cut(strip, f);
    return faces;
  }
  const auto files = b.faces();
  for (std::size_t f = 0; f < 6; ++f) {
    faces[f] = luminanceIn(**files[f], b.whiteCdM2);
    if (faces[f].width != faces[f].height || faces[f].width != faces[0].width)
      throw IoError(**files[f] + ": " + sizeOf(faces[f]) +
                    " pixels; expected a square, as large as the face px" +
                    (f > 0 ? ", " + sizeOf(faces[0]) : ""));
  }
  return faces;
}

}  // namespace welkin::scene
