"""Completion for fish."""

HEADER = """# Completion of bendy's commands, options, choices and files. Made by scripts/make_reference.py.

function __bendy_is --argument-names command
    set -l words (commandline -opc)
    test (count $words) -gt 1; and test "$words[2]" = "$command"
end

# Files with one of these extensions, or all, and folders.
function __bendy_files
    set -l word (commandline -ct | string replace -r '^--?[a-z-]+=' '')
    for path in (complete -C "__fish_command_without_completions $word" | string split -f 1 \\t)
        if test (count $argv) -eq 0; or string match -q -- '*/' $path
            echo $path
        end
        for extension in $argv
            string match -q -- "*$extension" $path; and echo $path
        end
    end
end

complete -c bendy -f
"""


def write_fish(program):
    """The text of bendy.fish."""
    text = HEADER + "".join(_option(option, "__fish_use_subcommand") for option in program.options)
    for command in program.commands:
        text += f"\ncomplete -c bendy -n __fish_use_subcommand -a {command.name} -d {_quote(command.about)}\n"
        condition = f"'__bendy_is {command.name}'"
        text += "".join(_option(option, condition) for option in command.options)
        for argument in command.arguments:
            text += f"complete -c bendy -n {condition}{_values(argument)}\n"
    return text


def _option(option, condition):
    text = f"complete -c bendy -n {condition}"
    for name in option.names:
        text += f" -l {name[2:]}" if name.startswith("--") else f" -s {name[1:]}"
    return text + ("" if option.is_flag else " -x" + _values(option)) + f" -d {_quote(option.brief)}\n"


def _values(option):
    if option.choices:
        return f" -a {_quote(' '.join(option.choices))}"
    if option.files is None:
        return ""
    return f" -a '({' '.join(['__bendy_files', *option.files])})'"


def _quote(text):
    return "'" + text.replace("\\", "\\\\").replace("'", "\\'") + "'"
