#include "tools/common/argument_mistakes.h"

#include <cctype>

#include <CLI/CLI.hpp>

#include "tools/common/suggestion.h"

namespace drape
{
namespace
{
// Returns true for --name, --name=value and -n, but not for numbers and lone dashes.
bool looksLikeOption(const std::string& argument)
{
    if (argument.size() < 2 || argument[0] != '-' || argument == "--") return false;
    return argument[1] == '-' || std::isalpha(static_cast<unsigned char>(argument[1]));
}

// A value may begin with one dash (a number below zero, a file), but not with two.
bool looksLikeNoValue(const std::string& argument)
{
    return argument.size() > 2 && argument.compare(0, 2, "--") == 0;
}

std::string nameOf(const std::string& argument)
{
    return argument.substr(0, argument.find('='));
}

// Walks along the arguments and keeps track of the command that they belong to.
class ArgumentWalk
{
public:
    ArgumentWalk(const CLI::App& app, const std::vector<std::string>& arguments) : m_app(&app), m_arguments(arguments)
    {
    }

    std::string firstMistake()
    {
        while (m_next < m_arguments.size() && m_arguments[m_next] != "--")
        {
            const std::string& argument = m_arguments[m_next++];
            const std::string mistake = looksLikeOption(argument) ? inOption(argument) : inWord(argument);
            if (!mistake.empty()) return mistake;
        }
        return "";
    }

private:
    static const CLI::Option* findIn(const CLI::App& app, const std::string& name)
    {
        for (const CLI::Option* option : app.get_options())
            if (name[1] == '-' ? option->check_lname(name.substr(2)) : option->check_sname(name.substr(1)))
                return option;
        return nullptr;
    }

    // Finds an option of the current command or of its parents.
    const CLI::Option* find(const std::string& name) const
    {
        const CLI::Option* found = nullptr;
        for (const CLI::App* app = m_app; app != nullptr && found == nullptr; app = app->get_parent())
            found = findIn(*app, name);
        return found;
    }

    // Leaves out hidden options, which have no group.
    std::vector<std::string> optionNames() const
    {
        std::vector<std::string> names;
        for (const CLI::App* app = m_app; app != nullptr; app = app->get_parent())
            for (const CLI::Option* option : app->get_options())
                for (const std::string& name : option->get_lnames())
                    if (!option->get_group().empty()) names.push_back("--" + name);
        return names;
    }

    static std::vector<const CLI::App*> commandsOf(const CLI::App& app)
    {
        return app.get_subcommands([](const CLI::App*) { return true; });
    }

    // Returns the commands that have the option: one that may follow, or others than the current one.
    std::vector<std::string> ownersOf(const std::string& name) const
    {
        const CLI::App* parent = m_app->get_parent();
        std::vector<std::string> owners;
        for (const CLI::App* command : commandsOf(parent == nullptr ? *m_app : *parent))
            if (findIn(*command, name) != nullptr) owners.push_back(command->get_name());
        return owners;
    }

    std::string unknownOption(const std::string& name) const
    {
        const CLI::App* parent = m_app->get_parent();
        const std::vector<std::string> owners = ownersOf(name);
        if (owners.empty()) return "there is no option " + name + didYouMean(name, optionNames());
        return name + " is an option of the command " + joinedWords(owners) +
               (parent == nullptr ? ", to be given after it" : ", not of " + m_app->get_name());
    }

    std::string inOption(const std::string& argument)
    {
        const std::string name = nameOf(argument);
        const CLI::Option* option = find(name);
        if (option == nullptr) return unknownOption(name);
        if (option->get_items_expected_min() == 0) return "";
        // CLI11 would take the next argument for the value.
        if (name.size() + 1 == argument.size()) return argument + " has no value after the equals sign";
        if (name.size() < argument.size()) return "";
        if (m_next == m_arguments.size()) return "";  // CLI11 reports the missing value
        const std::string& value = m_arguments[m_next++];
        if (looksLikeNoValue(value) || (looksLikeOption(value) && find(nameOf(value)) != nullptr))
            return missingValue(*option, name, value);
        if (option->get_items_expected_max() == 1) return "";
        while (m_next < m_arguments.size() && !looksLikeOption(m_arguments[m_next]))
            ++m_next;
        return "";
    }

    std::string missingValue(const CLI::Option& option, const std::string& name, const std::string& next) const
    {
        const std::string follower = nameOf(next);
        const std::string needs = name + " needs a value (" + option.get_type_name() + "), but ";
        if (find(follower) != nullptr || !ownersOf(follower).empty())
            return needs + "the option " + follower + " follows it";
        return needs + follower + " follows it, which is no option" + didYouMean(follower, optionNames());
    }

    std::string inWord(const std::string& word)
    {
        std::vector<std::string> names;
        for (const CLI::App* command : commandsOf(*m_app))
        {
            names.push_back(command->get_name());
            if (!command->check_name(word)) continue;
            m_app = command;
            m_words = 0;
            return "";
        }
        std::size_t places = 0;
        for (const CLI::Option* option : m_app->get_options())
            places += option->get_positional();
        if (m_words++ < places) return "";
        if (!names.empty()) return "there is no command " + word + didYouMean(word, names);
        if (m_app->get_parent() != nullptr)
            for (const CLI::App* command : commandsOf(*m_app->get_parent()))
                if (command->check_name(word))
                    return "the command " + word + " follows " + m_app->get_name() + "; only one is run";
        return "the argument '" + word + "' belongs to no option" + didYouMean(word, optionNames());
    }

    const CLI::App* m_app;
    const std::vector<std::string>& m_arguments;
    std::size_t m_next = 0;
    std::size_t m_words = 0;  // positional arguments of the current command so far
};
}  // namespace

std::string argumentMistake(const CLI::App& app, const std::vector<std::string>& arguments)
{
    return ArgumentWalk(app, arguments).firstMistake();
}
}  // namespace drape
