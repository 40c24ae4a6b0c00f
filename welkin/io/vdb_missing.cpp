// SPDX-License-Identifier: Apache-2.0
// In place of vdb.cpp in a build without OpenVDB.
#include "welkin/core/error.h"
#include "welkin/io/vdb.h"

namespace welkin::io {
namespace {

[[noreturn]] void fail(const char* what, const std::filesystem::path& path) {
  throw IoError(std::string("cannot ") + what + " " + path.string() +
                ": this Welkin was built without OpenVDB");
}

}  // namespace

bool hasVdb() {
  return false;
}

struct VdbWriter::Impl {};

VdbWriter::VdbWriter(const std::filesystem::path& path, const TexelShape&, const TexelNotes&) {
  fail("write", path);
}
VdbWriter::~VdbWriter() = default;
void VdbWriter::write(std::span<const std::byte>) {}
void VdbWriter::close() {}

VdbSummary readVdbSummary(const std::filesystem::path& path, const VdbReadOptions&) {
  fail("read", path);
}
Texels readVdb(const std::filesystem::path& path, const VdbReadOptions&) {
  fail("read", path);
}

}  // namespace welkin::io
