// SPDX-License-Identifier: Apache-2.0
// A 2D picture of interleaved channels in memory. Row 0 is the top row; x runs fastest after the channel.
// Linear pictures hold luminance in cd/m2 per Rec. 709 primary unless said otherwise.
#pragma once

#include <cassert>
#include <cstddef>
#include <vector>

namespace welkin {

template <class T>
struct Image {
  int width = 0;     // pixels
  int height = 0;    // pixels
  int channels = 0;  // values a pixel
  std::vector<T> data;

  Image() = default;
  Image(int w, int h, int c) : width(w), height(h), channels(c), data(static_cast<std::size_t>(w) * h * c) {}

  std::size_t index(int x, int y, int c = 0) const {
    assert(x >= 0 && x < width && y >= 0 && y < height && c >= 0 && c < channels);
    return (static_cast<std::size_t>(y) * width + x) * channels + c;
  }
  T& at(int x, int y, int c = 0) { return data[index(x, y, c)]; }
  const T& at(int x, int y, int c = 0) const { return data[index(x, y, c)]; }
};

// The same in three dimensions: x fastest after the channel, then y, then z.
template <class T>
struct Volume {
  int nx = 0, ny = 0, nz = 0;
  int channels = 0;
  std::vector<T> data;

  Volume() = default;
  Volume(int x, int y, int z, int c)
      : nx(x), ny(y), nz(z), channels(c), data(static_cast<std::size_t>(x) * y * z * c) {}

  std::size_t index(int x, int y, int z, int c = 0) const {
    assert(x >= 0 && x < nx && y >= 0 && y < ny && z >= 0 && z < nz && c >= 0 && c < channels);
    return ((static_cast<std::size_t>(z) * ny + y) * nx + x) * channels + c;
  }
  T& at(int x, int y, int z, int c = 0) { return data[index(x, y, z, c)]; }
  const T& at(int x, int y, int z, int c = 0) const { return data[index(x, y, z, c)]; }
};

}  // namespace welkin
