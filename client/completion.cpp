#include "client/completion.h"

namespace afterglow::client {

std::string bash_completion(const std::vector<CommandSyntax>& syntax) {
    std::string names;
    std::string cases;
    for (const CommandSyntax& command : syntax) {
        names += (names.empty() ? "" : " ") + command.name;
        cases += "        " + command.name + ") words=\"";
        for (const std::string& option : command.options) cases += option + " ";
        cases.back() = '"';
        if (!command.kinds.empty()) {
            cases += " kinds=\"";
            for (const std::string& kind : command.kinds) cases += kind + " ";
            cases.back() = '"';
        }
        cases += " ;;\n";
    }
    return "# Completions of afterglow for bash. To use them: source <(afterglow completion)\n"
           "_afterglow() {\n"
           "    local word=${COMP_WORDS[COMP_CWORD]} kinds= words=\"" +
           names + "\"\n    case ${COMP_WORDS[1]} in\n" + cases +
           "    esac\n"
           "    if [[ $COMP_CWORD -eq 2 && -n $kinds && $word != -* ]]; then\n"
           "        mapfile -t COMPREPLY < <(compgen -W \"$kinds\" -- \"$word\")\n"
           "    elif [[ $COMP_CWORD -eq 1 || $word == -* ]]; then\n"
           "        mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$word\")\n"
           "    fi\n"
           "}\n"
           "complete -o default -F _afterglow afterglow\n";
}

}  // namespace afterglow::client
