// Man pages and shell completions of Drape's programs, made of the options that CLI11 knows.
#pragma once

#include <string>

namespace CLI
{
class App;
}

namespace drape
{
// Returns a man page of section 1 in the language of man(7): name, synopsis, options, commands, and the help's footer.
std::string manPage(const CLI::App& app);

// Names of the shells that completionScript() knows.
constexpr const char *kBash = "bash", *kZsh = "zsh", *kFish = "fish";

// Returns a script that completes the program's options, commands, and values: words of a choice, else files. Returns
// "" for another shell.
std::string completionScript(const CLI::App& app, const std::string& shell);
}  // namespace drape
