// Reads a whole file at once.
//
// Only regular files are read. A folder, named pipe, socket or device is refused without waiting for it. Cost: one pass
// over the file.
#pragma once

#include <string>

namespace drape
{
// Returns "" and the file's bytes, or the reason why they cannot be read (also where the file is empty). `what` says
// what the file should be, for the reason: "mesh".
std::string readWholeFile(const std::string& path, const std::string& what, std::string& bytes);
}  // namespace drape
