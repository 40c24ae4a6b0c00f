// SPDX-License-Identifier: Apache-2.0
// `welkin info`: what a file holds.
#pragma once

#include "command_line.h"

namespace welkin::app {

// Prints to standard output: a scene file (.toml) with every default and typical value filled in, or of it
// only what a theme holds; of a picture or volume (.png, .exr, .hdr, .dds, .raw, .vdb) its size, channels,
// range of values and what it says about itself. Returns the exit code. Throws ParseError and IoError for
// what cannot be read, UsageError for other kinds of file and names that are no theme's.
int runInfo(const InfoArgs& args);

}  // namespace welkin::app
