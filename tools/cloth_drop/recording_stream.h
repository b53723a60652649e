// A recording as lines of JSON, by which a child process sends it to its parent (step_stream.h).
#pragma once

#include <nlohmann/json.hpp>

#include "drape/recording.h"

namespace drape
{
// Returns the bodies without their frames.
nlohmann::json asBodies(const Recording& recording);
// Returns the last frame of all bodies, which must be in it.
nlohmann::json asFrame(const Recording& recording);

// These add such a line to a recording. They throw the JSON library's exceptions.
void takeBodies(const nlohmann::json& line, Recording& recording);
void takeFrame(const nlohmann::json& line, Recording& recording);
}  // namespace drape
