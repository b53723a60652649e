#include <algorithm>
#include <cctype>

#include "tools/common/command_options.h"
#include "tools/common/command_pages.h"

namespace drape
{
namespace
{
std::string joined(const std::vector<std::string>& words, const char* between = " ")
{
    std::string all;
    for (const std::string& word : words)
        all += (all.empty() ? "" : between) + word;
    return all;
}

std::string quoted(const std::string& text, const std::string& special)
{
    std::string safe;
    for (const char c : text)
    {
        if (special.find(c) != std::string::npos) safe += '\\';
        safe += c;
    }
    return safe;
}

std::vector<std::string> namesOf(const CLI::App& app)
{
    std::vector<std::string> names;
    for (const CommandOption& option : optionsOf(app))
        names.insert(names.end(), option.m_names.begin(), option.m_names.end());
    return names;
}

std::vector<std::string> commandNames(const CLI::App& app)
{
    std::vector<std::string> names;
    for (const CLI::App* command : commandsOf(app))
        names.push_back(command->get_name());
    return names;
}

bool takesFolder(const CommandOption& option)
{
    return option.m_type == "DIR";
}

bool takesFile(const CommandOption& option)
{
    return option.m_type.find("FILE") != std::string::npos || option.m_type.find("PATH") != std::string::npos;
}

// Returns the command that makes the replies, a line each, so that names may have spaces.
std::string bashReply(const std::string& generator)
{
    return "mapfile -t COMPREPLY < <(compgen " + generator + " -- \"$word\")";
}

// Returns the cases of options that take a value. Options of the same name in two commands have the same values.
std::string bashValues(const CLI::App& app)
{
    std::string cases;
    for (const CommandOption& option : optionsOf(app))
    {
        if (option.m_names.empty() || option.m_type.empty()) continue;
        std::string reply = "COMPREPLY=()";
        if (!option.m_choices.empty())
            reply = bashReply("-W '" + joined(option.m_choices) + "'");
        else if (takesFolder(option))
            reply = bashReply("-d");
        else if (takesFile(option))
            reply = bashReply(option.m_offers.empty() ? "-f" : "-f -W '" + joined(option.m_offers) + "'");
        cases += "    " + joined(option.m_names, "|") + ") " + reply + "; return ;;\n";
    }
    return cases;
}

std::string bashScript(const CLI::App& app)
{
    const std::string& name = app.get_name();
    std::string options = "    *) words='" + joined(namesOf(app)) + "' ;;\n", find, values = bashValues(app);
    const std::vector<std::string> commands = commandNames(app);
    if (!commands.empty())
        find = "  local i\n  for ((i = 1; i < COMP_CWORD; i++)); do\n    case ${COMP_WORDS[i]} in " +
               joined(commands, "|") + ") command=${COMP_WORDS[i]} ;; esac\n  done\n";
    std::string cases;
    for (const CLI::App* command : commandsOf(app))
    {
        std::vector<std::string> names = namesOf(*command), common = namesOf(app);
        names.insert(names.end(), common.begin(), common.end());
        cases += "    " + command->get_name() + ") words='" + joined(names) + "' ;;\n";
        values += bashValues(*command);
    }
    const std::string words = commands.empty() ? "" : "  [[ -n $command ]] || words+=' " + joined(commands) + "'\n";
    return "# bash completion of " + name + "\n_" + name +
           "()\n{\n  local word=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} command= words=\n"
           "  COMPREPLY=()\n  # bash splits --option=value at the equals sign.\n"
           "  [[ $word == = ]] && word=\n  [[ $previous == = && $COMP_CWORD -gt 1 ]] && "
           "previous=${COMP_WORDS[COMP_CWORD - 2]}\n  case $previous in\n" +
           values + "  esac\n" + find + "  case $command in\n" + cases + options + "  esac\n" + words +
           "  if [[ $word == -* ]]; then\n    " + bashReply("-W \"$words\"") + "\n  else\n    " +
           bashReply("-f -W '" + joined(commands) + "'") + "\n  fi\n}\ncomplete -o filenames -F _" + name + " " + name +
           "\n";
}

std::string zshAction(const CommandOption& option)
{
    if (option.m_type.empty()) return "";
    const std::string head = ":" + quoted(option.m_type, ":'[]\\") + ":";
    if (!option.m_choices.empty()) return head + "(" + joined(option.m_choices) + ")";
    if (takesFolder(option)) return head + "_files -/";
    if (!option.m_offers.empty()) return head + "{compadd " + joined(option.m_offers) + "; _files}";
    return head + (takesFile(option) ? "_files" : " ");
}

std::string zshOptions(const CLI::App& app)
{
    std::string lines;
    for (const CommandOption& option : optionsOf(app))
        for (const std::string& name : option.m_names)
        {
            std::string text = quoted(option.m_text, "[]:\\");
            for (std::size_t at = text.find('\''); at != std::string::npos; at = text.find('\'', at + 4))
                text.replace(at, 1, "'\\''");
            lines += " \\\n    '" + name + "[" + text + "]" + zshAction(option) + "'";
        }
    return lines;
}

std::string zshScript(const CLI::App& app)
{
    std::string lines = zshOptions(app);
    for (const CLI::App* command : commandsOf(app))
        lines += zshOptions(*command);
    const std::vector<std::string> commands = commandNames(app);
    if (!commands.empty()) lines += " \\\n    '1:command:(" + joined(commands) + ")'";
    return "#compdef " + app.get_name() + "\n_arguments" + lines + " \\\n    '*:file:_files'\n";
}

std::string fishOptions(const CLI::App& app, const std::string& program, const std::string& condition)
{
    std::string lines;
    for (const CommandOption& option : optionsOf(app))
    {
        if (option.m_names.empty()) continue;
        lines += "complete -c " + program + condition;
        for (const std::string& name : option.m_names)
            lines += name[1] == '-' ? " -l " + name.substr(2) : " -s " + name.substr(1);
        if (!option.m_type.empty()) lines += takesFile(option) || takesFolder(option) ? " -r" : " -x";
        const std::vector<std::string>& words = option.m_choices.empty() ? option.m_offers : option.m_choices;
        if (!words.empty()) lines += " -a '" + joined(words) + "'";
        lines += " -d '" + quoted(option.m_text, "'\\") + "'\n";
    }
    return lines;
}

std::string fishScript(const CLI::App& app)
{
    const std::string& name = app.get_name();
    std::string script = "# fish completion of " + name + "\n" + fishOptions(app, name, "");
    for (const CLI::App* command : commandsOf(app))
        script += "complete -c " + name + " -n __fish_use_subcommand -a " + command->get_name() + " -d '" +
                  quoted(command->get_description(), "'\\") + "'\n" +
                  fishOptions(*command, name, " -n '__fish_seen_subcommand_from " + command->get_name() + "'");
    return script;
}
}  // namespace

std::string completionScript(const CLI::App& app, const std::string& shell)
{
    if (shell == kBash) return bashScript(app);
    if (shell == kZsh) return zshScript(app);
    return shell == kFish ? fishScript(app) : "";
}
}  // namespace drape
