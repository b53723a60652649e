// Writes a file so that it is there whole or not at all: into a neighbour with a temporary name, then renamed over it.
//
// A link stays one: what it points to is replaced. A file keeps its permissions, and one that may not be written is
// left alone. What is no file (a pipe, a terminal, a device), or is named by a process's descriptor (/dev/fd/3), is
// written where it is, as far as that goes.
// Returns false and says in `error` which path failed and why (one line); a half-written neighbour is removed.
#pragma once

#include <string>

namespace drape
{
bool writeFileAtomically(const std::string& path, const std::string& bytes, std::string& error);

// Returns true if the file could be written, before there is anything to write. Otherwise sets `error` to one line.
bool canWriteFile(const std::string& path, std::string& error);

// Returns true if writing one path would replace the file at the other path, whatever their names. A device accepts
// both.
bool areOneFile(const std::string& one, const std::string& other);
}  // namespace drape
