// Names the mistake in a command line in the terms of the person who typed it, where CLI11 takes an option for the
// value of another one or only says that an argument was not expected.
#pragma once

#include <string>
#include <vector>

namespace CLI
{
class App;
}

namespace drape
{
// Returns one line for the first of these mistakes, or "" when there is none: an option that is followed by another one
// where it needs a value, an option or command that does not exist (with the one that may be meant), an argument that
// belongs to nothing. `arguments` are without the program's name. A value that begins with two dashes is written
// --option=VALUE.
std::string argumentMistake(const CLI::App& app, const std::vector<std::string>& arguments);
}  // namespace drape
