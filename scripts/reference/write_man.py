"""Man pages: bendy(1), and bendy-COMMAND(1) for each command."""

import re


def write_man(program, version, date, exit_status):
    """A dictionary from file names to texts. The date is written as it is given."""
    pages = {"bendy.1": _program_page(program, exit_status)}
    for command in program.commands:
        pages[f"bendy-{command.name}.1"] = _command_page(command, exit_status)
    for file, body in pages.items():
        title = file.removesuffix(".1").upper()
        pages[file] = f'.\\" Made by scripts/make_reference.py.\n.TH "{_text(title)}" 1 "{date}" "bendy {version}" "Bendy"\n{body}'
    return pages


def _program_page(program, exit_status):
    name, about = program.about.rstrip(".").split(": ", 1)
    page = f".SH NAME\nbendy \\- {_text(about)}\n.SH SYNOPSIS\n.B bendy\n.I COMMAND\n.RI [ OPTIONS ]\n\\&...\n"
    page += f".SH DESCRIPTION\n{_text(name)} is a file format for animated characters; this program makes its files, checks, shows and "
    page += "changes them.\nEach command has a page of its own.\n.SH COMMANDS\n"
    for command in program.commands:
        page += f".TP\n.BR bendy\\-{command.name} (1)\n{_text(command.about)}.\n"
    page += _options(program) + _exit_status(exit_status)
    page += ".SH ENVIRONMENT\n.TP\n.B BENDY_KERNEL\nWith which instructions of the processor characters are posed and skinned: plain, sse4, "
    page += "avx2 or neon.\nThe quickest that the machine has, if not given.\n"
    return page + _see_also([f"bendy-{command.name}" for command in program.commands])


def _command_page(command, exit_status):
    page = f".SH NAME\nbendy-{command.name} \\- {_text(command.about[0].lower() + command.about[1:])}\n"
    page += f".SH SYNOPSIS\n.B bendy {command.name}\n" + "".join(f"{_text(word)}\n" for word in command.usage.split()[1:])
    page += f".SH DESCRIPTION\n{_text(command.about)}.\n"
    if command.prose:
        page += ".PP\n" + "".join(f"{_text(line)}\n" for line in command.prose)
    page += _options(command) + _exit_status(exit_status)
    if command.examples:
        page += ".SH EXAMPLES\n.EX\n" + "".join(f"{_text(example)}\n" for example in command.examples) + ".EE\n"
    return page + _see_also(["bendy"])


def _options(command):
    text = ".SH OPTIONS\n"
    for group, options in command.groups:
        text += (f".SS {_text(group)}\n" if group else "") + "".join(_option(option) for option in options)
    return text


def _option(option):
    names = ", ".join(rf"\fB{_text(name)}\fR" if name.startswith("-") else rf"\fI{name}\fR" for name in option.names)
    if option.value and option.names[0].startswith("-"):
        names += rf" \fI{_text(option.value)}\fR"
    return f".TP\n{names}\n{_text('. '.join([option.about, *option.notes]))}.\n"


def _exit_status(exit_status):
    return ".SH EXIT STATUS\n" + "".join(f".TP\n.B {status}\n{_text(meaning)}.\n" for status, meaning in exit_status)


def _see_also(names):
    return ".SH SEE ALSO\n" + ",\n".join(f".BR {_text(name)} (1)" for name in names) + "\n"


def _text(text):
    """Escapes text for roff; text in backticks becomes bold."""
    text = text.replace("\\", r"\e").replace("-", r"\-")
    text = re.sub(r"`([^`]*)`", r"\\fB\1\\fR", text)
    return "\\&" + text if text.startswith((".", "'")) else text
