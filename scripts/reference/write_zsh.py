"""Completion for zsh."""


def write_zsh(program):
    """The text of the file _bendy."""
    text = "#compdef bendy\n# Made by scripts/make_reference.py.\n\n_bendy() {\n    local context state line\n    local -A opt_args\n"
    text += "    local -a commands=(\n"
    for command in program.commands:
        text += f"        {_quote(command.name + ':' + command.about)}\n"
    text += "    )\n    _arguments -C \\\n" + "".join(f"        {spec} \\\n" for option in program.options for spec in _specs(option))
    text += "        '1:command:->command' '*::argument:->argument'\n    case $state in\n"
    text += "        command) _describe -t commands 'bendy command' commands ;;\n        argument)\n            case $words[1] in\n"
    for command in program.commands:
        specs = [spec for option in command.options for spec in _specs(option)]
        specs += [_positional(argument) for argument in command.arguments]
        lines = " \\\n                        ".join(specs)
        text += f"                {command.name})\n                    _arguments \\\n                        {lines}\n                    ;;\n"
    return text + '            esac\n            ;;\n    esac\n}\n\n_bendy "$@"\n'


def _specs(option):
    """One for each name of the option, as _arguments takes them."""
    others = [*option.names, *option.excludes]
    before = "*" if option.repeated else f"({' '.join(others)})"
    value = "" if option.is_flag else f":{option.value.split('|')[0]}:{_action(option)}"
    return [_quote(f"{before}{name}[{_escape(option.brief)}]{value}") for name in option.names]


def _positional(argument):
    place = "*" if argument.repeated else ("" if argument.required else ":")
    return _quote(f"{place}:{argument.names[0]}:{_action(argument)}")


def _action(option):
    if option.choices:
        return f"({' '.join(option.choices)})"
    if option.files is None:
        return " "
    endings = "|".join(extension[1:] for extension in option.files)
    return f'_files -g "*.({endings})"' if endings else "_files"


def _escape(text):
    for letter in "\\[]:":
        text = text.replace(letter, "\\" + letter)
    return text


def _quote(text):
    return "'" + text.replace("'", "'\\''") + "'"
