// SPDX-License-Identifier: Apache-2.0
// What OpenSceneGraph makes of an image file: `osg_texels FILE` prints size, kind of texel and the bytes of
// all levels in hexadecimal, as OpenSceneGraph would hand them to OpenGL.
#include <osg/GL>
#include <osg/Image>
#include <osgDB/ReadFile>

#include <cstdio>

namespace {

const char* nameOf(unsigned format) {
  switch (format) {
    case GL_LUMINANCE:
      return "L";
    case GL_ALPHA:
      return "A";
    case GL_LUMINANCE_ALPHA:
      return "LA";
    case GL_RED:
      return "R";
    case GL_RGB:
      return "RGB";
    case GL_RGBA:
      return "RGBA";
    case GL_BGR:
      return "BGR";
    case GL_BGRA:
      return "BGRA";
    default:
      return "?";
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const osg::ref_ptr<osg::Image> image = osgDB::readRefImageFile(argv[1]);
  if (!image) return 1;
  std::printf("%dx%dx%d %s %u-bit %u levels: ", image->s(), image->t(), image->r(),
              nameOf(image->getPixelFormat()),
              osg::Image::computePixelSizeInBits(image->getPixelFormat(), image->getDataType()),
              image->getNumMipmapLevels());
  for (unsigned i = 0; i < image->getTotalSizeInBytesIncludingMipmaps(); ++i)
    std::printf("%02x", image->data()[i]);
  std::printf("\n");
}
