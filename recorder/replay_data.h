// Packs recordings for a replay page: a JSON description of the arrays, and the arrays, coded (coding.h).
//
// Layout: the length of the JSON text (32 bits, little-endian), the text, the arrays. The text gives each array's first
// byte, counted from the end of the text. Meshes that several bodies share, in one run or in several, are there once.
#pragma once

#include <string>
#include <vector>

#include "drape/recording.h"

namespace drape
{
// Returns the data, not yet deflated. The recordings must have passed checkRecording().
std::string packReplay(const std::vector<const Recording*>& runs, const ReplaySettings& settings);
}  // namespace drape
