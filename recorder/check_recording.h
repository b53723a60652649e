// Checks that a recording's arrays fit together, before a file is made of it.
#pragma once

#include <string>
#include <vector>

#include "drape/recording.h"

namespace drape
{
// Returns false with one line in `error` if an array is too short or too long, or an index or number is out of range.
bool checkRecording(const Recording& run, std::string& error);

// Returns RecordedBody::m_frames; numbers that are not finite repeat the frame before, or are 0 in the first one.
std::vector<float> finiteFrames(const RecordedBody& body);
}  // namespace drape
