// Reads a whole file. "" and its bytes, or why they cannot be had: a folder, not there, not readable, empty. `what` is
// what the file should have been, for the reason: "mesh".
#pragma once

#include <string>

namespace drape
{
std::string readWholeFile(const std::string& path, const std::string& what, std::string& bytes);
}  // namespace drape
