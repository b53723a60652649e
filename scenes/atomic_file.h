// Writes a file so that it is there whole or not at all: into a neighbour with a temporary name, then renamed.
// Returns false and says in `error` which path failed and why (one line); a half-written neighbour is removed.
#pragma once

#include <string>

namespace drape
{
bool writeFileAtomically(const std::string& path, const std::string& bytes, std::string& error);
}  // namespace drape
