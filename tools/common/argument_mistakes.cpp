#include "tools/common/argument_mistakes.h"

#include <cctype>

#include <CLI/CLI.hpp>

#include "tools/common/suggestion.h"

namespace drape
{
namespace
{
// --name, --name=value or -n, but no number and no lone dashes.
bool looksLikeOption(const std::string& argument)
{
    if (argument.size() < 2 || argument[0] != '-' || argument == "--") return false;
    return argument[1] == '-' || std::isalpha(static_cast<unsigned char>(argument[1]));
}

// The value of an option may begin with one dash (a number below zero, a file), but not with two.
bool looksLikeNoValue(const std::string& argument)
{
    return argument.size() > 2 && argument.compare(0, 2, "--") == 0;
}

std::string nameOf(const std::string& argument)
{
    return argument.substr(0, argument.find('='));
}

// A walk along the arguments that knows which command they belong to.
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
    // An option of the command, or of those that it belongs to.
    const CLI::Option* find(const std::string& name) const
    {
        for (const CLI::App* app = m_app; app != nullptr; app = app->get_parent())
            for (const CLI::Option* option : app->get_options())
                if (name[1] == '-' ? option->check_lname(name.substr(2)) : option->check_sname(name.substr(1)))
                    return option;
        return nullptr;
    }

    // Without hidden ones, which have no group.
    std::vector<std::string> optionNames() const
    {
        std::vector<std::string> names;
        for (const CLI::App* app = m_app; app != nullptr; app = app->get_parent())
            for (const CLI::Option* option : app->get_options())
                for (const std::string& name : option->get_lnames())
                    if (!option->get_group().empty()) names.push_back("--" + name);
        return names;
    }

    std::vector<const CLI::App*> commands() const
    {
        return m_app->get_subcommands([](const CLI::App*) { return true; });
    }

    std::string inOption(const std::string& argument)
    {
        const std::string name = nameOf(argument);
        const CLI::Option* option = find(name);
        if (option == nullptr) return "there is no option " + name + didYouMean(name, optionNames());
        if (option->get_items_expected_min() == 0 || name.size() < argument.size()) return "";
        if (m_next == m_arguments.size()) return "";  // CLI11 says so itself
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
        if (find(follower) != nullptr) return needs + "the option " + follower + " follows it";
        return needs + follower + " follows it, which is no option" + didYouMean(follower, optionNames());
    }

    std::string inWord(const std::string& word)
    {
        std::vector<std::string> names;
        for (const CLI::App* command : commands())
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
        return "the argument '" + word + "' belongs to no option" + didYouMean(word, optionNames());
    }

    const CLI::App* m_app;
    const std::vector<std::string>& m_arguments;
    std::size_t m_next = 0;
    std::size_t m_words = 0;  // arguments so far that are neither options nor their values, of the command
};
}  // namespace

std::string argumentMistake(const CLI::App& app, const std::vector<std::string>& arguments)
{
    return ArgumentWalk(app, arguments).firstMistake();
}
}  // namespace drape
