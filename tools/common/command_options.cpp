#include "tools/common/command_options.h"

#include <map>

#include "tools/common/arguments.h"

namespace drape
{
namespace
{
// Splits {a,b,c}, in which acceptOnly() and CLI11 show a choice of words.
std::vector<std::string> wordsOf(const std::string& type)
{
    std::vector<std::string> words;
    const std::size_t open = type.find('{'), close = type.find('}');
    if (open == std::string::npos || close == std::string::npos) return words;
    std::string word;
    for (const char c : type.substr(open + 1, close - open - 1) + ",")
    {
        if (c != ',')
            word += c;
        else if (!word.empty())
            words.push_back(std::move(word)), word.clear();
    }
    return words;
}

// CLI11's options have no room for them.
std::map<const CLI::Option*, std::vector<std::string>>& offers()
{
    static std::map<const CLI::Option*, std::vector<std::string>> all;
    return all;
}
}  // namespace

void offerWords(const CLI::Option* option, const std::vector<std::string>& words)
{
    offers()[option] = words;
}

std::vector<CommandOption> optionsOf(const CLI::App& app)
{
    std::vector<CommandOption> all;
    for (const CLI::Option* option : app.get_options())
    {
        if (option->get_group().empty()) continue;
        CommandOption own;
        for (const std::string& name : option->get_snames())
            own.m_names.push_back("-" + name);
        for (const std::string& name : option->get_lnames())
            own.m_names.push_back("--" + name);
        const bool takesValue = option->get_items_expected_max() > 0;
        if (takesValue) own.m_type = option->get_type_name();
        own.m_choices = wordsOf(own.m_type);
        if (!own.m_choices.empty()) own.m_type = "WORD";
        const auto offered = offers().find(option);
        if (offered != offers().end()) own.m_offers = offered->second;
        if (own.m_names.empty()) own.m_type = option->get_name(true);
        own.m_text = option->get_description();
        if (takesValue) own.m_default = option->get_default_str();
        if (own.m_default == "[]" || own.m_default == "\"\"") own.m_default.clear();
        all.push_back(std::move(own));
    }
    return all;
}

std::vector<const CLI::App*> commandsOf(const CLI::App& app)
{
    return app.get_subcommands([](const CLI::App*) { return true; });
}
}  // namespace drape
