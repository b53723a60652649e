// Looks through the bytes of an OBJ, PLY or STL file for what Assimp repairs or drops in silence: coordinates that are
// no finite float, indices of vertices that do not exist, files that end too early; and through those of a glTF file
// for lengths that it has not, which Assimp would make room for, for what is nested so deep that readers run out of
// stack, and for positions that it would take for floats. Returns an empty string, or element and reason in one line.
#pragma once

#include <string>

namespace drape
{
std::string scanObj(const std::string& bytes);
std::string scanPly(const std::string& bytes);
std::string scanStl(const std::string& bytes);
std::string scanGlb(const std::string& bytes);
// The text of a glTF file, or that in a binary one.
std::string scanGltf(const std::string& text);

// Of a good binary PLY file whose first vertex begins with a byte that is a line feed: Assimp would take that for the
// end of the header's last line, and does not where a carriage return ends the line. The file with one; empty for
// others.
std::string plyWithLineEnd(const std::string& bytes);

// Of a good OBJ file: the corners of its faces, lines and points, and what sorts them, by number, without a coordinate.
// Files of which it is the same are read alike: Assimp makes a vertex of each corner, which tells no more whose it is,
// object by object and material by material.
std::string objStructure(const std::string& bytes);

// "" when the text is one finite number that fits a float, else why not.
std::string coordinateProblem(const std::string& word);
std::string coordinateProblem(double value);
}  // namespace drape
