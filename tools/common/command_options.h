// The options of a program as its help shows them, for pages and scripts made of them.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace drape
{
struct CommandOption
{
    std::vector<std::string> m_names;    // --json, -h
    std::string m_type;                  // type of the value; empty: a flag
    std::string m_text;                  // one line
    std::string m_default;               // empty: none
    std::vector<std::string> m_choices;  // words of which the value is one; empty: any value
    std::vector<std::string> m_offers;   // some values; see offerWords()
};

// Returns the options that are not hidden, in the help's order. An option without a name is an argument.
std::vector<CommandOption> optionsOf(const CLI::App& app);

std::vector<const CLI::App*> commandsOf(const CLI::App& app);
}  // namespace drape
