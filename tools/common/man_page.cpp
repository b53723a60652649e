#include <algorithm>
#include <cctype>

#include "drape/version.h"
#include "tools/common/command_options.h"
#include "tools/common/command_pages.h"
#include "tools/common/suggestion.h"

namespace drape
{
namespace
{
// Returns text that roff prints as it is. A dash becomes a minus sign, which can be copied into a shell.
std::string plainRoff(const std::string& text)
{
    std::string plain;
    for (const char c : text)
    {
        if (plain.empty() || plain.back() == '\n')
            if (c == '.' || c == '\'') plain += "\\&";
        if (c == '\\')
            plain += "\\e";
        else if (c == '-')
            plain += "\\-";
        else
            plain += c;
    }
    return plain;
}

std::string upper(std::string text)
{
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return char(std::toupper(c)); });
    return text;
}

std::string optionText(const CommandOption& option)
{
    std::string head;
    for (const std::string& name : option.m_names)
        head += (head.empty() ? "" : ", ") + ("\\fB" + plainRoff(name) + "\\fR");
    const std::string type = option.m_choices.empty() ? option.m_type : joinedWords(option.m_choices);
    if (!option.m_type.empty()) head += (head.empty() ? "" : " ") + ("\\fI" + plainRoff(type) + "\\fR");
    std::string text = option.m_text;
    if (!option.m_default.empty()) text += (text.empty() ? "" : "; ") + ("default: " + option.m_default);
    return ".TP\n" + head + "\n" + plainRoff(text.empty() ? "no description" : text) + "\n";
}

std::string optionsText(const CLI::App& app)
{
    std::string text;
    for (const CommandOption& option : optionsOf(app))
        text += optionText(option);
    return text;
}

std::string commandsText(const CLI::App& app)
{
    std::string text;
    for (const CLI::App* command : commandsOf(app))
        text +=
            ".SS " + command->get_name() + "\n" + plainRoff(command->get_description()) + "\n" + optionsText(*command);
    return text.empty() ? "" : ".SH COMMANDS\n" + text;
}

// The footer's own line ends and indents are kept.
std::string notesText(const CLI::App& app)
{
    std::string footer = app.get_footer();
    return footer.empty() ? "" : ".SH NOTES\n.nf\n" + plainRoff(footer) + "\n.fi\n";
}
}  // namespace

std::string manPage(const CLI::App& app)
{
    const std::string& name = app.get_name();
    std::string description = app.get_description();
    std::string summary = description.substr(0, description.find('.'));
    if (!summary.empty()) summary[0] = char(std::tolower(static_cast<unsigned char>(summary[0])));
    std::string page = ".\\\" Made from the options of " + name + ".\n";
    page += ".TH " + upper(name) + " 1 \"\" \"Drape " DRAPE_VERSION_STRING "\" \"User Commands\"\n";
    page += ".SH NAME\n" + plainRoff(name) + " \\- " + plainRoff(summary) + "\n";
    page += ".SH SYNOPSIS\n.B " + plainRoff(name) + "\n[\\fIoptions\\fR]";
    if (!commandsOf(app).empty()) page += " \\fIcommand\\fR [\\fIoptions\\fR]";
    page += "\n.SH DESCRIPTION\n" + plainRoff(description) + "\n.SH OPTIONS\n" + optionsText(app);
    return page + commandsText(app) + notesText(app);
}
}  // namespace drape
