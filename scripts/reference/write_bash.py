"""Completion for bash, without other programs."""

HEADER = """# Completion of bendy's commands, options, choices and files. Made by scripts/make_reference.py.

# _bendy_files [EXTENSION...]: folders, and files with such a name, or all.
_bendy_files() {
    local extension
    compopt -o filenames 2>/dev/null
    [ $# -gt 0 ] || mapfile -t COMPREPLY < <(compgen -f -- "$cur")
    for extension; do
        mapfile -t -O ${#COMPREPLY[@]} COMPREPLY < <(compgen -f -X "!*$extension" -- "$cur")
    done
    [ $# -eq 0 ] || mapfile -t -O ${#COMPREPLY[@]} COMPREPLY < <(compgen -d -- "$cur")
}

_bendy_words() {
    mapfile -t COMPREPLY < <(compgen -W "$1" -- "$cur")
}

_bendy() {
    local cur=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} command=${COMP_WORDS[1]}
    COMPREPLY=()
    # --option=value comes as three words.
    if [ "$cur" = = ]; then
        cur=
    elif [ "$previous" = = ]; then
        previous=${COMP_WORDS[COMP_CWORD - 2]}
    fi
    if [ "$COMP_CWORD" -eq 1 ]; then
"""


def write_bash(program):
    """The text of the file."""
    names = " ".join(command.name for command in program.commands)
    text = HEADER + f'        _bendy_words "{names} {_options(program)}"\n        return\n    fi\n    case "$command $previous" in\n'
    for command in program.commands:
        for option in command.options:
            if not option.is_flag:
                patterns = " | ".join(f'"{command.name} {name}"' for name in option.names)
                text += f"        {patterns}) {_complete(option)} ;;\n"
    text += '    esac\n    case "$command" in\n'
    for command in program.commands:
        text += f"        {command.name})\n            case \"$cur\" in\n                -*) _bendy_words \"{_options(command)}\" ;;\n"
        if command.arguments:
            text += f"                *) _bendy_files{_extensions(command.arguments)} ;;\n"
        text += "            esac\n            ;;\n"
    return text + "    esac\n}\n\ncomplete -F _bendy bendy\n"


def _options(command):
    return " ".join(name for option in command.options for name in option.names)


def _extensions(arguments):
    return "".join(f" {extension}" for extension in dict.fromkeys(e for argument in arguments for e in argument.files or []))


def _complete(option):
    if option.choices:
        return f'_bendy_words "{" ".join(option.choices)}"; return'
    return "return" if option.files is None else f"_bendy_files{_extensions([option])}; return"
