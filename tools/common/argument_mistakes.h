// Names the mistake in a command line in the user's terms. CLI11 would take an option for the value of another one, or
// only say that an argument was not expected.
#pragma once

#include <string>
#include <vector>

namespace CLI
{
class App;
}

namespace drape
{
// Returns one line for the first mistake, or "" if there is none.
// Mistakes are an option without its value before another option, an option or command that does not exist, and an
// argument that belongs to nothing. The line suggests a similar name. `arguments` are without the program's name. A
// value that begins with two dashes is written --option=VALUE.
std::string argumentMistake(const CLI::App& app, const std::vector<std::string>& arguments);
}  // namespace drape
