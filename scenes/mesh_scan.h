// Looks through the bytes of an OBJ or PLY file for what Assimp repairs or drops in silence: coordinates that are no
// finite float, and indices of vertices that do not exist; and through those of a binary glTF file for lengths that the
// file has not, which Assimp would make room for. Returns an empty string, or element and reason in one line.
#pragma once

#include <string>

namespace drape
{
std::string scanObj(const std::string& bytes);
std::string scanPly(const std::string& bytes);
std::string scanGlb(const std::string& bytes);

// "" when the text is one finite number that fits a float, else why not.
std::string coordinateProblem(const std::string& word);
std::string coordinateProblem(double value);
}  // namespace drape
