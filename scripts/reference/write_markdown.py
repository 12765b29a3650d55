"""The reference as one page of Markdown: docs/cli.md."""

HEADER = """# Command line

<!-- Made by scripts/make_reference.py of what `bendy COMMAND --help` prints: change that, and make it anew. -->

`bendy --help`, `bendy COMMAND --help` and the man pages bendy(1) and bendy-COMMAND(1) say the same. `bendy --version` prints the
version.

"""


def write_markdown(program, exit_status):
    """The text of the page."""
    page = HEADER + "| command | |\n|---|---|\n"
    for command in program.commands:
        page += f"| [`{command.name}`](#bendy-{command.name}) | {command.about} |\n"
    page += "\n| exit status | |\n|---|---|\n"
    for status, meaning in exit_status:
        page += f"| {status} | {meaning} |\n"
    return page + "".join(_section(command) for command in program.commands)


def _section(command):
    text = f"\n## bendy {command.name}\n\n{command.about}.\n\n```text\nbendy {command.usage}\n```\n\n| | |\n|---|---|\n"
    for option in command.arguments + command.options:
        if option.names == ["-h", "--help"]:
            continue
        names = [f"`{name}`" for name in option.names]
        if option.value and option.names[0].startswith("-"):
            names[-1] = f"`{option.names[-1]} {option.value}`".replace("|", "\\|")
        about = ". ".join([option.about, *option.notes]).replace("|", "\\|")
        text += f"| {', '.join(names)} | {about} |\n"
    if command.prose:
        text += "\n" + "\n".join(command.prose) + "\n"
    if command.examples:
        text += "\n```sh\n" + "\n".join(command.examples) + "\n```\n"
    return text
